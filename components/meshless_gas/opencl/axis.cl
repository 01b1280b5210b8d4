/* What symmetry about an axis adds; see axis/kernels.py. */

__kernel void add_axis(
    int count, int nodes, int whole, __global const int *rows, __global const double *positions,
    __global const double *primitive, double gamma, __global double *residual)
{
    const int row = get_global_id(0);
    if (row >= count) return;
    const int i = rows[row];
    const State state = state_at(primitive, i, whole);
    const Rates rates = axis_rates(
        state.f0, state.f1, state.f3, state.f4, positions[AT(i, 2, 3, whole)], gamma);
    residual[AT(i, 0, 5, nodes)] -= rates.f0;
    residual[AT(i, 1, 5, nodes)] -= rates.f1;
    residual[AT(i, 3, 5, nodes)] -= rates.f2;
    residual[AT(i, 4, 5, nodes)] -= rates.f3;
}
