/* Where the q-th number of node i stands in a table of `width` numbers for each of `count` nodes:
   by rows, as processors read them, or by columns, so that work items side by side read words that
   are side by side. `State` and the like are structs of printed laws. */

#if BY_ROWS
#define AT(i, q, width, count) ((size_t)(i) * (width) + (q))
#else
#define AT(i, q, width, count) ((size_t)(q) * (count) + (i))
#endif

static State state_at(__global const double *table, int i, int count)
{
    const State state = {
        table[AT(i, 0, 5, count)], table[AT(i, 1, 5, count)], table[AT(i, 2, 5, count)],
        table[AT(i, 3, 5, count)], table[AT(i, 4, 5, count)]};
    return state;
}

static void store_state(State state, __global double *table, int i, int count)
{
    table[AT(i, 0, 5, count)] = state.f0;
    table[AT(i, 1, 5, count)] = state.f1;
    table[AT(i, 2, 5, count)] = state.f2;
    table[AT(i, 3, 5, count)] = state.f3;
    table[AT(i, 4, 5, count)] = state.f4;
}

static Vector vector_at(__global const double *table, int i, int count)
{
    const Vector vector = {
        table[AT(i, 0, 3, count)], table[AT(i, 1, 3, count)], table[AT(i, 2, 3, count)]};
    return vector;
}

/* Velocities of nodes, where some move: a last argument of kernels, and that of a node. */
#ifdef MOVING
#define OF_MOTION , __global const double *frame
#define FRAME_OF(i) vector_at(frame, i, whole)
#else
#define OF_MOTION
#define FRAME_OF(i) {0, 0, 0}
#endif

/* What a rarefied gas needs at walls: last arguments of a kernel. */
#ifdef RAREFIED
#define OF_SLIDING \
    , int width, __global const int *neighbours, __global const double *coefficients, \
        __global const double *lengths, double curvature
#else
#define OF_SLIDING
#endif

/* Sums, or least numbers, of a group of work items, always in the same order. */
static void add_in_group(__local double *values)
{
    const int item = get_local_id(0);
    for (int other = GROUP / 2; other > 0; other >>= 1) {
        barrier(CLK_LOCAL_MEM_FENCE);
        if (item < other) values[item] += values[item + other];
    }
}

static void least_in_group(__local double *values)
{
    const int item = get_local_id(0);
    for (int other = GROUP / 2; other > 0; other >>= 1) {
        barrier(CLK_LOCAL_MEM_FENCE);
        if (item < other) values[item] = min_real(values[item], values[item + other]);
    }
}
