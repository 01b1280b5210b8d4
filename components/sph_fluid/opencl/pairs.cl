/* Accelerations and rates of density, summed over pairs; laws and structs are printed.

   Of what a scene has not, nothing is compiled: DIFFUSION, DYNAMIC (walls whose density obeys the
   equation of continuity). */

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
    if (i >= split) {
        real sum = 0;
        for (int k = 0; k < last; k++) {
            const int j = near[place + item_stride * k];
            const real4 d = r - position[j], du = u - velocity[j];
            const real r2 = d.x * d.x + d.y * d.y + d.z * d.z;
            const real dot = d.x * du.x + d.y * du.y + d.z * du.z;
            const real per_r = 1 / sqrt(r2 + constants.smoothing.tiny);
            sum += dot * gradient(r2, per_r, constants.smoothing);
        }
        rate[i] = (real4)(0, 0, 0, constants.mass * sum);
        extremes[i] = 0;
        return;
    }
    const tuple_3r own = {u.x, u.y, u.z};
    const real more = r.w + constants.base + constants.base;
    tuple_3r force = {0, 0, 0}, push = {0, 0, 0};
    real density_rate = 0, wall_rate = 0, fastest = 0;
    for (int k = 0; k < last; k++) {
        const int j = near[place + item_stride * k];
        const real4 s = position[j], v = velocity[j];
        const real4 d = r - s, du = u - v;
        const real r2 = d.x * d.x + d.y * d.y + d.z * d.z;
        const real dot = d.x * du.x + d.y * du.y + d.z * du.z;
        const tuple_3r each = inverses(r2, more + s.w, constants);
        const real approach = dot * each.f1;
        const real slope = gradient(r2, each.f0, constants.smoothing);
        const tuple_3r away = {d.x, d.y, d.z}, other = {v.x, v.y, v.z};
        fastest = max_real(fastest, fabs(approach));
        if (k < turn) {
            density_rate += dot * slope;
            force = fluid_force(
                force, away, own, other, r2, u.w + v.w, approach, slope, each.f1, each.f2, fluid);
#ifdef DIFFUSION
            const real flux = diffusive_flux(s.w - r.w, d.x, d.y, d.z, fluid.diffusion);
            density_rate -= flux * slope * (r2 * each.f1 * each.f2);
#endif
        } else {
            wall_rate += dot * slope;
            push = boundary_force(
                push, away, own, other, r2, u.w + v.w, approach, slope, each.f1, each.f2,
                boundary);
        }
    }
    const real x = constants.mass * (force.f0 + push.f0) + gravity.x;
    const real y = constants.mass * (force.f1 + push.f1) + gravity.y;
    const real z = constants.mass * (force.f2 + push.f2) + gravity.z;
    rate[i] = (real4)(x, y, z, constants.mass * (density_rate + wall_rate));
    extremes[i] = (double4)(x * x + y * y + z * z, fastest, 0, 0);
}
