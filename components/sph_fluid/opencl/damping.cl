/* A zone that damps the fluid's motion, in double precision; laws are printed. */

/* Damp velocities in a zone at the end of a step, except in buffer rows. `taken` sums the decrease
   of their squares. */
__kernel void damp(
    int split, double4 low, double4 high, int axis, int is_lower, double rate, double dt,
    __global const long *role, __global const double4 *position, __global double4 *velocity,
    __global double *taken, __global double4 *extremes)
{
    const int i = get_global_id(0);
    if (i >= split || role && role[i]) return;
    const double4 r = position[i];
    if (r.x < low.x || r.y < low.y || r.z < low.z || r.x > high.x || r.y > high.y || r.z > high.z)
        return;
    const double along[3] = {r.x, r.y, r.z}, lowest[3] = {low.x, low.y, low.z};
    const double highest[3] = {high.x, high.y, high.z};
    const double strength = damping_strength(along[axis], lowest[axis], highest[axis], is_lower);
    const double share = damped_share(strength, rate, dt);
    taken[i] += square_of(velocity[i].xyz) * (1.0 - share * share);
    velocity[i].xyz *= share;
    extremes[i].w = square_of(velocity[i].xyz);
}
