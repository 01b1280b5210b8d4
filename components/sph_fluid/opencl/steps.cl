/* Steps of rows in double precision; laws and structs are printed. */

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
