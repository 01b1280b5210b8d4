/* Stages of a step: see kernels/motion.py. `half_stage` is half the length of a stage; `motion` is
   the prescribed motion of a driven pair at its end. Positions and rates have a fourth component,
   which is 0.

   RANDOM is defined where baths or collisions act in the middle of a stage, DAMPED and DAMPS_ALL
   where forces take predicted velocities. */

#if defined(DAMPED) || defined(DAMPS_ALL)
#define PREDICTS
#endif

/* Predict the velocity at the end of the stage, which damping takes. */
static void predict(
    int i, double half_stage, __global const double4 *velocity,
    __global const double4 *acceleration, __global double4 *predicted)
{
#ifdef PREDICTS
    predicted[i] = velocity[i] + half_stage * acceleration[i];
#endif
}

/* Kick and drift a point; up to the middle of the drift, where baths act, if anything is random. */
static void depart(
    int i, double half_stage, double length, __global double4 *position,
    __global double4 *velocity, __global const double4 *acceleration, __global double4 *predicted,
    __global const double *lost, __global double *dissipated)
{
#ifdef PREDICTS
    dissipated[i] += half_stage * lost[i];
#endif
    velocity[i] += half_stage * acceleration[i];
#ifdef RANDOM
    position[i] += half_stage * velocity[i];
#else
    position[i] += length * velocity[i];
    predict(i, half_stage, velocity, acceleration, predicted);
#endif
}

/* Open a stage of a length. */
__kernel void open_stage(
    double half_stage, double length, double4 motion, int count, Driven driven,
    __global double4 *position, __global double4 *velocity, __global const double4 *acceleration,
    __global double4 *predicted, __global const double *lost, __global double *dissipated,
    __global double *energies)
{
    const int i = get_global_id(0);
    if (i >= count || i == driven.second) return;
    if (i == driven.first)
        energies[WORK] += half_stage * power_of_drive(driven, velocity, energies);
    depart(i, half_stage, length, position, velocity, acceleration, predicted, lost, dissipated);
    if (i != driven.first) return;
    depart(
        driven.second, half_stage, length, position, velocity, acceleration, predicted, lost,
        dissipated);
#ifndef RANDOM
    constrain(driven, motion, position, predicted);
    constrain(driven, motion, position, velocity);
#endif
}

/* Make the second half of the drift, after what is random. */
__kernel void place(
    double half_stage, double4 motion, int count, Driven driven, __global double4 *position,
    __global double4 *velocity, __global const double4 *acceleration, __global double4 *predicted)
{
    const int i = get_global_id(0);
    if (i >= count || i == driven.second) return;
    position[i] += half_stage * velocity[i];
    predict(i, half_stage, velocity, acceleration, predicted);
    if (i != driven.first) return;
    position[driven.second] += half_stage * velocity[driven.second];
    predict(driven.second, half_stage, velocity, acceleration, predicted);
    constrain(driven, motion, position, predicted);
    constrain(driven, motion, position, velocity);
}

/* Average the kinetic energy of a point at the end of a step; keep the greatest squares, since the
   host read them, of how far it was from where it was listed, infinity if its velocity is not
   finite, and of its speed. */
static void measure(
    int i, double weight, double mass, __global const double4 *position,
    __global const double4 *velocity, __global const double4 *listed, __global double *kinetic,
    __global double4 *extremes)
{
    const double4 u = velocity[i], d = position[i] - listed[i];
    const double square = u.x * u.x + u.y * u.y + u.z * u.z;
    kinetic[i] += weight * 0.5 * mass * square;
    const double moved = isfinite(square) ? d.x * d.x + d.y * d.y + d.z * d.z : INFINITY;
    const double4 greatest = extremes[i];
    extremes[i] = (double4)(max_real(greatest.x, moved), max_real(greatest.y, square), 0, 0);
}

/* Compute the forces and kick; copies of other ranks' points stay as they are. The list of a point
   has those of lower number that list it, until `first`; those that it lists itself, until
   `second`; and those of higher number that list it. */
__kernel void close_stage(
    double half_stage, int is_last, double weight, double mass, int count, Driven driven,
    PairTerms terms, __global const int *role, __global const double *tether,
    __global const double *rest, __global const double4 *listed, __global const double4 *position,
    __global const double4 *predicted, __global double4 *velocity, __global double4 *acceleration,
    __global double *lost, __global double *dissipated, __global double *kinetic,
    __global double4 *extremes, __global const int *near, __global const int *first,
    __global const int *second, __global const int *end, long row_stride, long item_stride)
{
    const int i = get_global_id(0);
    if (i >= count || role[i] == COPY) return;
    const double4 r = position[i], u = predicted[i];
    near += (size_t)i * row_stride;
#define SUM(start, from, to) \
    add_forces(start, i, from, to, near, item_stride, r, u, position, predicted, terms)
    double4 sum = SUM((double4)0, 0, first[i]);
    const double4 of_list = SUM((double4)0, first[i], second[i]);
    sum.xyz += of_list.xyz;
    sum = SUM(sum, second[i], end[i]);
    sum.w = of_list.w;
#ifdef DAMPS_ALL
    sum = damp_by_all(sum, i, count, terms.of_all, position, predicted);
#endif
    const int bath = role[i];
    if (bath >= 0) {
        sum.x -= tether_force(tether[bath], r.x, rest[3 * bath]);
        sum.y -= tether_force(tether[bath], r.y, rest[3 * bath + 1]);
        sum.z -= tether_force(tether[bath], r.z, rest[3 * bath + 2]);
    }
#ifdef PREDICTS
    lost[i] = sum.w;
    dissipated[i] += half_stage * sum.w;
#endif
    sum.w = 0;
    acceleration[i] = bath == FROZEN ? (double4)0 : sum * (1.0 / mass);
    if (i == driven.first || i == driven.second) return;
    velocity[i] += half_stage * acceleration[i];
    if (is_last) measure(i, weight, mass, position, velocity, listed, kinetic, extremes);
}

/* Close the stage of a driven pair, after the forces on all points. */
__kernel void close_drive(
    double half_stage, int is_last, double weight, double4 motion, double mass, Driven driven,
    __global const double4 *listed, __global double4 *position, __global double4 *velocity,
    __global double4 *acceleration, __global double *energies, __global double *kinetic,
    __global double4 *extremes)
{
    if (get_global_id(0)) return;
    const int i = driven.first, j = driven.second;
    drive(driven, motion, mass, acceleration, energies);
    velocity[i] += half_stage * acceleration[i];
    velocity[j] += half_stage * acceleration[j];
    constrain(driven, motion, position, velocity);
    energies[WORK] += half_stage * power_of_drive(driven, velocity, energies);
    if (!is_last) return;
    measure(i, weight, mass, position, velocity, listed, kinetic, extremes);
    measure(j, weight, mass, position, velocity, listed, kinetic, extremes);
}
