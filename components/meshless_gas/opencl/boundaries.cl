/* States of boundary nodes; see kernels/boundaries.py, kernels/outflows.py, kernels/symmetry.py.
   Each is made of states of nodes within alone. */

__kernel void write_boundaries(
    int count, int whole, int width, __global const int *rows, __global const int *kind,
    __global const int *patch, __global const double *normals, __global const int *neighbours,
    __global const double *weights, __global const double *patches, double gamma,
    double gas_constant, __global double *primitive)
{
    const int row = get_global_id(0);
    if (row >= count) return;
    const int i = rows[row];
    State near = {0, 0, 0, 0, 0};
    for (int k = 0; k < width; k++) {
        const double weight = weights[AT(row, k, width, count)];
        if (weight > 0.0) {
            const State other = state_at(primitive, neighbours[AT(i, k, width, whole)], whole);
            near.f0 += weight * other.f0;
            near.f1 += weight * other.f1;
            near.f2 += weight * other.f2;
            near.f3 += weight * other.f3;
            near.f4 += weight * other.f4;
        }
    }
    __global const double *table = patches + 8 * patch[i];
    const Patch outer = {
        table[0], table[1], table[2], table[3], table[4], table[5], table[6], table[7]};
    const Vector velocity = {0, 0, 0}, normal = vector_at(normals, i, whole);
    const State state =
        boundary_state(kind[i], near, outer, normal, velocity, gamma, gas_constant);
    store_state(state, primitive, i, whole);
}

/* What the plane through nodes near has more than outflow node i, the least and most of these. */
static void fit_plane(
    int i, int row, int count, int whole, int many, __global const int *near,
    __global const double *weights, __global const double *primitive, State *more, State *low,
    State *high)
{
    for (int k = 0; k < many; k++) {
        const int j = near[AT(row, k, many, count)];
        if (j == i) continue;
        const State other = state_at(primitive, j, whole);
        const double weight = weights[AT(row, k, 4 * many, count)];
        more->f0 += weight * other.f0;
        more->f1 += weight * other.f1;
        more->f2 += weight * other.f2;
        more->f3 += weight * other.f3;
        more->f4 += weight * other.f4;
        low->f0 = min_real(low->f0, other.f0), high->f0 = max_real(high->f0, other.f0);
        low->f1 = min_real(low->f1, other.f1), high->f1 = max_real(high->f1, other.f1);
        low->f2 = min_real(low->f2, other.f2), high->f2 = max_real(high->f2, other.f2);
        low->f3 = min_real(low->f3, other.f3), high->f3 = max_real(high->f3, other.f3);
        low->f4 = min_real(low->f4, other.f4), high->f4 = max_real(high->f4, other.f4);
    }
}

/* Roughness of the pressures that the plane at outflow node i goes through. */
static double roughness_near(
    int i, int row, int count, int whole, int many, __global const int *near,
    __global const double *weights, __global const double *positions,
    __global const double *primitive)
{
    double value = 0, low = INFINITY, high = -INFINITY, missed = 0;
    double3 slope = 0;
    for (int k = 0; k < many; k++) {
        const int j = near[AT(row, k, many, count)];
        const double p = primitive[AT(j, 4, 5, whole)];
        value += weights[AT(row, k, 4 * many, count)] * p;
        slope.x += weights[AT(row, many + k, 4 * many, count)] * p;
        slope.y += weights[AT(row, 2 * many + k, 4 * many, count)] * p;
        slope.z += weights[AT(row, 3 * many + k, 4 * many, count)] * p;
        if (j != i) low = min_real(low, p), high = max_real(high, p);
    }
    const Vector at = vector_at(positions, i, whole);
    long others = 0;
    for (int k = 0; k < many; k++) {
        const int j = near[AT(row, k, many, count)];
        if (j == i) continue;
        const Vector there = vector_at(positions, j, whole);
        double off = primitive[AT(j, 4, 5, whole)] - value;
        off -= slope.x * (there.f0 - at.f0);
        off -= slope.y * (there.f1 - at.f1);
        off -= slope.z * (there.f2 - at.f2);
        missed += off * off;
        others++;
    }
    return roughness(missed, others, low, high);
}

__kernel void continue_outflows(
    int count, int whole, int many, __global const int *rows, __global const int *near,
    __global const double *weights, __global const double *positions, __global const int *patch,
    __global const double *patches, __global const double *normals, double gamma,
    __global double *primitive)
{
    const int row = get_global_id(0);
    if (row >= count) return;
    const int i = rows[row];
    const State state = state_at(primitive, i, whole);
    const Vector normal = vector_at(normals, i, whole);
    const double sound = sound_speed(state.f0, state.f4, gamma);
    const double out = outward_speed(state, normal);
    if (patches[8 * patch[i] + BACK_PRESSURE] > 0.0 && fabs(out) < sound) return;
    State more = {-state.f0, -state.f1, -state.f2, -state.f3, -state.f4};
    State low = {INFINITY, INFINITY, INFINITY, INFINITY, INFINITY};
    State high = {-INFINITY, -INFINITY, -INFINITY, -INFINITY, -INFINITY};
    fit_plane(i, row, count, whole, many, near, weights, primitive, &more, &low, &high);
    const double rough =
        roughness_near(i, row, count, whole, many, near, weights, positions, primitive);
    const State beyond = continued(state, out, sound, normal, more, low, high, rough);
    store_state(beyond, primitive, i, whole);
}

/* Take the velocity through walls of symmetry from nodes on them, unless the stage failed. */
__kernel void hold_along_walls(
    int count, int nodes, int whole, int stage, __global const int *rows,
    __global const double *normals, __global const int *wrong, __global double *conservative,
    __global double *primitive)
{
    const int row = get_global_id(0);
    if (row >= count) return;
    for (int s = 0; s <= stage; s++)
        if (wrong[s] >= 0) return;
    const int i = rows[row];
    const TwoStates held = held_along(
        state_at(primitive, i, whole), state_at(conservative, i, nodes),
        vector_at(normals, i, whole));
    store_state(held.f0, primitive, i, whole);
    store_state(held.f1, conservative, i, nodes);
}

/* What enters through boundary nodes per second, a sum for each group. */
__kernel void sum_flows(
    int count, int whole, __global const int *rows, __global const double *areas,
    __global const double *primitive, double gamma, int first, __global double *parts)
{
    const int row = get_global_id(0), item = get_local_id(0);
    __local double mass[GROUP], x[GROUP], y[GROUP], z[GROUP], energy[GROUP];
    State flow = {0, 0, 0, 0, 0};
    if (row < count) {
        const int i = rows[row];
        flow = boundary_flow(state_at(primitive, i, whole), vector_at(areas, i, whole), gamma);
    }
    mass[item] = flow.f0, x[item] = flow.f1, y[item] = flow.f2, z[item] = flow.f3;
    energy[item] = flow.f4;
    add_in_group(mass);
    add_in_group(x);
    add_in_group(y);
    add_in_group(z);
    add_in_group(energy);
    if (item) return;
    __global double *to = parts + first + 5 * get_group_id(0);
    to[0] = mass[0], to[1] = x[0], to[2] = y[0], to[3] = z[0], to[4] = energy[0];
}
