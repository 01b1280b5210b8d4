/* Walls and samples whose density is mirrored, in double precision; laws and structs are printed.
   See boundary/kernels/mirrored_density.py. */

typedef struct {
    double mean, rise, volume;
} Fit;

/* Mean of the excess density around a point, rise from there to a target, and the volume summed,
   by a list around the point; the target stands at row i. */
static Fit fit_density(
    double3 at, double4 to, int i, int list, __global const double4 *position,
    __global const int *near, __global const int *end, long row_stride, long item_stride,
    Constants constants)
{
    const double inverse = 1.0 / constants.smoothing.length_;
    const double far = 100 * constants.smoothing.length_;
    const size_t place = (size_t)list * row_stride;
    const int stop = end[list];
    tuple_10v lanes = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    reals sums = 0, along_x = 0, along_y = 0, along_z = 0;
    for (int k = 0; k < stop; k += LANES) {
        ROWS;
        reals dx = GATHERED(position, x) - at.x + BEYOND(far);
        reals dy = GATHERED(position, y) - at.y, dz = GATHERED(position, z) - at.z;
        const reals density = GATHERED(position, w);
        const reals weight =
            kernel_in_lanes(dx * dx + dy * dy + dz * dz, constants.smoothing) * constants.mass
            / density;
        dx *= inverse, dy *= inverse, dz *= inverse;
        lanes = add_moments(lanes, weight, dx, dy, dz);
        const reals excess = weight * (density - constants.density);
        sums += excess;
        along_x += excess * dx;
        along_y += excess * dy;
        along_z += excess * dz;
    }
    const tuple_10r moments = {
        TOTAL(lanes.f0), TOTAL(lanes.f1), TOTAL(lanes.f2), TOTAL(lanes.f3), TOTAL(lanes.f4),
        TOTAL(lanes.f5), TOTAL(lanes.f6), TOTAL(lanes.f7), TOTAL(lanes.f8), TOTAL(lanes.f9)};
    const double sum = TOTAL(sums);
    const double bx = TOTAL(along_x), by = TOTAL(along_y), bz = TOTAL(along_z);
    Fit fit = {0, 0, moments.f0};
    if (fit.volume < NO_FLUID) return fit;
    fit.mean = sum / fit.volume;
    const Moments about = mean_and_variance(moments);
    const tuple_3r middle = about.f0;
    const tuple_3r slope = solve(
        about.f1, bx / fit.volume - middle.f0 * fit.mean, by / fit.volume - middle.f1 * fit.mean,
        bz / fit.volume - middle.f2 * fit.mean);
    fit.rise = slope.f0 * ((to.x - at.x) * inverse - middle.f0)
        + slope.f1 * ((to.y - at.y) * inverse - middle.f1)
        + slope.f2 * ((to.z - at.z) * inverse - middle.f2);
    return fit;
}

/* Density and p/rho^2 of walls and samples, as if the fluid went on into them. A sample whose
   mirror point sees no fluid takes the mean around itself; its list stands behind those of all.
   Samples under the contact potential have neither. */
__kernel void extrapolate_density(
    int split, int count, __global const double *mirror, __global const long *sample,
    __global double4 *position, __global double4 *velocity, __global const int *near,
    __global const int *end, long row_stride, long item_stride, double rest_gradient,
    Constants constants)
{
    const int b = get_global_id(0), i = split + b;
    if (i >= count || sample[b] == BY_POTENTIAL) return;
    const double4 to = position[i];
    double3 at = vload3(b, mirror);
    Fit fit = fit_density(at, to, i, i, position, near, end, row_stride, item_stride, constants);
    if (fit.volume < NO_FLUID && sample[b] >= 0) {
        const int row = count + sample[b];
        at = to.xyz;
        fit = fit_density(at, to, i, row, position, near, end, row_stride, item_stride, constants);
        fit.rise = 0;
    }
    const tuple_3r target = {to.x, to.y, to.z};
    const double far = distance_to(target, at.x, at.y, at.z);
    const double most = max_real(fit.mean, 0.0) + rest_gradient * far;
    const double excess = fit.mean + min_real(fit.rise, most);
    const double density = constants.density + max_real(excess, 0.0);
    position[i].w = density;
    velocity[i].w = pressure_term(density, constants);
}

/* Velocities of walls and samples that bring the fluid to rest at the face, for viscosity. */
__kernel void mirror_velocity(
    int split, int count, __global const double *mirror, __global const double4 *position,
    __global const double4 *velocity, __global const int *near, __global const int *end,
    long row_stride, long item_stride, Constants constants, __global RATE4 *apparent)
{
    const int b = get_global_id(0), i = split + b;
    if (i >= count) return;
    const double3 at = vload3(b, mirror);
    const double inverse = 1.0 / constants.smoothing.length_;
    const size_t place = (size_t)i * row_stride;
    tuple_10r moments = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    for (int k = 0; k < end[i]; k++) {
        const double4 r = position[near[place + item_stride * k]];
        const double3 d = r.xyz - at;
        const double weight = kernel_of(square_of(d), constants.smoothing) * constants.mass / r.w;
        moments = add_moment(
            moments, weight, d.x * inverse, d.y * inverse, d.z * inverse);
    }
    double4 u = velocity[i];
    if (moments.f0 >= NO_FLUID) {
        const Moments about = mean_and_variance(moments);
        const tuple_3r middle = about.f0;
        const tuple_3r slope = solve(about.f1, -middle.f0, -middle.f1, -middle.f2);
        double3 there = 0;
        for (int k = 0; k < end[i]; k++) {
            const int j = near[place + item_stride * k];
            const double4 r = position[j];
            const double3 d = r.xyz - at;
            const double weight =
                kernel_of(square_of(d), constants.smoothing) * constants.mass / r.w;
            const double share = weight / moments.f0
                * (1.0 + slope.f0 * (d.x * inverse - middle.f0)
                   + slope.f1 * (d.y * inverse - middle.f1)
                   + slope.f2 * (d.z * inverse - middle.f2));
            there += share * velocity[j].xyz;
        }
        u.xyz = 2.0 * u.xyz - there;
    }
    apparent[i] = (RATE4)(u.x, u.y, u.z, 0);
}
