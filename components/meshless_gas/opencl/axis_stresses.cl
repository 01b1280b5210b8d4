/* Viscous stresses and heat about an axis of symmetry; see axis/kernels.py. */

__kernel void write_swelling(
    int whole, __global const double *positions, __global const double *primitive,
    __global const double *transported, __global double *swelling)
{
    const int i = get_global_id(0);
    if (i >= whole) return;
    swelling[i] = swelling_stress(
        primitive[AT(i, 3, 5, whole)], transported[AT(i, 1, 2, whole)],
        positions[AT(i, 2, 3, whole)]);
}

__kernel void add_axis_stresses(
    int count, int nodes, int whole, int width, __global const int *rows,
    __global const double *positions, __global const double *primitive,
    __global const double *transported, __global const double *swelling,
    __global const int *neighbours, __global const double *coefficients,
    __global const double *gradients, __global const double *slopes, double conduction,
    __global double *residual)
{
    const int row = get_global_id(0);
    if (row >= count) return;
    const int i = rows[row];
    const double u = primitive[AT(i, 1, 5, whole)], w = primitive[AT(i, 3, 5, whole)];
    const double mu = transported[AT(i, 1, 2, whole)], s = swelling[i];
    double along = 0, across = 0, power = 0;
    for (int k = 0; k < width; k++) {
        const int j = neighbours[AT(i, k, width, whole)];
        const double3 c = coefficient_at(coefficients, i, k, width, whole);
        along += c.x * (swelling[j] - s);
        across += c.z * (swelling[j] - s);
        power += c.x * (swelling[j] * primitive[AT(j, 1, 5, whole)] - s * u);
        power += c.z * (swelling[j] * primitive[AT(j, 3, 5, whole)] - s * w);
    }
    const Slopes du = {gradients[AT(i, 3, 15, whole)], gradients[AT(i, 5, 15, whole)]};
    const Slopes dw = {gradients[AT(i, 9, 15, whole)], gradients[AT(i, 11, 15, whole)]};
    const double heat = conduction * mu * slopes[AT(i, 2, 3, whole)];
    const Vector more = axis_stresses(
        along, across, power, u, w, positions[AT(i, 2, 3, whole)], mu, s, du, dw, heat);
    residual[AT(i, 1, 5, nodes)] += more.f0;
    residual[AT(i, 3, 5, nodes)] += more.f1;
    residual[AT(i, 4, 5, nodes)] += more.f2;
}
