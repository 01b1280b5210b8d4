/* Stages of a step, stable steps and changes; see kernels/motion.py. */

/* Advance by a stage; after one that failed the states stay as they are. `wrong` has for each stage
   the last row whose density or pressure is not positive and finite, or -1. `shortest` is the
   shortest stable step if nodes have local steps, else 0. */
__kernel void advance(
    int count, int nodes, int whole, int stage, double step, double shortest, double old,
    double new, double gamma, __global const int *rows, __global const double *bounds,
    __global const double *residual, __global double *start, __global double *conservative,
    __global double *primitive, __global int *wrong)
{
    const int row = get_global_id(0);
    if (row >= count) return;
    for (int s = 0; s < stage; s++)
        if (wrong[s] >= 0) return;
    const int i = rows[row];
    const double dt = shortest > 0.0 ? step * (bounds[i] / shortest) : step;
    if (stage == 0)
        for (int q = 0; q < 5; q++)
            start[AT(i, q, 5, nodes)] = conservative[AT(i, q, 5, nodes)];
    const State from = state_at(start, i, nodes), now = state_at(conservative, i, nodes);
    const State rate = state_at(residual, i, nodes);
    const State conserved = {
        staged(from.f0, now.f0, rate.f0, dt, old, new),
        staged(from.f1, now.f1, rate.f1, dt, old, new),
        staged(from.f2, now.f2, rate.f2, dt, old, new),
        staged(from.f3, now.f3, rate.f3, dt, old, new),
        staged(from.f4, now.f4, rate.f4, dt, old, new)};
    const State state = primitive_state(
        conserved.f0, conserved.f1, conserved.f2, conserved.f3, conserved.f4, gamma);
    store_state(conserved, conservative, i, nodes);
    store_state(state, primitive, i, whole);
    if (!is_state(state.f0, state.f4)) atomic_max(&wrong[stage], row);
}

/* Add rates, word by word. */
__kernel void add_rates(
    int words, __global const double *rates, __global double *residual)
{
    const int word = get_global_id(0);
    if (word < words) residual[word] += rates[word];
}

__kernel void write_sound(
    int whole, __global const double *primitive, double gamma, __global double *sound)
{
    const int i = get_global_id(0);
    if (i >= whole) return;
    sound[i] = sound_speed(
        primitive[AT(i, 0, 5, whole)], primitive[AT(i, 4, 5, whole)], gamma);
}

/* Stable steps of nodes, and the least of each group. */
__kernel void write_bounds(
    int count, int whole, int width, __global const int *rows, __global const double *primitive,
    __global const double *sound, __global const int *neighbours,
    __global const double *coefficients, __global double *bounds, int first,
    __global double *parts OF_MOTION)
{
    const int row = get_global_id(0), item = get_local_id(0);
    __local double least[GROUP];
    least[item] = INFINITY;
    if (row < count) {
        const int i = rows[row];
        const State a = state_at(primitive, i, whole);
        const Vector frame_i = FRAME_OF(i);
        const Vector velocity_i = {a.f1 - frame_i.f0, a.f2 - frame_i.f1, a.f3 - frame_i.f2};
        double summed = 0;
        for (int k = 0; k < width; k++) {
            const int j = neighbours[AT(i, k, width, whole)];
            const Vector velocity_j = {
                primitive[AT(j, 1, 5, whole)] - frame_i.f0,
                primitive[AT(j, 2, 5, whole)] - frame_i.f1,
                primitive[AT(j, 3, 5, whole)] - frame_i.f2};
            const double3 c = coefficient_at(coefficients, i, k, width, whole);
            const Vector coefficient = {c.x, c.y, c.z};
            summed += crossing_rate(velocity_i, velocity_j, coefficient, sound[i], sound[j]);
        }
        bounds[i] = least[item] = 1.0 / summed;
    }
    least_in_group(least);
    if (item == 0) parts[first + get_group_id(0)] = least[0];
}

/* Squares of relative changes of densities in the stable steps of nodes, a sum for each group. */
__kernel void sum_changes(
    int count, int nodes, __global const int *rows, __global const double *residual,
    __global const double *bounds, __global const double *conservative, int first,
    __global double *parts)
{
    const int row = get_global_id(0), item = get_local_id(0);
    __local double squares[GROUP];
    squares[item] = 0;
    if (row < count) {
        const int i = rows[row];
        squares[item] = change_square(
            residual[AT(i, 0, 5, nodes)], bounds[i], conservative[AT(i, 0, 5, nodes)]);
    }
    add_in_group(squares);
    if (item == 0) parts[first + get_group_id(0)] = squares[0];
}
