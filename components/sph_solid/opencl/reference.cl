/* Sums over the neighbours of the start; laws and structs are printed, see
   kernels/reference_laws.py. Rows of `start` are places at the start, and the number of the joined
   bodies. A tensor has three rows of four numbers: nine of it, and of P B also rho and rho_0. */

#if LANES == 4
#define ITEM(array, k, part) \
    ((reals)(array[3 * j0 + k].part, array[3 * j1 + k].part, array[3 * j2 + k].part, \
             array[3 * j3 + k].part))
#else
#define ITEM(array, k, part) array[3 * j + k].part
#endif
/* T_i + T_j of the rows a, b, c of particle i. */
#define BOTH(array, a, b, c) \
    {a.x + ITEM(array, 0, x), a.y + ITEM(array, 0, y), a.z + ITEM(array, 0, z), \
     a.w + ITEM(array, 0, w), b.x + ITEM(array, 1, x), b.y + ITEM(array, 1, y), \
     b.z + ITEM(array, 1, z), b.w + ITEM(array, 1, w), c.x + ITEM(array, 2, x)}
#define DOT(a, b) (a.f0 * b.f0 + a.f1 * b.f1 + a.f2 * b.f2)
/* A difference x_i - x_j, moved along x. */
#define APART(r, array, along) \
    {r.x - GATHERED(array, x) + along, r.y - GATHERED(array, y), r.z - GATHERED(array, z)}
#define NO_SUMS {0, 0, 0, 0, 0, 0, 0, 0, 0}
#define TOTALS(m) \
    {TOTAL(m.f0), TOTAL(m.f1), TOTAL(m.f2), TOTAL(m.f3), TOTAL(m.f4), TOTAL(m.f5), TOTAL(m.f6), \
     TOTAL(m.f7), TOTAL(m.f8)}
#define SIX_TOTALS(m) \
    {TOTAL(m.f0), TOTAL(m.f1), TOTAL(m.f2), TOTAL(m.f3), TOTAL(m.f4), TOTAL(m.f5)}

/* Neighbours k to k + LANES of row i: how far they were, and V_j times the kernel's slope. */
#define PAIR_OF_START \
    ROWS; \
    const tuple_3v from = APART(here, start, BEYOND(far)); \
    const reals square = DOT(from, from), volume = GATHERED(position, w); \
    const reals weight = \
        gradient(square, 1 / sqrt(square + law.smoothing.tiny), law.smoothing) * volume

/* Add what gives F of row i: (x_j - x_i) by the slope, and (X_j - X_i) by it. */
#define ADD_DEFORMATION \
    const tuple_3v slope = {weight * from.f0, weight * from.f1, weight * from.f2}; \
    const tuple_3v to = { \
        GATHERED(position, x) - r.x, GATHERED(position, y) - r.y, GATHERED(position, z) - r.z}; \
    sums = add_outer(sums, to, slope); \
    moments = add_moments(moments, from, slope)

#define ROW_OF_START \
    const int i = get_global_id(0); \
    if (i >= count) return; \
    const double4 here = start[i], r = position[i]; \
    const size_t place = (size_t)i * row_stride; \
    const int stop = end[i]; \
    const double far = 4 * law.smoothing.length_

/* Let particles of bodies that are not joined be no neighbours: each is its own instead. */
__kernel void part_bodies(
    int count, __global const double4 *start, __global const int *end, long row_stride,
    long item_stride, __global int *near)
{
    const int i = get_global_id(0);
    if (i >= count) return;
    for (int k = 0; k < end[i]; k++) {
        __global int *j = &near[i * row_stride + k * item_stride];
        if (start[*j].w != start[i].w) *j = i;
    }
}

/* The gradient of velocity of each particle. */
__kernel void reference_gradients(
    int count, __global const double4 *start, __global const double4 *position,
    __global const double4 *motion, __global const int *near, __global const int *end,
    long row_stride, long item_stride, PairLaw law, __global double *gradients)
{
    ROW_OF_START;
    const double4 u = motion[i];
    tuple_9v sums = NO_SUMS, rates = NO_SUMS;
    tuple_6v moments = {0, 0, 0, 0, 0, 0};
    for (int k = 0; k < stop; k += LANES) {
        PAIR_OF_START;
        ADD_DEFORMATION;
        const tuple_3v change = {
            GATHERED(motion, x) - u.x, GATHERED(motion, y) - u.y, GATHERED(motion, z) - u.z};
        rates = add_outer(rates, change, slope);
    }
    const tuple_9r of_places = TOTALS(sums), of_velocities = TOTALS(rates);
    const tuple_6r matrix = SIX_TOTALS(moments);
    const Deformation f = deformation(of_places, matrix, law);
    const tuple_9r m = rate_of_deformation(of_velocities, f.f1, f.f0);
    vstore3((double3)(m.f0, m.f1, m.f2), 3 * i, gradients);
    vstore3((double3)(m.f3, m.f4, m.f5), 3 * i + 1, gradients);
    vstore3((double3)(m.f6, m.f7, m.f8), 3 * i + 2, gradients);
}

