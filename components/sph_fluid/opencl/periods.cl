/* Images a period away, behind all other rows; see open_boundaries/periodic.py. Each pass is over
   those at one end of an axis. */

/* Write the images of positions, `distance` further along the axis. */
__kernel void shift_positions(
    __global const int *origin, int count, int first, int axis, double distance,
    __global double4 *position)
{
    const int k = get_global_id(0);
    if (k >= count) return;
    double4 r = position[origin[k]];
    if (axis == 0) r.x += distance;
    if (axis == 1) r.y += distance;
    if (axis == 2) r.z += distance;
    position[first + k] = r;
}

#define REPEAT_VECTORS(name, type) \
    __kernel void name( \
        __global const int *origin, int count, int first, __global type *vector) \
    { \
        const int k = get_global_id(0); \
        if (k < count) vector[first + k] = vector[origin[k]]; \
    }
REPEAT_VECTORS(repeat_velocities, double4)
REPEAT_VECTORS(repeat_apparent, RATE4)
