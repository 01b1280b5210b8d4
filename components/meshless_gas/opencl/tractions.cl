/* Friction and heat at walls; see viscous/kernels/walls.py. */

/* Height of node j above wall node i. */
static double height(
    int i, int j, int whole, __global const double *positions, Vector normal)
{
    const Vector at = vector_at(positions, i, whole), there = vector_at(positions, j, whole);
    return (there.f0 - at.f0) * normal.f0 + (there.f1 - at.f1) * normal.f1
        + (there.f2 - at.f2) * normal.f2;
}

/* Friction on wall node i and heat flux into it, by the nodes j and k above it. */
static Traction traction_at(
    int i, int j, int k, int whole, __global const double *positions, Vector normal,
    Vector velocity, __global const double *primitive, Transport law)
{
    return wall_traction(
        state_at(primitive, i, whole), state_at(primitive, j, whole),
        state_at(primitive, k, whole), height(i, j, whole, positions, normal),
        height(i, k, whole, positions, normal), velocity, normal, law);
}
