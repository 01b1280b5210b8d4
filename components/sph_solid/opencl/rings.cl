/* Azimuthal images of rings: see kernels/azimuthal_images.py, whose laws are printed.

   Rows of turns are a cosine, a sine, and a share of the ring's volume; the first turns nothing. */

/* List the images that are near each ring, by the rings that are near in the plane. Lists that are
   too short count on: the greatest count tells how long they must be. */
__kernel void list_images(
    int count, __global const double4 *position,
    __global const long *numbers, double reach2, double close, __global const double4 *turns,
    int all_of_few, __global const int *near, __global const int *end, long row_stride,
    long item_stride, int width, long image_stride, long image_item_stride, __global int *ring,
    __global int *turn, __global int *image_end, __global double4 *extremes)
{
    const int i = get_global_id(0);
    if (i >= count) return;
    const double4 at = position[i];
    const size_t place = (size_t)i * row_stride, target = (size_t)i * image_stride;
    int images = 0;
    for (int q = 0; q < end[i]; q++) {
        const int j = near[place + item_stride * q];
        const double4 r = position[j];
        const long n = max(numbers[i], numbers[j]);
        const double flat = (at.x - r.x) * (at.x - r.x) + (at.z - r.z) * (at.z - r.z);
        const Turns rows = turns_of_pair(n, at.x < close || r.x < close, all_of_few);
        for (long k = i == j; k < rows.f1; k++) {
            if (turned_square(flat, at.x, r.x, turns[rows.f0 + k].x) >= reach2) break;
            if (images < width) {
                ring[target + image_item_stride * images] = j;
                turn[target + image_item_stride * images] = rows.f0 + k;
            }
            images++;
        }
    }
    image_end[i] = images;
    extremes[i] = (double4)(images, 0, 0, 0);
}
