/* Gradients by least squares, and ghosts; see kernels/gradients.py and kernels/ghosts.py. */

static double3 coefficient_at(
    __global const double *coefficients, int i, int k, int width, int whole)
{
    return (double3)(
        coefficients[AT(i, 3 * k, 3 * width, whole)],
        coefficients[AT(i, 3 * k + 1, 3 * width, whole)],
        coefficients[AT(i, 3 * k + 2, 3 * width, whole)]);
}

static void store_gradient(double3 slope, int q, __global double *gradients, int i, int whole)
{
    gradients[AT(i, 3 * q, 15, whole)] = slope.x;
    gradients[AT(i, 3 * q + 1, 15, whole)] = slope.y;
    gradients[AT(i, 3 * q + 2, 15, whole)] = slope.z;
}

/* Gradients of density, velocity and pressure at some nodes, and the least pressure of a node and
   those near. */
__kernel void write_gradients(
    int count, int whole, int width, __global const int *rows, __global const double *primitive,
    __global const int *neighbours, __global const double *coefficients,
    __global double *gradients, __global double *lowest)
{
    const int n = get_global_id(0);
    if (n >= count) return;
    const int i = rows[n];
    const State state = state_at(primitive, i, whole);
    double3 r = 0, u = 0, v = 0, w = 0, p = 0;
    double least = state.f4;
    for (int k = 0; k < width; k++) {
        const State other = state_at(primitive, neighbours[AT(i, k, width, whole)], whole);
        const double3 c = coefficient_at(coefficients, i, k, width, whole);
        r += c * (other.f0 - state.f0);
        u += c * (other.f1 - state.f1);
        v += c * (other.f2 - state.f2);
        w += c * (other.f3 - state.f3);
        p += c * (other.f4 - state.f4);
        least = min_real(least, other.f4);
    }
    store_gradient(r, 0, gradients, i, whole);
    store_gradient(u, 1, gradients, i, whole);
    store_gradient(v, 2, gradients, i, whole);
    store_gradient(w, 3, gradients, i, whole);
    store_gradient(p, 4, gradients, i, whole);
    lowest[i] = least;
}

static double3 turned(__global const double *turn, int g, double3 along)
{
    const double3 x = vload3(3 * g, turn), y = vload3(3 * g + 1, turn), z = vload3(3 * g + 2, turn);
    return (double3)(
        x.x * along.x + x.y * along.y + x.z * along.z,
        y.x * along.x + y.y * along.y + y.z * along.z,
        z.x * along.x + z.y * along.y + z.z * along.z);
}

/* States of ghosts: scalars of the owner, its velocity turned. */
__kernel void write_ghosts(
    int nodes, int whole, __global const int *owner, __global const double *turn,
    __global double *primitive)
{
    const int g = get_global_id(0), i = nodes + g;
    if (i >= whole) return;
    State state = state_at(primitive, owner[g], whole);
    const double3 u = turned(turn, g, (double3)(state.f1, state.f2, state.f3));
    state.f1 = u.x, state.f2 = u.y, state.f3 = u.z;
    store_state(state, primitive, i, whole);
}

/* Gradients of ghosts: T g of scalars, T G T^T of the velocity. */
__kernel void write_ghost_gradients(
    int nodes, int whole, __global const int *owner, __global const double *turn,
    __global double *gradients, __global double *lowest)
{
    const int g = get_global_id(0), i = nodes + g;
    if (i >= whole) return;
    const int o = owner[g];
    lowest[i] = lowest[o];
    double3 slopes[5];
    for (int q = 0; q < 5; q++)
        slopes[q] = turned(
            turn, g,
            (double3)(
                gradients[AT(o, 3 * q, 15, whole)], gradients[AT(o, 3 * q + 1, 15, whole)],
                gradients[AT(o, 3 * q + 2, 15, whole)]));
    const double3 x = turned(turn, g, (double3)(slopes[1].x, slopes[2].x, slopes[3].x));
    const double3 y = turned(turn, g, (double3)(slopes[1].y, slopes[2].y, slopes[3].y));
    const double3 z = turned(turn, g, (double3)(slopes[1].z, slopes[2].z, slopes[3].z));
    store_gradient(slopes[0], 0, gradients, i, whole);
    store_gradient((double3)(x.x, y.x, z.x), 1, gradients, i, whole);
    store_gradient((double3)(x.y, y.y, z.y), 2, gradients, i, whole);
    store_gradient((double3)(x.z, y.z, z.z), 3, gradients, i, whole);
    store_gradient(slopes[4], 4, gradients, i, whole);
}
