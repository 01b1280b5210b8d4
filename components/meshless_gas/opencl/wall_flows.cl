/* Momentum and energy that enter by friction and conduction at walls, a sum for each group. A
   rarefied gas slides along walls whose length of slip is not 0. */
__kernel void sum_wall_flows(
    int count, int whole, __global const int *rows, __global const int *above,
    __global const double *positions, __global const double *normals,
    __global const double *sizes, __global const double *velocities,
    __global const double *temperatures, __global const double *primitive, Transport law,
    int first, __global double *parts OF_SLIDING)
{
    const int n = get_global_id(0), item = get_local_id(0);
    __local double x[GROUP], y[GROUP], z[GROUP], energy[GROUP];
    x[item] = y[item] = z[item] = energy[item] = 0;
    if (n < count) {
        const int i = rows[n], j = above[AT(n, 0, 2, count)], k = above[AT(n, 1, 2, count)];
        const Vector normal = vector_at(normals, i, whole);
        const Vector velocity = vector_at(velocities, n, count);
        Traction traction =
            traction_at(i, j, k, whole, positions, normal, velocity, primitive, law);
#ifdef RAREFIED
        if (lengths[AT(n, 0, 2, count)] > 0.0)
            traction = sliding_traction_at(
                i, j, k, whole, width, positions, normal, velocity, neighbours, coefficients,
                primitive, curvature, law);
#endif
        x[item] = -sizes[n] * traction.f0;
        y[item] = -sizes[n] * traction.f1;
        z[item] = -sizes[n] * traction.f2;
        const double heat = temperatures[n] < 0.0 ? 0.0 : traction.f3;
        energy[item] = x[item] * velocity.f0 + y[item] * velocity.f1 + z[item] * velocity.f2
            - sizes[n] * heat;
    }
    add_in_group(x);
    add_in_group(y);
    add_in_group(z);
    add_in_group(energy);
    if (item) return;
    __global double *to = parts + first + 5 * get_group_id(0);
    to[0] = 0, to[1] = x[0], to[2] = y[0], to[3] = z[0], to[4] = energy[0];
}
