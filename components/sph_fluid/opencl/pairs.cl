/* Accelerations and rates of density, summed over pairs; laws and structs are printed.

   LANES neighbours are summed at a time, each lane by itself, and the lanes are added in order at
   the end. Where a list ends before its last lanes do, these have the particle itself, moved out of
   its own reach. DIFFUSION is defined where a scene has it; WALL_VOLUME, a wall particle's volume
   over that of a particle of the fluid, where they differ. */

#if LANES == 4
#define GATHERED(array, part) \
    ((reals)(array[j0].part, array[j1].part, array[j2].part, array[j3].part))
#define TOTAL(lanes) ((lanes.x + lanes.y) + (lanes.z + lanes.w))
#define GREATEST(lanes) max_real(max_real(lanes.x, lanes.y), max_real(lanes.z, lanes.w))
#define NEAR(lane) (k + lane < stop ? near[place + item_stride * (k + lane)] : i)
#define ROWS const int j0 = NEAR(0), j1 = NEAR(1), j2 = NEAR(2), j3 = NEAR(3)
#define BEYOND(x) \
    (k + 4 <= stop ? (reals)0 : (reals)(0, k + 1 < stop ? 0 : x, k + 2 < stop ? 0 : x, x))
#elif LANES == 1
#define GATHERED(array, part) array[j].part
#define TOTAL(lanes) lanes
#define GREATEST(lanes) lanes
#define ROWS const int j = near[place + item_stride * k]
#define BEYOND(x) 0
#else
#error "LANES must be 1 or 4"
#endif

#define AS_IT_IS(slope) slope
#ifdef WALL_VOLUME
#define OF_WALLS(slope) (slope * (real)WALL_VOLUME)
#else
#define OF_WALLS(slope) slope
#endif

/* Neighbours k to k + LANES of row i: what all sums need. */
#define PAIR(stop_) \
    const int stop = stop_; \
    ROWS; \
    const reals dx = r.x - GATHERED(position, x) + BEYOND(far); \
    const reals dy = r.y - GATHERED(position, y), dz = r.z - GATHERED(position, z); \
    const tuple_3v other = { \
        GATHERED(velocity, x), GATHERED(velocity, y), GATHERED(velocity, z)}; \
    const reals r2 = dx * dx + dy * dy + dz * dz; \
    const reals dot = dx * (u.x - other.f0) + dy * (u.y - other.f1) + dz * (u.z - other.f2)

#define FORCE(law, sum, terms, weighted) \
    const reals density = GATHERED(position, w); \
    const tuple_3v per = inverses(r2, more + density, constants); \
    const reals approach = dot * per.f1; \
    const reals slope = weighted(gradient(r2, per.f0, constants.smoothing)); \
    const tuple_3v away = {dx, dy, dz}; \
    const reals pressures = u.w + GATHERED(velocity, w); \
    fastest = max_reals(fastest, fabs(approach)); \
    density_rate += dot * slope; \
    sum = law(sum, away, own, other, r2, pressures, approach, slope, per.f1, per.f2, terms)

/* Of a wall whose density obeys the equation of continuity. */
static real continuity(
    int i, int last, real4 r, real4 u, __global const real4 *position,
    __global const real4 *velocity, __global const int *near, size_t place, long item_stride,
    real far, Constants constants)
{
    reals sum = 0;
    for (int k = 0; k < last; k += LANES) {
        PAIR(last);
        sum += dot * gradient(r2, 1 / sqrt(r2 + constants.smoothing.tiny), constants.smoothing);
    }
    return constants.mass * TOTAL(sum);
}

__kernel void rates(
    int split, int count, __global const real4 *position, __global const real4 *velocity,
    __global const int *near, __global const int *middle, __global const int *end,
    long row_stride, long item_stride, Constants constants, FluidTerms fluid,
    BoundaryTerms boundary, real4 gravity, __global real4 *rate, __global double4 *extremes)
{
    const int i = get_global_id(0);
    if (i >= count) return;
    const real4 r = position[i], u = velocity[i];
    const size_t place = (size_t)i * row_stride;
    const int last = end[i], turn = middle[i];
    const real far = 4 * constants.smoothing.length_;
    if (i >= split) {
        const real sum = continuity(
            i, last, r, u, position, velocity, near, place, item_stride, far, constants);
        rate[i] = (real4)(0, 0, 0, sum);
        extremes[i] = 0;
        return;
    }
    const tuple_3v own = {u.x, u.y, u.z};
    const real more = r.w + constants.base + constants.base;
    tuple_3v force = {0, 0, 0}, push = {0, 0, 0};
    reals density_rate = 0, fastest = 0;
    for (int k = 0; k < turn; k += LANES) {
        PAIR(turn);
        FORCE(fluid_force, force, fluid, AS_IT_IS);
#ifdef DIFFUSION
        const reals flux = diffusive_flux(density - r.w, dx, dy, dz, fluid.diffusion);
        density_rate -= flux * slope * (r2 * per.f1 * per.f2);
#endif
    }
    for (int k = turn; k < last; k += LANES) {
        PAIR(last);
        FORCE(boundary_force, push, boundary, OF_WALLS);
    }
    const real x = constants.mass * (TOTAL(force.f0) + TOTAL(push.f0)) + gravity.x;
    const real y = constants.mass * (TOTAL(force.f1) + TOTAL(push.f1)) + gravity.y;
    const real z = constants.mass * (TOTAL(force.f2) + TOTAL(push.f2)) + gravity.z;
    rate[i] = (real4)(x, y, z, constants.mass * TOTAL(density_rate));
    extremes[i] = (double4)(x * x + y * y + z * z, GREATEST(fastest), 0, 0);
}
