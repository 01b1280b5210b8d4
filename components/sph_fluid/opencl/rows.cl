/* Loops over rows of a fluid in double precision: sorting, and samples that bodies move. */

static double square_of(double3 d) { return d.x * d.x + d.y * d.y + d.z * d.z; }

/* Extents, densities, and what is outside of the tank, for the sort by cells. */
__kernel void survey(
    __global const double4 *position, int split, int walled, double4 low, double4 high,
    __global double4 *most, __global double4 *least)
{
    const int i = get_global_id(0);
    if (i >= split) return;
    const double4 r = position[i];
    const int inside = r.x >= low.x && r.y >= low.y && r.z >= low.z && r.x <= high.x
        && r.y <= high.y && r.z <= high.z;
    most[i] = r;
    least[i] = (double4)(-r.xyz, walled && !inside);
}

/* Which rows of the fluid have a velocity, or p/rho^2, that is not finite. */
__kernel void find_not_finite(
    __global const double4 *velocity, int split, __global double4 *extremes)
{
    const int i = get_global_id(0);
    if (i < split) extremes[i] = all(isfinite(velocity[i])) ? 0.0 : 1.0;
}

/* Where particles are as they are listed, and then mirror points. */
__kernel void note_places(
    __global const double4 *position, int count, __global const double *mirror, int rows,
    __global double *reference)
{
    const int i = get_global_id(0);
    if (i >= rows) return;
    vstore3(i < count ? position[i].xyz : vload3(i - count, mirror), i, reference);
}

/* Points that boundary rows look from, their mirror points; then the samples themselves. */
__kernel void look_from(
    int count, int boundary, int points, __global const int *row, __global const double *reference,
    __global double *look)
{
    const int p = get_global_id(0);
    if (p >= points) return;
    vstore3(vload3(p < boundary ? count + p : row[p - boundary], reference), p, look);
}

/* Put samples where they are in the coming step: place, velocity and mirror point of each, and the
   stiffness of the contact potential there; below 0 where it does not act. */
__kernel void place_samples(
    int samples, int split, __global const int *row, __global const double *placed,
    __global const double *stiffness, __global double4 *position, __global double4 *velocity,
    __global double *mirror)
{
    const int s = get_global_id(0);
    if (s >= samples) return;
    const int i = row[s];
    position[i].xyz = vload3(3 * s, placed);
    velocity[i].xyz = vload3(3 * s + 1, placed);
    if (stiffness && stiffness[s] >= 0) velocity[i].w = stiffness[s];
    if (mirror) vstore3(vload3(3 * s + 2, placed), i - split, mirror);
}

/* A copy in single precision, less an origin. */
__kernel void narrow(
    __global const double4 *from, int count, double4 origin, __global float4 *to)
{
    const int i = get_global_id(0);
    if (i < count) to[i] = convert_float4(from[i] - origin);
}
