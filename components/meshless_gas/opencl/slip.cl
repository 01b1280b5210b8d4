/* A rarefied gas along walls; see viscous/kernels/slip.py. Slip and jump lengths are 0 at no-slip
   walls. */

static Shares shares_of(
    int i, int j, int k, int whole, __global const double *positions, Vector normal)
{
    return slope_shares(
        height(i, j, whole, positions, normal), height(i, k, whole, positions, normal));
}

/* Temperature of the gas at walls, by way of its density; its pressure is kept. */
__kernel void write_jumps(
    int count, int whole, __global const int *rows, __global const int *above,
    __global const double *positions, __global const double *normals,
    __global const double *velocities, __global const double *temperatures,
    __global const double *lengths, double curvature, Transport law, __global double *primitive)
{
    const int n = get_global_id(0);
    if (n >= count || lengths[AT(n, 0, 2, count)] == 0.0) return;
    const int i = rows[n], j = above[AT(n, 0, 2, count)], k = above[AT(n, 1, 2, count)];
    const Vector normal = vector_at(normals, i, whole);
    const Pair reach = {lengths[AT(n, 0, 2, count)], lengths[AT(n, 1, 2, count)]};
    const double pressure = primitive[AT(i, 4, 5, whole)];
    const double warmth = temperature_at_wall(
        pressure, state_at(primitive, j, whole), state_at(primitive, k, whole),
        shares_of(i, j, k, whole, positions, normal), vector_at(velocities, n, count), normal,
        temperatures[n], reach, curvature, law);
    primitive[AT(i, 0, 5, whole)] = pressure / (law.gas_constant * warmth);
}

static double warmth_at(__global const double *primitive, int i, int whole, Transport law)
{
    return gas_temperature(
        primitive[AT(i, 0, 5, whole)], primitive[AT(i, 4, 5, whole)], law.gas_constant);
}

/* Velocity of the gas at walls, whose temperatures are known. Images get their states after walls:
   their owners' temperatures are read. */
__kernel void write_slips(
    int count, int nodes, int whole, int width, __global const int *rows,
    __global const int *above, __global const double *positions, __global const double *normals,
    __global const int *neighbours, __global const double *coefficients,
    __global const int *owner, __global const double *velocities,
    __global const double *lengths, double curvature, Transport law, __global double *primitive)
{
    const int n = get_global_id(0);
    if (n >= count || lengths[AT(n, 0, 2, count)] == 0.0) return;
    const int i = rows[n], j = above[AT(n, 0, 2, count)], k = above[AT(n, 1, 2, count)];
    const Vector normal = vector_at(normals, i, whole);
    const double warmth = warmth_at(primitive, i, whole, law);
    double3 slope = 0;
    for (int m = 0; m < width; m++) {
        int other = neighbours[AT(i, m, width, whole)];
        if (other >= nodes) other = owner[other - nodes];
        slope += coefficient_at(coefficients, i, m, width, whole)
            * (warmth_at(primitive, other, whole, law) - warmth);
    }
    const Vector rise = {slope.x, slope.y, slope.z};
    const Vector velocity = velocity_at_wall(
        state_at(primitive, i, whole), state_at(primitive, j, whole),
        state_at(primitive, k, whole), shares_of(i, j, k, whole, positions, normal),
        vector_at(velocities, n, count), normal, rise, lengths[AT(n, 0, 2, count)], curvature,
        law);
    primitive[AT(i, 1, 5, whole)] = velocity.f0;
    primitive[AT(i, 2, 5, whole)] = velocity.f1;
    primitive[AT(i, 3, 5, whole)] = velocity.f2;
}

/* Viscous stress on wall node i and heat flux into it. */
static Traction sliding_traction_at(
    int i, int j, int k, int whole, int width, __global const double *positions, Vector normal,
    Vector velocity, __global const int *neighbours, __global const double *coefficients,
    __global const double *primitive, double curvature, Transport law)
{
    const State state = state_at(primitive, i, whole);
    double spreading = 0;
    for (int m = 0; m < width; m++) {
        const State other = state_at(primitive, neighbours[AT(i, m, width, whole)], whole);
        const double3 c = coefficient_at(coefficients, i, m, width, whole);
        const Vector coefficient = {c.x, c.y, c.z};
        const Vector rise = {other.f1 - state.f1, other.f2 - state.f2, other.f3 - state.f3};
        spreading += spread(coefficient, rise, normal);
    }
    return slip_traction(
        state, state_at(primitive, j, whole), state_at(primitive, k, whole),
        shares_of(i, j, k, whole, positions, normal), velocity, normal, spreading, curvature, law);
}
