/* A driven pair, of which one work item computes both points; without a drive both are -1.

   `motion` is what the law of the drive prescribes: the change of the pair's distance, its velocity
   and its acceleration. */

static double along(double4 vector, Driven driven)
{
    return driven.axis == 0 ? vector.x : driven.axis == 1 ? vector.y : vector.z;
}

static void set_along(__global double4 *vectors, int i, Driven driven, double component)
{
    ((__global double *)(vectors + i))[driven.axis] = component;
}

/* Power of the forces on the pair. */
static double power_of_drive(
    Driven driven, __global const double4 *velocity, __global const double *energies)
{
    const double first = energies[PULL_FIRST] * along(velocity[driven.first], driven);
    return first + energies[PULL_SECOND] * along(velocity[driven.second], driven);
}

/* Set rates of the pair along its axis, velocities or accelerations. */
static void set_rates(Driven driven, double rate, __global double4 *rates)
{
    const int i = driven.first, j = driven.second;
    const tuple_2r both =
        driven_rates(driven, rate, along(rates[i], driven), along(rates[j], driven));
    set_along(rates, i, driven, both.f0);
    set_along(rates, j, driven, both.f1);
}

/* Set the prescribed motion of the pair along its axis. */
static void constrain(
    Driven driven, double4 motion, __global double4 *position, __global double4 *velocity)
{
    const int i = driven.first, j = driven.second;
    const tuple_2r places =
        driven_places(driven, motion.x, along(position[i], driven), along(position[j], driven));
    set_along(position, i, driven, places.f0);
    set_along(position, j, driven, places.f1);
    set_rates(driven, motion.y, velocity);
}

/* Write the prescribed acceleration of the pair, and the forces of the drive. */
static void drive(
    Driven driven, double4 motion, double mass, __global double4 *acceleration,
    __global double *energies)
{
    const int i = driven.first, j = driven.second;
    const double first = along(acceleration[i], driven), second = along(acceleration[j], driven);
    set_rates(driven, motion.z, acceleration);
    energies[PULL_FIRST] = mass * (along(acceleration[i], driven) - first);
    energies[PULL_SECOND] = mass * (along(acceleration[j], driven) - second);
}
