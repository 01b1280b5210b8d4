/* Friction and heat conduction, and walls that hold the gas; see viscous/kernels/flux.py and
   viscous/kernels/walls.py. */

#define SUM_OF_SQUARES(x, y, z) ((x) * (x) + (y) * (y) + (z) * (z))
#define LEAST_SQUARE 1e-300 /* m2, of an arm, so that a node does not divide by that to itself */

/* Temperature and viscosity of nodes and ghosts. */
__kernel void write_transport(
    int whole, __global const double *primitive, Transport law, __global double *transported)
{
    const int i = get_global_id(0);
    if (i >= whole) return;
    const double temperature = gas_temperature(
        primitive[AT(i, 0, 5, whole)], primitive[AT(i, 4, 5, whole)], law.gas_constant);
    transported[AT(i, 0, 2, whole)] = temperature;
    transported[AT(i, 1, 2, whole)] = sutherland(temperature, law);
}

/* Gradients of temperature at some nodes, by least squares. */
__kernel void write_temperature_slopes(
    int count, int whole, int width, __global const int *rows, __global const int *neighbours,
    __global const double *coefficients, __global const double *transported,
    __global double *slopes)
{
    const int n = get_global_id(0);
    if (n >= count) return;
    const int i = rows[n];
    const double temperature = transported[AT(i, 0, 2, whole)];
    double3 slope = 0;
    for (int k = 0; k < width; k++) {
        const int j = neighbours[AT(i, k, width, whole)];
        slope += coefficient_at(coefficients, i, k, width, whole)
            * (transported[AT(j, 0, 2, whole)] - temperature);
    }
    slopes[AT(i, 0, 3, whole)] = slope.x;
    slopes[AT(i, 1, 3, whole)] = slope.y;
    slopes[AT(i, 2, 3, whole)] = slope.z;
}

/* Turn these to the ghosts of their nodes. */
__kernel void write_ghost_slopes(
    int nodes, int whole, __global const int *owner, __global const double *turn,
    __global double *slopes)
{
    const int g = get_global_id(0), i = nodes + g;
    if (i >= whole) return;
    const Vector slope_of_owner = vector_at(slopes, owner[g], whole);
    const double3 slope = turned(
        turn, g, (double3)(slope_of_owner.f0, slope_of_owner.f1, slope_of_owner.f2));
    slopes[AT(i, 0, 3, whole)] = slope.x;
    slopes[AT(i, 1, 3, whole)] = slope.y;
    slopes[AT(i, 2, 3, whole)] = slope.z;
}

#define VECTORS_OF(table, i, q, width) \
    {GATHERED(table, i, q, width, whole), GATHERED(table, i, q + 1, width, whole), \
     GATHERED(table, i, q + 2, width, whole)}
#define GRADIENTS_OF(i) \
    {VECTORS_OF(gradients, i, 0, 15), VECTORS_OF(gradients, i, 3, 15), \
     VECTORS_OF(gradients, i, 6, 15), VECTORS_OF(gradients, i, 9, 15), \
     VECTORS_OF(gradients, i, 12, 15)}

