/* The frame of a tank that moves, in double precision; laws and structs are printed. */

/* Add its accelerations to those of the fluid; see motion/kernels.py:add_frame_acceleration. */
__kernel void accelerate(
    int split, FrameForces forces, __global const double4 *position,
    __global const double4 *velocity, __global RATE4 *rates, __global double *power,
    __global double4 *extremes)
{
    const int i = get_global_id(0);
    if (i >= split) return;
    const double4 at = position[i], speed = velocity[i];
    const RATE4 rate = rates[i];
    const tuple_3r r = {at.x, at.y, at.z}, u = {speed.x, speed.y, speed.z};
    const tuple_3r a = {rate.x, rate.y, rate.z};
    const InFrame moved = frame_acceleration(r, u, a, forces);
    const tuple_3r b = moved.f0;
    rates[i] = (RATE4)(b.f0, b.f1, b.f2, rate.w);
    power[i] = moved.f1;
    extremes[i].x = b.f0 * b.f0 + b.f1 * b.f1 + b.f2 * b.f2;
}
