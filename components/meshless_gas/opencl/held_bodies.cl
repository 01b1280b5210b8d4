/* Walls of bodies that hold the gas; see moving/kernels/held_walls.py. */

static double temperature_at(
    __global const double *primitive, int i, int whole, double gas_constant)
{
    return gas_temperature(
        primitive[AT(i, 0, 5, whole)], primitive[AT(i, 4, 5, whole)], gas_constant);
}

/* Densities and velocities of walls, whose pressures are those of slip walls. Of all walls of
   bodies `held` numbers those that hold the gas. */
__kernel void write_held_walls(
    int count, int walls, int whole, __global const int *held, __global const int *rows,
    __global const int *above, __global const double *heights,
    __global const double *temperatures, __global const double *velocities, double gas_constant,
    __global double *primitive)
{
    const int h = get_global_id(0);
    if (h >= count) return;
    const int n = held[h], i = rows[n];
    double warmth = temperatures[h];
    if (warmth < 0.0)
        warmth = level_temperature(
            temperature_at(primitive, above[AT(n, 0, 2, walls)], whole, gas_constant),
            temperature_at(primitive, above[AT(n, 1, 2, walls)], whole, gas_constant),
            heights[AT(n, 0, 2, walls)], heights[AT(n, 1, 2, walls)]);
    primitive[AT(i, 0, 5, whole)] = primitive[AT(i, 4, 5, whole)] / (gas_constant * warmth);
    for (int d = 0; d < 3; d++)
        primitive[AT(i, 1 + d, 5, whole)] = velocities[AT(n, d, 3, walls)];
}