/* Replace the stresses of particles, sigma/eta^2, by the nominal ones, P B; write F. */
__kernel void nominal_stresses(
    int count, __global const double4 *start, __global const double4 *position,
    __global const int *near, __global const int *end, long row_stride, long item_stride,
    PairLaw law, __global double4 *stress, __global double4 *deformed)
{
    ROW_OF_START;
    tuple_9v sums = NO_SUMS;
    tuple_6v moments = {0, 0, 0, 0, 0, 0};
    for (int k = 0; k < stop; k += LANES) {
        PAIR_OF_START;
        ADD_DEFORMATION;
    }
    const tuple_9r of_places = TOTALS(sums);
    const tuple_6r matrix = SIX_TOTALS(moments);
    const Deformation now = deformation(of_places, matrix, law);
    const double4 s = stress[3 * i], t = stress[3 * i + 1];
    const tuple_6r tau = {s.x, s.y, s.z, s.w, t.x, t.y};
    const tuple_9r p = nominal_stress(tau, t.z / t.w, now.f0, now.f1), f = now.f0;
    stress[3 * i] = (double4)(p.f0, p.f1, p.f2, p.f3);
    stress[3 * i + 1] = (double4)(p.f4, p.f5, p.f6, p.f7);
    stress[3 * i + 2] = (double4)(p.f8, t.z, t.w, 0);
    deformed[3 * i] = (double4)(f.f0, f.f1, f.f2, f.f3);
    deformed[3 * i + 1] = (double4)(f.f4, f.f5, f.f6, f.f7);
    deformed[3 * i + 2] = (double4)(f.f8, 0, 0, 0);
}

/* Accelerations by stresses; in `heats` those by the viscosity and the penalty, which heat; and
   minus the stable step in the first column of `extremes`. `motion` ends with the speed of sound. */
__kernel void reference_accelerations(
    int count, double penalty, __global const double4 *start, __global const double4 *position,
    __global const double4 *motion, __global const double4 *nominal,
    __global const double4 *deformed, __global const int *near, __global const int *end,
    long row_stride, long item_stride, PairLaw law, __global double *forced,
    __global double *heats, __global double *heating, __global double4 *extremes)
{
    ROW_OF_START;
    const double4 u = motion[i];
    const double4 s = nominal[3 * i], t = nominal[3 * i + 1], p = nominal[3 * i + 2];
    const double4 f = deformed[3 * i], g = deformed[3 * i + 1], h = deformed[3 * i + 2];
    tuple_3v force = {0, 0, 0}, pushed = {0, 0, 0};
    reals heat = 0, fastest = 0;
    for (int k = 0; k < stop; k += LANES) {
        PAIR_OF_START;
        const tuple_9v stress = BOTH(nominal, s, t, p), strain = BOTH(deformed, f, g, h);
        const tuple_3v pulls = along(stress, from), stretched = along(strain, from);
        force.f0 += weight * pulls.f0;
        force.f1 += weight * pulls.f1;
        force.f2 += weight * pulls.f2;
        const tuple_3v apart = APART(r, position, 0), change = APART(u, motion, 0);
        const reals now = DOT(apart, apart), dot = DOT(apart, change);
        const reals mu = approach(dot, now, law), sound = GATHERED(motion, w);
        const reals density = ITEM(nominal, 2, y), rest = ITEM(nominal, 2, z);
        const reals q = viscous_pressure(mu, u.w + sound, 1 / (p.y + density), p.z * rest, law);
        const reals stiff = 0.5 * (p.z + rest) * u.w * sound;
        const reals push = push_less_drag(
            square, now, DOT(stretched, apart), weight, volume, stiff, q, penalty, law);
        heat -= push * dot;
        pushed.f0 += push * apart.f0;
        pushed.f1 += push * apart.f1;
        pushed.f2 += push * apart.f2;
        fastest = max_reals(fastest, mu);
    }
    const double per = 1.0 / p.z;
    vstore3(per * (double3)(TOTAL(force.f0), TOTAL(force.f1), TOTAL(force.f2)), i, forced);
    vstore3(per * (double3)(TOTAL(pushed.f0), TOTAL(pushed.f1), TOTAL(pushed.f2)), i, heats);
    heating[i] = 0.5 * TOTAL(heat) * per;
    extremes[i] = (double4)(-stable_step(u.w, GREATEST(fastest), law), 0, 0, 0);
}
