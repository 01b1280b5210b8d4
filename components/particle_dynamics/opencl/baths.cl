/* Baths and collisions in the middle of a stage: see kernels/motion.py. */

/* The next random number. */
static double uniform(long *counter)
{
    *counter = counter_after(*counter, 1);
    return uniform_of(*counter);
}

/* Velocity of a bathed point along an axis after the time of a bath; its heat is added. */
static double exchanged(
    double before, tuple_2r factors, double mass, long *counter, __global double *heat)
{
    const double length = uniform(counter);
    const double after = factors.f0 * before + factors.f1 * normal_of(length, uniform(counter));
    *heat += heat_gained(mass, after, before);
    return after;
}

/* Velocities of bathed points after a time: the O of BAOAB. The generator stays where it is; each
   point has the random numbers of its number among those of all ranks. */
__kernel void exchange(
    double time, int count, double mass, double boltzmann, int drawn, __global const int *number,
    __global const int *point, __global const double *rate, __global const double *temperature,
    __global const long *generator, __global double4 *velocity, __global double *heat)
{
    const int b = get_global_id(0);
    if (b >= count) return;
    long counter = counter_after(*generator, (long)drawn * number[b]);
    const tuple_2r factors = bath_factors(rate[b], temperature[b], mass, boltzmann, time);
    double4 u = velocity[point[b]];
    u.x = exchanged(u.x, factors, mass, &counter, heat + b);
    u.y = exchanged(u.y, factors, mass, &counter, heat + b);
    u.z = exchanged(u.z, factors, mass, &counter, heat + b);
    velocity[point[b]] = u;
}

/* Pass over what baths have drawn, and let random pairs collide, one after another. */
__kernel void collide(
    double expected, long drawn, int bonds, __global const int *bond, __global long *generator,
    __global double4 *velocity)
{
    if (get_global_id(0)) return;
    long counter = counter_after(*generator, drawn);
    if (expected > 0) {
        double waited = -log(uniform(&counter));
        while (waited < expected) {
            const int b = (int)(uniform(&counter) * bonds), i = bond[2 * b], j = bond[2 * b + 1];
            const double4 v = velocity[i] - velocity[j];
            const tuple_3r relative = {v.x, v.y, v.z};
            const double height = uniform(&counter);
            const tuple_3r turn = half_turn(relative, direction_of(height, uniform(&counter)));
            const double4 change = (double4)(turn.f0, turn.f1, turn.f2, 0);
            velocity[i] += change;
            velocity[j] -= change;
            waited -= log(uniform(&counter));
        }
    }
    *generator = counter;
}