/* Add rates of momentum and energy by friction and conduction. */
__kernel void add_friction(
    int count, int nodes, int whole, int width, __global const int *rows,
    __global const double *positions, __global const double *primitive,
    __global const double *transported, __global const double *gradients,
    __global const double *slopes, __global const int *neighbours,
    __global const double *coefficients, Transport law, __global double *residual)
{
    const int begin = get_global_id(0) * LANES;
    if (begin >= count) return;
    NODES_OF(i, INNER_NODE);
    const Vectors velocity_i = VECTORS_OF(primitive, i, 1, 5), t = VECTORS_OF(slopes, i, 0, 3);
    const Gradients g = GRADIENTS_OF(i);
    const reals temperature = GATHERED(transported, i, 0, 2, whole);
    const reals mu = GATHERED(transported, i, 1, 2, whole);
    Vectors along = {0, 0, 0};
    Directions sum = {0, 0, 0, 0};
    for (int k = 0; k < width; k++) {
        NODES_OF(j, NEIGHBOUR);
        if (ARE_SAME(i, j)) continue;
        const Vectors velocity_j = VECTORS_OF(primitive, j, 1, 5), s = VECTORS_OF(slopes, j, 0, 3);
        const Gradients h = GRADIENTS_OF(j);
        const Vectors c = VECTORS_OF(coefficients, i, 3 * k, 3 * width);
        const Vectors r = {
            GATHERED(positions, j, 0, 3, whole) - GATHERED(positions, i, 0, 3, whole),
            GATHERED(positions, j, 1, 3, whole) - GATHERED(positions, i, 1, 3, whole),
            GATHERED(positions, j, 2, 3, whole) - GATHERED(positions, i, 2, 3, whole)};
        const reals square = SUM_OF_SQUARES(r.f0, r.f1, r.f2);
        const reals inverse = 1.0 / max_reals(square, (reals)LEAST_SQUARE);
        const reals rise = GATHERED(transported, j, 0, 2, whole) - temperature;
        const reals mean = 0.5 * (mu + GATHERED(transported, j, 1, 2, whole));
        const Directions transfer =
            pair_transfer(velocity_i, velocity_j, g, h, t, s, rise, r, inverse, c, mean, law);
        sum.f0 += transfer.f0, sum.f1 += transfer.f1;
        sum.f2 += transfer.f2, sum.f3 += transfer.f3;
        along.f0 += c.f0, along.f1 += c.f1, along.f2 += c.f2;
    }
    const Directions less = own_transfer(velocity_i, g, t, along, mu, law);
    const reals x = GATHERED(residual, i, 1, 5, nodes) + 2.0 * (sum.f0 - less.f0);
    const reals y = GATHERED(residual, i, 2, 5, nodes) + 2.0 * (sum.f1 - less.f1);
    const reals z = GATHERED(residual, i, 3, 5, nodes) + 2.0 * (sum.f2 - less.f2);
    const reals energy = GATHERED(residual, i, 4, 5, nodes) + 2.0 * (sum.f3 - less.f3);
    const int lanes = count - begin;
    SCATTERED(residual, i, 1, 5, nodes, x, lanes);
    SCATTERED(residual, i, 2, 5, nodes, y, lanes);
    SCATTERED(residual, i, 3, 5, nodes, z, lanes);
    SCATTERED(residual, i, 4, 5, nodes, energy, lanes);
}

/* Shorten the stable step of each node by what diffusion adds; the least of each group. */
__kernel void shorten_bounds(
    int count, int whole, int width, __global const int *rows, __global const double *positions,
    __global const double *primitive, __global const double *transported,
    __global const int *neighbours, __global const double *coefficients, double gamma,
    Transport law, __global double *bounds, int first, __global double *parts)
{
    const int row = get_global_id(0), item = get_local_id(0);
    __local double least[GROUP];
    least[item] = INFINITY;
    if (row < count) {
        const int i = rows[row];
        const Vector at = vector_at(positions, i, whole);
        double total = 0;
        for (int k = 0; k < width; k++) {
            const int j = neighbours[AT(i, k, width, whole)];
            const Vector there = vector_at(positions, j, whole);
            const double3 c = coefficient_at(coefficients, i, k, width, whole);
            const double square =
                SUM_OF_SQUARES(there.f0 - at.f0, there.f1 - at.f1, there.f2 - at.f2);
            if (square > 0.0) total += sqrt(SUM_OF_SQUARES(c.x, c.y, c.z) / square);
        }
        const double rate = diffusion_rate(
            total, primitive[AT(i, 0, 5, whole)], transported[AT(i, 1, 2, whole)], gamma, law);
        bounds[i] = least[item] = 1.0 / (1.0 / bounds[i] + rate);
    }
    least_in_group(least);
    if (item == 0) parts[first + get_group_id(0)] = least[0];
}

/* States of no-slip walls: their velocity and temperature, the gas's pressure. */
__kernel void write_no_slip_walls(
    int count, int whole, int width, __global const int *rows, __global const int *neighbours,
    __global const double *weights, __global const double *normals,
    __global const double *velocities, __global const double *temperatures, double gamma,
    Transport law, __global double *primitive)
{
    const int n = get_global_id(0);
    if (n >= count) return;
    const int i = rows[n];
    const Vector normal = vector_at(normals, i, whole), velocity = vector_at(velocities, n, count);
    double pressure = 0, warmth = 0, into = 0;
    for (int k = 0; k < width; k++) {
        const double share = weights[AT(n, k, width, count)];
        if (share == 0.0) continue;
        const State gas = state_at(primitive, neighbours[AT(i, k, width, whole)], whole);
        pressure += share * gas.f4;
        warmth += share * gas_temperature(gas.f0, gas.f4, law.gas_constant);
        into -= share * (gas.f1 - velocity.f0) * normal.f0;
        into -= share * (gas.f2 - velocity.f1) * normal.f1;
        into -= share * (gas.f3 - velocity.f2) * normal.f2;
    }
    const State state = wall_state(pressure, warmth, into, velocity, temperatures[n], gamma, law);
    store_state(state, primitive, i, whole);
}
