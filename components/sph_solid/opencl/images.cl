/* Images of particles in planes of symmetry. Each has a root, a particle; its place is that of the
   root times a sign along each axis, plus a shift. */

/* Write the images of places and motion, which stand behind those of `count` particles. */
__kernel void mirror_rows(
    int count, int images, __global const long *root, __global const double4 *sign,
    __global const double4 *shift, __global double4 *place, __global double4 *motion)
{
    const int k = get_global_id(0);
    if (k >= images) return;
    place[count + k] = sign[k] * place[root[k]] + shift[k];
    motion[count + k] = sign[k] * motion[root[k]];
}

/* Write the images of the rows of stress: M T M, with the signs on the diagonal of M. */
__kernel void mirror_stress(
    int count, int images, __global const long *root, __global const double4 *sign,
    __global double4 *stress)
{
    const int k = get_global_id(0);
    if (k >= images) return;
    const int from = WIDTH * root[k], to = WIDTH * (count + k);
    const double4 s = sign[k];
    const double xy = s.x * s.y, yz = s.y * s.z, zx = s.z * s.x;
#ifdef NINE_NUMBERS
    stress[to] = stress[from] * (double4)(1, xy, zx, xy);
    stress[to + 1] = stress[from + 1] * (double4)(1, yz, zx, yz);
    stress[to + 2] = stress[from + 2];
#else
    stress[to] = stress[from] * (double4)(1, 1, 1, xy);
    stress[to + 1] = stress[from + 1] * (double4)(yz, zx, 1, 1);
#ifdef ARTIFICIAL
    stress[to + 2] = stress[from + 2] * (double4)(1, 1, 1, xy);
    stress[to + 3] = stress[from + 3] * (double4)(yz, zx, 1, 1);
#endif
#endif
}

/* Reflect particles that passed a plane; see shared/symmetry.py. */
__kernel void reflect(
    int count, int axis, double at, double inward, __global double *position,
    __global double *velocity, __global double *acceleration, __global double *deviator)
{
    const int i = get_global_id(0);
    if (i >= count) return;
    const size_t k = 3 * (size_t)i + axis;
    if (!(inward * (position[k] - at) < 0)) return;
    position[k] = 2 * at - position[k];
    velocity[k] *= -1;
    acceleration[k] *= -1;
    const size_t xy = 6 * (size_t)i + 3, yz = xy + 1, zx = xy + 2;
    deviator[axis == 2 ? yz : xy] *= -1;
    deviator[axis == 1 ? yz : zx] *= -1;
}
