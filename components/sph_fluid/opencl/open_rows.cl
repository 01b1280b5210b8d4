/* Rows of a fluid that comes and goes through faces of its tank, in double precision. */

/* Mark rows in the buffers, and fluid less than `depth` behind a face. */
__kernel void mark_near_face(
    int split, int axis, double face, double inward, double depth,
    __global const double4 *position, __global const long *role, __global uchar *mark)
{
    const int i = get_global_id(0);
    if (i >= split) return;
    const double4 r = position[i];
    const double along[3] = {r.x, r.y, r.z};
    if (role[i] > 0 || inward * (along[axis] - face) < depth) mark[i] = 1;
}

/* Write rows of `width` words to rows of an array. */
__kernel void scatter(
    __global const long *row, int count, int width, __global const long *from, __global long *to)
{
    const int k = get_global_id(0);
    if (k >= count) return;
    for (int w = 0; w < width; w++) to[row[k] * width + w] = from[k * (size_t)width + w];
}

/* Rows that stay where `removed` others go; `shifted` are the rows of these, which rise, each less
   the number of those before it. */
__kernel void number_staying(
    int staying, __global const long *shifted, int removed, __global long *row)
{
    const int k = get_global_id(0);
    if (k >= staying) return;
    int low = 0, high = removed;
    while (low < high) {
        const int middle = (low + high) / 2;
        if (shifted[middle] <= k)
            low = middle + 1;
        else
            high = middle;
    }
    row[k] = k + low;
}

/* Keep velocities and densities of buffer rows: set their rates to 0. */
__kernel void hold(
    int split, __global const long *role, __global RATE4 *rate, __global double *drift,
    __global double *minus_rho_div_u)
{
    const int i = get_global_id(0);
    if (i >= split || role[i] == 0) return;
    rate[i] = 0;
    if (drift) vstore3((double3)(0), i, drift);
    if (minus_rho_div_u) minus_rho_div_u[i] = 0;
}
