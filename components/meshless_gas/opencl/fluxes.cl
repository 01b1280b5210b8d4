/* Rates of change by the fluxes between nodes; see kernels/residuals.py. */

#define STATES_OF(i) \
    {GATHERED(primitive, i, 0, 5, whole), GATHERED(primitive, i, 1, 5, whole), \
     OF_SPACE(GATHERED(primitive, i, 2, 5, whole)), GATHERED(primitive, i, 3, 5, whole), \
     GATHERED(primitive, i, 4, 5, whole)}
#define SLOPE(i, q) \
    2.0 * (GATHERED(gradients, i, 3 * q, 15, whole) * x \
        + OF_SPACE(GATHERED(gradients, i, 3 * q + 1, 15, whole) * y) \
        + GATHERED(gradients, i, 3 * q + 2, 15, whole) * z)
#define LIMITED(q, part, threshold) \
    half_steps(limiter, SLOPE(i, q), SLOPE(j, q), state_j.part - state_i.part, threshold)
#define SPLIT(part, changes) \
    do { \
        const PairOfLanes both = sides(state_i.part, state_j.part, keep, changes); \
        left.part = both.f0, right.part = both.f1; \
    } while (0)
#ifdef PLANAR
#define OF_SPACE(x) ((reals)0)
#else
#define OF_SPACE(x) (x)
#endif

__kernel void write_residuals(
    int count, int nodes, int whole, int width, __global const int *rows,
    __global const double *positions, __global const double *primitive,
    __global const double *gradients, __global const double *lowest,
    __global const int *neighbours, __global const double *coefficients, double gamma,
    Limiter limiter, __global double *residual OF_MOTION)
{
    const int begin = get_global_id(0) * LANES;
    if (begin >= count) return;
#define INNER_NODE(lane) rows[min(begin + lane, count - 1)]
    NODES_OF(i, INNER_NODE);
    States state_i = STATES_OF(i);
#ifdef MOVING
    const reals frame_x = GATHERED(frame, i, 0, 3, whole);
    const reals frame_y = GATHERED(frame, i, 1, 3, whole);
    const reals frame_z = GATHERED(frame, i, 2, 3, whole);
    state_i.f1 -= frame_x, state_i.f2 -= frame_y, state_i.f3 -= frame_z;
#endif
    const reals least_i = GATHERED(lowest, i, 0, 1, whole);
    States sum = {0, 0, 0, 0, 0};
    for (int k = 0; k < width; k++) {
#define NEIGHBOUR(lane) neighbours[AT(i##lane, k, width, whole)]
        NODES_OF(j, NEIGHBOUR);
        if (ARE_SAME(i, j)) continue; /* rows are padded with the node itself */
        States state_j = STATES_OF(j);
#ifdef MOVING
        state_j.f1 -= frame_x, state_j.f2 -= frame_y, state_j.f3 -= frame_z;
#endif
        const Directions direction = pair_direction(
            GATHERED(coefficients, i, 3 * k, 3 * width, whole),
            OF_SPACE(GATHERED(coefficients, i, 3 * k + 1, 3 * width, whole)),
            GATHERED(coefficients, i, 3 * k + 2, 3 * width, whole));
        const reals least_j = GATHERED(lowest, j, 0, 1, whole);
        States left = state_i, right = state_j;
#ifdef SLOPED
        const reals x = GATHERED(positions, j, 0, 3, whole) - GATHERED(positions, i, 0, 3, whole);
        const reals z = GATHERED(positions, j, 2, 3, whole) - GATHERED(positions, i, 2, 3, whole);
#ifndef PLANAR
        const reals y = GATHERED(positions, j, 1, 3, whole) - GATHERED(positions, i, 1, 3, whole);
#endif
        const Thresholds eps = thresholds(state_i, state_j, limiter);
        const PairOfLanes density = LIMITED(0, f0, eps.f0), pressure = LIMITED(4, f4, eps.f1);
        const reals share = kept_share(state_i, state_j, direction, least_i, least_j);
        const reals keep = positive_share(share, state_i, state_j, density, pressure);
        SPLIT(f0, density);
        SPLIT(f4, pressure);
        const PairOfLanes u = LIMITED(1, f1, eps.f2), w = LIMITED(3, f3, eps.f2);
        SPLIT(f1, u);
        SPLIT(f3, w);
#ifndef PLANAR
        const PairOfLanes v = LIMITED(2, f2, eps.f2);
        SPLIT(f2, v);
#endif
#endif
        const States rates =
            pair_rates(state_i, left, right, direction, min_reals(least_i, least_j), gamma);
        sum.f0 += rates.f0;
        sum.f1 += rates.f1;
        sum.f2 += rates.f2;
        sum.f3 += rates.f3;
        sum.f4 += rates.f4;
    }
#ifdef MOVING
    sum = in_laboratory(sum, frame_x, frame_y, frame_z);
#endif
    const int lanes = count - begin;
    SCATTERED(residual, i, 0, 5, nodes, sum.f0, lanes);
    SCATTERED(residual, i, 1, 5, nodes, sum.f1, lanes);
    SCATTERED(residual, i, 2, 5, nodes, sum.f2, lanes);
    SCATTERED(residual, i, 3, 5, nodes, sum.f3, lanes);
    SCATTERED(residual, i, 4, 5, nodes, sum.f4, lanes);
}
