/* Sums over pairs: the gradient of velocity, and accelerations. Laws and structs are printed.

   CORRECTED is defined where gradients are corrected, RINGS where neighbours are azimuthal images
   of rings: images at both sides cancel along y, and one of the two is listed. A row of stress has
   WIDTH rows of four numbers: six of tau, or nine where gradients are corrected, then rho and
   rho_0; where ARTIFICIAL is defined six of the artificial stress follow. */

#if LANES == 4
#define STRESS(k, part) \
    ((reals)(stress[WIDTH * j0 + k].part, stress[WIDTH * j1 + k].part, \
             stress[WIDTH * j2 + k].part, stress[WIDTH * j3 + k].part))
#else
#define STRESS(k, part) stress[WIDTH * j + k].part
#endif

#ifdef RINGS
#define ACROSS 0
#if LANES == 4
#define TURN(lane) (k + lane < stop ? turn[place + item_stride * (k + lane)] : 0)
#define TURNS_OF_ROWS const int t0 = TURN(0), t1 = TURN(1), t2 = TURN(2), t3 = TURN(3)
#define TURNED(part) ((reals)(turns[t0].part, turns[t1].part, turns[t2].part, turns[t3].part))
#else
#define TURNS_OF_ROWS const int turn_of_row = turn[place + item_stride * k]
#define TURNED(part) turns[turn_of_row].part
#endif
#define VECTOR(array) \
    turned_vector(cosine, sine, GATHERED(array, x), GATHERED(array, z))
#define VOLUME (TURNED(z) * GATHERED(position, w))
#define TURN_BY const reals cosine = TURNED(x), sine = TURNED(y)
#define SIX \
    turned_six(cosine, sine, STRESS(0, x), STRESS(0, y), STRESS(0, z), STRESS(1, y))
#define NINE \
    turned_nine( \
        cosine, sine, STRESS(0, x), STRESS(0, z), STRESS(1, x), STRESS(1, z), STRESS(2, x))
#else
#define ACROSS 1
#define TURNS_OF_ROWS
#define TURN_BY
#define VECTOR(array) {GATHERED(array, x), GATHERED(array, y), GATHERED(array, z)}
#define VOLUME GATHERED(position, w)
#define SIX \
    {STRESS(0, x), STRESS(0, y), STRESS(0, z), STRESS(0, w), STRESS(1, x), STRESS(1, y)}
#define NINE \
    {STRESS(0, x), STRESS(0, y), STRESS(0, z), STRESS(0, w), STRESS(1, x), STRESS(1, y), \
     STRESS(1, z), STRESS(1, w), STRESS(2, x)}
#endif

/* Neighbours k to k + LANES of row i: what both sums need. */
#define PAIR \
    ROWS; \
    TURNS_OF_ROWS; \
    TURN_BY; \
    const tuple_3v at = VECTOR(position), other = VECTOR(motion); \
    const reals dx = r.x - at.f0 + BEYOND(far), dy = r.y - at.f1, dz = r.z - at.f2; \
    const reals r2 = dx * dx + dy * dy + dz * dz; \
    const reals volume = VOLUME, last = GATHERED(motion, w)

/* A row of places or motion, without its part along y for rings. */
static double4 row_of(__global const double4 *rows, int i)
{
    double4 row = rows[i];
    row.y *= ACROSS;
    return row;
}

/* eta L of each particle, or L where it is corrected; `motion` ends with whether it has failed. */
__kernel void velocity_gradients(
    int count, __global const double4 *position, __global const double4 *motion,
    __global const int *near, __global const int *end, long row_stride, long item_stride,
    __global const int *turn, __global const double4 *turns, PairLaw law,
    __global double *gradients, __global double *corrections)
{
    const int i = get_global_id(0);
    if (i >= count) return;
    const double4 r = row_of(position, i), u = row_of(motion, i);
    const size_t place = (size_t)i * row_stride;
    const int stop = end[i];
    const double far = 4 * law.smoothing.length_;
    tuple_9v sums = {0, 0, 0, 0, 0, 0, 0, 0, 0};
#ifdef CORRECTED
    tuple_6v moments = {0, 0, 0, 0, 0, 0};
    reals broken = 0;
#endif
    for (int k = 0; k < stop; k += LANES) {
        PAIR;
        const reals weight =
            gradient(r2, 1 / sqrt(r2 + law.smoothing.tiny), law.smoothing) * volume;
        const tuple_3v slope = {weight * dx, weight * dy, weight * dz};
        const tuple_3v change = {other.f0 - u.x, other.f1 - u.y, other.f2 - u.z};
        sums = add_outer(sums, change, slope);
#ifdef CORRECTED
        const tuple_3v offset = {dx, dy, dz};
        moments = add_moments(moments, offset, slope);
        broken -= weight * last;
#endif
    }
    tuple_9r gradient_of = {
        TOTAL(sums.f0), TOTAL(sums.f1) * ACROSS, TOTAL(sums.f2), TOTAL(sums.f3) * ACROSS,
        TOTAL(sums.f4), TOTAL(sums.f5) * ACROSS, TOTAL(sums.f6), TOTAL(sums.f7) * ACROSS,
        TOTAL(sums.f8)};
#ifdef CORRECTED
    const tuple_6r matrix = {
        TOTAL(moments.f0), TOTAL(moments.f1), TOTAL(moments.f2), TOTAL(moments.f3) * ACROSS,
        TOTAL(moments.f4) * ACROSS, TOTAL(moments.f5)};
    const int whole = u.w == 0 && TOTAL(broken) == 0;
    const Corrected exact = corrected(gradient_of, matrix, whole, law);
    gradient_of = exact.f0;
    const tuple_6r b = exact.f1;
    vstore3((double3)(b.f0, b.f1, b.f2), 2 * i, corrections);
    vstore3((double3)(b.f3, b.f4, b.f5), 2 * i + 1, corrections);
#endif
    const tuple_9r m = gradient_of;
    vstore3((double3)(m.f0, m.f1, m.f2), 3 * i, gradients);
    vstore3((double3)(m.f3, m.f4, m.f5), 3 * i + 1, gradients);
    vstore3((double3)(m.f6, m.f7, m.f8), 3 * i + 2, gradients);
}

