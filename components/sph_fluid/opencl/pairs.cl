/* Accelerations and rates of density, summed over pairs; laws and structs are printed.

   DIFFUSION, XSPH and DAMPER are defined where a scene has them; VOLUME where particles of the
   boundary have volumes of their own, over that of a particle of the fluid; APPARENT where these
   have velocities of their own that kinematic viscosity sees; CONTACT where the contact potential
   acts at the boundary, and PARTIAL where the mask tells at which of its rows. */

#define AS_IT_IS(slope) slope
#ifdef VOLUME
#define OF_NEAR(slope) (slope * NUMBERS(volume))
#define OF_ITSELF(slope) (slope * volume[i])
#else
#define OF_NEAR(slope) slope
#define OF_ITSELF(slope) slope
#endif

#ifdef APPARENT
#define SEEN_NEAR \
    {GATHERED(apparent, x), GATHERED(apparent, y), GATHERED(apparent, z)}
#define SEEN_ITSELF apparent[i]
#else
#define SEEN_NEAR other
#define SEEN_ITSELF u
#endif

#ifdef PARTIAL
#define MASK_NEAR NUMBERS(mask)
#define MASK_ITSELF mask[i]
#else
#define MASK_NEAR 0
#define MASK_ITSELF 0
#endif
#ifdef CONTACT
#define PRESSED(pressure, mask) \
    (pressure * contact_factor(r2, mask, boundary.contact, constants.smoothing))
#else
#define PRESSED(pressure, mask) pressure
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

#define FORCE(law, sum, terms, weighted, seen, pressure_i, pressure_j) \
    const reals density = GATHERED(position, w); \
    const tuple_3v per = inverses(r2, more + density, constants); \
    const reals approach = dot * per.f1; \
    const reals slope = weighted(gradient(r2, per.f0, constants.smoothing)); \
    const tuple_3v away = {dx, dy, dz}; \
    const reals pressures = pressure_i + pressure_j; \
    fastest = max_reals(fastest, fabs(approach)); \
    density_rate += dot * slope; \
    sum = law(sum, away, own, seen, r2, pressures, approach, slope, per.f1, per.f2, terms)

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
    BoundaryTerms boundary, real4 gravity, __global const real *volume,
    __global const real *mask, __global const real4 *apparent, __global real4 *rate,
    __global double *drift, __global double *minus_rho_div_u, __global double4 *extremes)
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
#ifdef DAMPER
        minus_rho_div_u[i] = sum;
#endif
        extremes[i] = 0;
        return;
    }
    const tuple_3v own = {u.x, u.y, u.z};
    const real more = r.w + constants.base + constants.base;
    tuple_3v force = {0, 0, 0}, push = {0, 0, 0};
    reals density_rate = 0, diffused = 0, fastest = 0;
#ifdef XSPH
    tuple_3v mean = {0, 0, 0};
#endif
    for (int k = 0; k < turn; k += LANES) {
        PAIR(turn);
        FORCE(fluid_force, force, fluid, AS_IT_IS, other, u.w, GATHERED(velocity, w));
#ifdef DIFFUSION
        const reals flux = diffusive_flux(density - r.w, dx, dy, dz, fluid.diffusion);
        diffused += flux * slope * (r2 * per.f1 * per.f2);
#endif
#ifdef XSPH
        const reals weight = kernel_of(r2, constants.smoothing) * per.f2;
        mean.f0 -= weight * (u.x - other.f0);
        mean.f1 -= weight * (u.y - other.f1);
        mean.f2 -= weight * (u.z - other.f2);
#endif
    }
    for (int k = turn; k < last; k += LANES) {
        PAIR(last);
        const tuple_3v apparent_j = SEEN_NEAR;
        const reals pressure_j = PRESSED(GATHERED(velocity, w), MASK_NEAR);
        FORCE(boundary_force, push, boundary, OF_NEAR, apparent_j, u.w, pressure_j);
    }
    const real x = constants.mass * (TOTAL(force.f0) + TOTAL(push.f0)) + gravity.x;
    const real y = constants.mass * (TOTAL(force.f1) + TOTAL(push.f1)) + gravity.y;
    const real z = constants.mass * (TOTAL(force.f2) + TOTAL(push.f2)) + gravity.z;
    const real compression = TOTAL(density_rate);
    rate[i] = (real4)(x, y, z, constants.mass * (compression - TOTAL(diffused)));
#ifdef DAMPER
    minus_rho_div_u[i] = constants.mass * compression;
#endif
#ifdef XSPH
    const double twice = 2 * constants.mass;
    vstore3(twice * (double3)(TOTAL(mean.f0), TOTAL(mean.f1), TOTAL(mean.f2)), i, drift);
#endif
    extremes[i] = (double4)(x * x + y * y + z * z, GREATEST(fastest), 0, 0);
}

/* Forces on samples of surfaces: pair by pair, minus those on the fluid. Lists of samples begin at
   `listed`, or stand at their rows if that is negative. */
__kernel void sample_forces(
    int samples, __global const int *row, int listed, __global const real4 *position,
    __global const real4 *velocity, __global const int *near, __global const int *end,
    long row_stride, long item_stride, Constants constants, BoundaryTerms boundary,
    __global const real *volume, __global const real *mask, __global const real4 *apparent,
    __global double4 *force)
{
    const int s = get_global_id(0);
    if (s >= samples) return;
    const int i = row[s], list = listed < 0 ? i : listed + s;
    const real4 r = position[i], u = velocity[i];
    const size_t place = (size_t)list * row_stride;
    const int last = end[list];
    const real far = 4 * constants.smoothing.length_;
    const real4 seen = SEEN_ITSELF;
    const tuple_3v own = {seen.x, seen.y, seen.z};
    const real more = r.w + constants.base + constants.base;
    tuple_3v push = {0, 0, 0};
    reals density_rate = 0, fastest = 0;
    for (int k = 0; k < last; k += LANES) {
        PAIR(last);
        const reals pressure_j = GATHERED(velocity, w);
        const reals pressure_i = PRESSED(u.w, MASK_ITSELF);
        FORCE(boundary_force, push, boundary, OF_ITSELF, other, pressure_i, pressure_j);
    }
    const double square = constants.mass * constants.mass;
    force[s] = (double4)(
        square * TOTAL(push.f0), square * TOTAL(push.f1), square * TOTAL(push.f2), 0);
}
