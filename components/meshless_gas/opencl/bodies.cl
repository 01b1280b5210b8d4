/* Clouds that go with bodies, and the bodies' walls; see moving/clouds.py and
   moving/kernels/walls.py. `centres` and `velocities` have a row for each body. */

__kernel void place_carried(
    int first, int count, int whole, __global const int *carrier, __global const double *offsets,
    __global const double *centres, __global double *positions)
{
    const int n = get_global_id(0);
    if (n >= count) return;
    for (int d = 0; d < 3; d++)
        positions[AT(first + n, d, 3, whole)] =
            offsets[AT(n, d, 3, count)] + centres[3 * carrier[n] + d];
}

/* Places of images beyond the axis. */
__kernel void place_images(
    int count, int whole, __global const int *images, __global const int *imaged,
    __global double *positions)
{
    const int n = get_global_id(0);
    if (n >= count) return;
    const int i = images[n], j = imaged[n];
    positions[AT(i, 0, 3, whole)] = positions[AT(j, 0, 3, whole)];
    positions[AT(i, 1, 3, whole)] = positions[AT(j, 1, 3, whole)];
    positions[AT(i, 2, 3, whole)] = -positions[AT(j, 2, 3, whole)];
}

/* Velocities of nodes are those of their bodies. */
__kernel void set_frame(
    int first, int count, int whole, __global const int *carrier,
    __global const double *velocities, __global double *frame)
{
    const int n = get_global_id(0);
    if (n >= count) return;
    for (int d = 0; d < 3; d++)
        frame[AT(first + n, d, 3, whole)] = velocities[3 * carrier[n] + d];
}

/* Gradients of nodes across overlaps, where the scheme is of first order. */
__kernel void clear_gradients(
    int count, int whole, __global const int *rows, __global double *gradients)
{
    const int row = get_global_id(0);
    if (row >= count) return;
    for (int q = 0; q < 15; q++) gradients[AT(rows[row], q, 15, whole)] = 0.0;
}

/* Nodes where gas leaves a cloud have the state of those beside them. */
__kernel void copy_states(
    int count, int whole, __global const int *rows, __global const int *before,
    __global double *primitive)
{
    const int row = get_global_id(0);
    if (row >= count) return;
    store_state(state_at(primitive, before[row], whole), primitive, rows[row], whole);
}

__kernel void write_slip_walls(
    int count, int whole, __global const int *rows, __global const int *above,
    __global const double *heights, __global const double *normals,
    __global const double *velocities, double gamma, __global double *primitive)
{
    const int n = get_global_id(0);
    if (n >= count) return;
    const State first = state_at(primitive, above[AT(n, 0, 2, count)], whole);
    const State second = state_at(primitive, above[AT(n, 1, 2, count)], whole);
    const State state = slip_wall_state(
        first, second, heights[AT(n, 0, 2, count)], heights[AT(n, 1, 2, count)],
        vector_at(normals, rows[n], whole), vector_at(velocities, n, count), gamma);
    store_state(state, primitive, rows[n], whole);
}