/* Accelerations, what the artificial viscosity heats by, and minus the stable step in the first
   column of `extremes`; `motion` ends with the speed of sound. */
__kernel void accelerations(
    int count, __global const double4 *position, __global const double4 *motion,
    __global const double4 *stress, __global const int *near, __global const int *end,
    long row_stride, long item_stride, __global const int *turn, __global const double4 *turns,
    PairLaw law, __global double *acceleration, __global double *heating, __global double4 *extremes)
{
    const int i = get_global_id(0);
    if (i >= count) return;
    const double4 r = row_of(position, i), u = row_of(motion, i);
    const double4 s = stress[WIDTH * i], t = stress[WIDTH * i + 1];
#ifdef CORRECTED
    const double4 rest = stress[WIDTH * i + 2];
    const double density = rest.y, start = rest.z;
#else
    const double density = t.z, start = t.w;
#endif
    const size_t place = (size_t)i * row_stride;
    const int stop = end[i];
    const double far = 4 * law.smoothing.length_;
    tuple_4v sums = {0, 0, 0, 0};
    reals fastest = 0;
#ifdef ARTIFICIAL
    const double4 p = stress[WIDTH * i + 2], o = stress[WIDTH * i + 3];
#else
    const tuple_3v push = {0, 0, 0};
#endif
    for (int k = 0; k < stop; k += LANES) {
        PAIR;
        const tuple_3v offset = {dx, dy, dz};
        const tuple_3v change = {u.x - other.f0, u.y - other.f1, u.z - other.f2};
        const reals dot = dx * change.f0 + dy * change.f1 + dz * change.f2;
#ifdef CORRECTED
        const reals density_j = STRESS(2, y), start_j = STRESS(2, z);
        const tuple_9v t_j = NINE;
        const tuple_9v both = {
            s.x + t_j.f0, s.y + t_j.f1, s.z + t_j.f2, s.w + t_j.f3, t.x + t_j.f4, t.y + t_j.f5,
            t.z + t_j.f6, t.w + t_j.f7, rest.x + t_j.f8};
#else
        const reals density_j = STRESS(1, z), start_j = STRESS(1, w);
        const tuple_6v t_j = SIX;
        const reals xy = s.w + t_j.f3, yz = t.x + t_j.f4, zx = t.y + t_j.f5;
        const tuple_9v both = {s.x + t_j.f0, xy, zx, xy, s.y + t_j.f1, yz, zx, yz, s.z + t_j.f2};
#endif
        const tuple_3v per = inverses(r2, density + density_j, law);
        const reals weight = gradient(r2, per.f0, law.smoothing) * volume;
        const reals mu = law.smoothing.length_ * max_reals(-dot, (reals)0) * per.f1;
        const reals q = viscous_pressure(mu, u.w + last, per.f2, start * start_j, law);
        fastest = max_reals(fastest, mu);
#ifdef ARTIFICIAL
        const tuple_6v repels = {
            p.x + STRESS(2, x), p.y + STRESS(2, y), p.z + STRESS(2, z), p.w + STRESS(2, w),
            o.x + STRESS(3, x), o.y + STRESS(3, y)};
        const tuple_3v push = repelled(repels, offset, r2, law);
#endif
        sums = add_force(sums, offset, change, dot, weight, both, q, push, law);
    }
    const double per_start = 1.0 / start;
    const double3 a =
        (double3)(TOTAL(sums.f0), TOTAL(sums.f1) * ACROSS, TOTAL(sums.f2)) * per_start;
    vstore3(a, i, acceleration);
    heating[i] = 0.5 * TOTAL(sums.f3) * per_start;
    extremes[i] = (double4)(-stable_step(u.w, GREATEST(fastest), law), 0, 0, 0);
}
