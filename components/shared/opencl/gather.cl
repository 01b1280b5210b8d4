/* Rows in another order; ROW is that of cells.cl. */

/* Copy `count` rows of `width` words in the order of keys, to rows from `first` on. Keys count
   rows of all particles; those of the array begin at `base`. */
__kernel void gather(
    __global const long *key, int count, int first, int base, int width,
    __global const long *from, __global long *to)
{
    const int k = get_global_id(0);
    if (k >= count) return;
    const size_t source = ((int)(key[k] & ROW) - base) * (size_t)width;
    const size_t target = (first + k) * (size_t)width;
    for (int w = 0; w < width; w++) to[target + w] = from[source + w];
}
