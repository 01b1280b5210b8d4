/* The material of each particle over a step; laws and structs are printed. */

static tuple_6r six_of(__global const double *array, int i)
{
    const double3 a = vload3(2 * i, array), b = vload3(2 * i + 1, array);
    const tuple_6r six = {a.x, a.y, a.z, b.x, b.y, b.z};
    return six;
}

static tuple_9r nine_of(__global const double *array, int i)
{
    const double3 a = vload3(3 * i, array), b = vload3(3 * i + 1, array),
                  c = vload3(3 * i + 2, array);
    const tuple_9r nine = {a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z};
    return nine;
}

/* Temperature of a material with an equation of state, from its table of the isentrope. */
static double shocked_temperature(
    Point point, __global const double2 *table, int rows, Solid law)
{
    const double mu = stretch_of_heat(point.density_ratio, point.failed);
    const InTable at = place_in_table(mu, rows, law);
    const double2 a = table[at.f1], b = table[at.f1 + 1];
    const tuple_2r low = {a.x, a.y}, high = {b.x, b.y};
    return temperature_between(mu, point.energy, at.f0 - at.f1, low, high, law);
}

/* Advance stress and energy by a step, and write the rows of stress that pairs take. Then bring
   places to the step's end, with velocities as the last acceleration predicts them. */
__kernel void advance(
    int count, double dt, __global const Solid *laws, __global const double2 *tables,
    __global const int *table_start, __global const long *material,
    __global const double *gradients, __global const double *corrections,
    __global const double *heating, __global double *deviator, __global double *density_ratio,
    __global double *pressure, __global double *energy, __global double *strain,
    __global double *temperature, __global double *damage, __global double *failed,
    __global double *sound, __global double *position, __global const double *velocity,
    __global const double *acceleration, __global double4 *place, __global double4 *motion,
    __global double4 *stress)
{
    const int i = get_global_id(0);
    if (i >= count) return;
    const int kind = material[i], first = table_start[kind];
    const Solid law = laws[kind];
    const tuple_9r m = nine_of(gradients, i);
    const double eta = density_ratio[i], trace = trace_of(m);
#ifdef REFERENCE
    const tuple_2r scales = corrected_scales(eta, trace, dt);
#elif defined(CORRECTED)
    const tuple_6r b = six_of(corrections, i);
    const tuple_2r scales = b.f0 != 0 ? corrected_scales(eta, trace, dt)
                                      : plain_scales(eta, trace, dt);
#else
    const tuple_2r scales = plain_scales(eta, trace, dt);
#endif
    const Rates rate = rates(m, scales, trace, dt);
    const Point before = {
        six_of(deviator, i), eta, pressure[i], energy[i], strain[i], temperature[i], damage[i],
        failed[i]};
    const Point after = advanced(before, rate, heating[i], dt, law);
    const tuple_6r s = after.deviator;
    vstore3((double3)(s.f0, s.f1, s.f2), 2 * i, deviator);
    vstore3((double3)(s.f3, s.f4, s.f5), 2 * i + 1, deviator);
    density_ratio[i] = after.density_ratio;
    pressure[i] = after.pressure;
    energy[i] = after.energy;
    strain[i] = after.strain;
    damage[i] = after.damage;
    failed[i] = after.failed;
    const int rows = table_start[kind + 1] - first;
    temperature[i] =
        law.shocks ? shocked_temperature(after, tables + first, rows, law) : after.temperature;
    const double c = sound_speed(after, law), now = after.density_ratio;
    sound[i] = c;
    const tuple_6r t = divided_stress(s, after.pressure, now);
#ifdef CORRECTED
    const tuple_9r n = corrected_stress(t, now, b);
    stress[3 * i] = (double4)(n.f0, n.f1, n.f2, n.f3);
    stress[3 * i + 1] = (double4)(n.f4, n.f5, n.f6, n.f7);
    stress[3 * i + 2] = (double4)(n.f8, law.density * now, law.density, 0);
#else
    stress[WIDTH * i] = (double4)(t.f0, t.f1, t.f2, t.f3);
    stress[WIDTH * i + 1] = (double4)(t.f4, t.f5, law.density * now, law.density);
#ifdef ARTIFICIAL
    const tuple_6r p = artificial_stress(t, ARTIFICIAL);
    stress[WIDTH * i + 2] = (double4)(p.f0, p.f1, p.f2, p.f3);
    stress[WIDTH * i + 3] = (double4)(p.f4, p.f5, 0, 0);
#endif
#endif
    const double3 u = vload3(i, velocity), at = vload3(i, position) + dt * u;
    vstore3(at, i, position);
    place[i].xyz = at;
    motion[i] = (double4)(u + 0.5 * dt * vload3(i, acceleration), c);
}
