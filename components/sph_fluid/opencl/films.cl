/* What films of water in narrow gaps read of a fluid; see boundary/film_rows.py. */

/* Places, densities, p/rho^2 and mirror points of boundary rows. */
__kernel void film_sides(
    int count, __global const int *row, int split, __global const double4 *position,
    __global const double4 *velocity, __global const double *mirror, __global double8 *side)
{
    const int k = get_global_id(0);
    if (k >= count) return;
    const int b = row[k], i = split + b;
    side[k] = (double8)(position[i], velocity[i].w, vload3(b, mirror));
}

/* Volume of the fluid around points of faces, by the lists of mirror points of boundary rows. */
__kernel void fluid_share(
    int count, __global const int *row, int split, __global const double *foot,
    __global const double4 *position, __global const int *near, __global const int *end,
    long row_stride, long item_stride, Constants constants, __global double *share)
{
    const int f = get_global_id(0);
    if (f >= count) return;
    const int i = split + row[f];
    const double3 at = vload3(f, foot);
    double sum = 0;
    for (int k = 0; k < end[i]; k++) {
        const double4 r = position[near[(size_t)i * row_stride + item_stride * k]];
        const double3 d = at - r.xyz;
        const double r2 = d.x * d.x + d.y * d.y + d.z * d.z;
        sum += kernel_of(r2, constants.smoothing) * constants.mass / r.w;
    }
    share[f] = sum;
}
