/* Images in planes of symmetry, behind all other rows; see shared/symmetry.py. Each pass is about
   one plane across an axis. */

/* Write the images of positions; `twice` is two times the place of the plane. */
__kernel void image_positions(
    __global const int *origin, int count, int first, int axis, double twice,
    __global double4 *position)
{
    const int k = get_global_id(0);
    if (k >= count) return;
    double4 r = position[origin[k]];
    if (axis == 0) r.x = twice - r.x;
    if (axis == 1) r.y = twice - r.y;
    if (axis == 2) r.z = twice - r.z;
    position[first + k] = r;
}

#define IMAGE_VECTORS(name, type) \
    __kernel void name( \
        __global const int *origin, int count, int first, int axis, __global type *vector) \
    { \
        const int k = get_global_id(0); \
        if (k >= count) return; \
        type u = vector[origin[k]]; \
        if (axis == 0) u.x = -u.x; \
        if (axis == 1) u.y = -u.y; \
        if (axis == 2) u.z = -u.z; \
        vector[first + k] = u; \
    }
IMAGE_VECTORS(image_velocities, double4)
IMAGE_VECTORS(image_apparent, RATE4)

/* Let fluid that passed the plane change places with its image. */
__kernel void reflect_crossed(
    int split, int axis, double place, double inward, __global double *position,
    __global double *velocity, __global double *acceleration)
{
    const int i = get_global_id(0);
    if (i >= split) return;
    const size_t row = 4 * (size_t)i + axis;
    if (inward * (position[row] - place) < 0.0) {
        position[row] = 2.0 * place - position[row];
        velocity[row] = -velocity[row];
        if (acceleration) acceleration[3 * (size_t)i + axis] *= -1.0;
    }
}
