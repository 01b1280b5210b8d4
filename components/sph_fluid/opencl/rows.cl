/* Loops over rows of a fluid in double precision; laws and structs are printed. */

/* Extents, densities, and what is outside of the tank, for the sort by cells. */
__kernel void survey(
    __global const double4 *position, int split, int walled, double4 low, double4 high,
    __global double4 *most, __global double4 *least)
{
    const int i = get_global_id(0);
    if (i >= split) return;
    const double4 r = position[i];
    const int inside = r.x >= low.x && r.y >= low.y && r.z >= low.z && r.x <= high.x
        && r.y <= high.y && r.z <= high.z;
    most[i] = r;
    least[i] = (double4)(-r.xyz, walled && !inside);
}

__kernel void gather_fluid(
    __global const long *key, int split, __global const double4 *position,
    __global const double4 *velocity, __global const double *previous,
    __global const long *identity, __global double4 *position_to, __global double4 *velocity_to,
    __global double *previous_to, __global long *identity_to)
{
    const int i = get_global_id(0);
    if (i >= split) return;
    const int j = key[i] & ROW;
    position_to[i] = position[j];
    velocity_to[i] = velocity[j];
    previous_to[i] = previous[j];
    identity_to[i] = identity[j];
}

__kernel void gather_boundary(
    __global const long *key, int split, int count, __global const double4 *position,
    __global const double4 *velocity, __global const double *previous,
    __global const double *mirror, __global double4 *position_to, __global double4 *velocity_to,
    __global double *previous_to, __global double *mirror_to)
{
    const int b = get_global_id(0);
    if (b >= count) return;
    const int i = split + b, j = key[b] & ROW;
    position_to[i] = position[j];
    velocity_to[i] = velocity[j];
    previous_to[i] = previous[j];
    if (mirror) vstore3(vload3(j - split, mirror), b, mirror_to);
}

__kernel void note_places(
    __global const double4 *position, int count, __global double *reference)
{
    const int i = get_global_id(0);
    if (i < count) vstore3(position[i].xyz, i, reference);
}

/* A copy in single precision, less an origin. */
__kernel void narrow(
    __global const double4 *from, int count, double4 origin, __global float4 *to)
{
    const int i = get_global_id(0);
    if (i < count) to[i] = convert_float4(from[i] - origin);
}

/* Density and p/rho^2 of walls, as if the fluid went on into them: see
   boundary/kernels/mirrored_density.py:extrapolate_density. */
__kernel void extrapolate_density(
    int split, int count, __global const double *mirror, __global double4 *position,
    __global double4 *velocity, __global const int *near, __global const int *end,
    long row_stride, long item_stride, double rest_gradient, Constants constants)
{
    const int b = get_global_id(0), i = split + b;
    if (i >= count) return;
    const double4 to = position[i];
    const double3 at = vload3(b, mirror);
    const double inverse = 1.0 / constants.smoothing.length_;
    tuple_10r moments = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    double sum = 0, bx = 0, by = 0, bz = 0, mean = 0, rise = 0;
    for (int k = 0; k < end[i]; k++) {
        const double4 r = position[near[(size_t)i * row_stride + item_stride * k]];
        double3 d = r.xyz - at;
        const double weight =
            kernel_of(d.x * d.x + d.y * d.y + d.z * d.z, constants.smoothing) * constants.mass
            / r.w;
        d *= inverse;
        moments = add_moments(moments, weight, d.x, d.y, d.z);
        const double excess = weight * (r.w - constants.density);
        sum += excess;
        bx += excess * d.x;
        by += excess * d.y;
        bz += excess * d.z;
    }
    const double volume = moments.f0;
    if (volume >= NO_FLUID) {
        mean = sum / volume;
        const Moments about = mean_and_variance(moments);
        const tuple_3r middle = about.f0;
        const tuple_3r slope = solve(
            about.f1, bx / volume - middle.f0 * mean, by / volume - middle.f1 * mean,
            bz / volume - middle.f2 * mean);
        rise = slope.f0 * ((to.x - at.x) * inverse - middle.f0)
            + slope.f1 * ((to.y - at.y) * inverse - middle.f1)
            + slope.f2 * ((to.z - at.z) * inverse - middle.f2);
    }
    const tuple_3r target = {to.x, to.y, to.z};
    const double far = distance_to(target, at.x, at.y, at.z);
    const double excess = mean + min_real(rise, max_real(mean, 0.0) + rest_gradient * far);
    const double density = constants.density + max_real(excess, 0.0);
    position[i].w = density;
    velocity[i].w = pressure_term(density, constants);
}

/* Advance rows by a step: see integration/kernels.py:advance. */
__kernel void advance(
    int split, int count, double dt, double ahead, double furthest, Constants constants,
    __global double4 *position, __global double4 *velocity, __global const RATE4 *rates,
    __global double *previous, __global const double *reference, __global double4 *extremes)
{
    const int i = get_global_id(0);
    if (i >= count) return;
    double4 r = position[i], u = velocity[i];
    const RATE4 single = rates[i];
    const double4 rate = (double4)(single.x, single.y, single.z, single.w);
    const double density_rate = rate.w + ahead * (rate.w - previous[i]);
    previous[i] = rate.w;
    double density = r.w + dt * density_rate;
    if (i < split) {
        const double3 way = dt * (u.xyz + 0.5 * dt * rate.xyz);
        r.xyz += way;
        u.xyz += dt * rate.xyz;
        const double way2 = way.x * way.x + way.y * way.y + way.z * way.z;
        const double3 d = r.xyz - vload3(i, reference);
        extremes[i].z = d.x * d.x + d.y * d.y + d.z * d.z;
        extremes[i].w = failed(density, way2, furthest);
    } else {
        density = max_real(density, constants.density);
    }
    r.w = density;
    u.w = pressure_term(density, constants);
    position[i] = r;
    velocity[i] = u;
}
