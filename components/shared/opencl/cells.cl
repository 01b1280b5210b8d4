/* Points sorted by cell, and lists of neighbours; Grid and cell_of name what is printed. */

#define ROW 0xffffffffL /* of a key: the row that a point had; above it stands its cell */

/* Key of each of `count` points from row `first` on; keys beyond them sort last. */
__kernel void number_rows(
    __global const double4 *position, int first, int count, Grid grid, __global long *key)
{
    const int k = get_global_id(0);
    if (k >= count) {
        key[k] = LONG_MAX;
        return;
    }
    const double4 r = position[first + k];
    const double along[3] = {r.x, r.y, r.z};
    const long cell = cell_of(along[grid.first], along[grid.second], along[grid.third], grid);
    key[k] = (cell << 32) | (first + k);
}

/* Order two keys of a bitonic sort: rising, unless bit `size` of the first one's row is set. */
#define IN_ORDER(first, second, row, size) \
    { \
        const long a = first, b = second; \
        if ((a > b) == (((row) & (size)) == 0)) { \
            first = b; \
            second = a; \
        } \
    }

/* A pass of Batcher's bitonic sort over keys, a power of two; keys are all different. */
__kernel void sort_pass(__global long *key, int size, int distance)
{
    const int i = get_global_id(0), j = i ^ distance;
    if (j > i) IN_ORDER(key[i], key[j], i, size);
}

/* All passes of the sort from one size to another whose keys are in the same BLOCK. */
__kernel void sort_blocks(__global long *key, int from, int to)
{
    __local long block[BLOCK];
    const int item = get_local_id(0), items = get_local_size(0), start = get_group_id(0) * BLOCK;
    for (int k = item; k < BLOCK; k += items) block[k] = key[start + k];
    for (int size = from; size <= to; size <<= 1)
        for (int distance = min(size, BLOCK) >> 1; distance; distance >>= 1) {
            barrier(CLK_LOCAL_MEM_FENCE);
            for (int pair = item; pair < BLOCK / 2; pair += items) {
                const int low = pair & (distance - 1), i = ((pair - low) << 1) + low;
                IN_ORDER(block[i], block[i + distance], start + i, size);
            }
        }
    barrier(CLK_LOCAL_MEM_FENCE);
    for (int k = item; k < BLOCK; k += items) key[start + k] = block[k];
}

/* Where each cell starts among sorted points; `start` has two more than there are cells. */
__kernel void start_cells(
    __global const long *key, int count, long cells, int base, __global int *start)
{
    const int k = get_global_id(0);
    if (k > count) return;
    const long from = k ? (key[k - 1] >> 32) + 1 : 0, to = k < count ? key[k] >> 32 : cells + 1;
    for (long cell = from; cell <= to; cell++) start[cell] = base + k;
}

/* Greatest of each column over a part of the rows. */
__kernel void greatest(__global const double4 *rows, int count, __global double4 *part)
{
    double4 most = -INFINITY;
    for (int i = get_global_id(0); i < count; i += get_global_size(0)) {
        const double4 row = rows[i];
        most = row > most ? row : most;
    }
    part[get_global_id(0)] = most;
}

/* Neighbours among a range of points that the keys of a group begin to count at. */
static int add_near(
    double4 r, int cx, int cy, int cz, Grid grid, __global const int *start,
    __global const double4 *position, __global const int *name, double reach2, int width,
    size_t place, size_t stride, int count, __global int *near)
{
    const int low = max(cx - REACH, 0), high = min(cx + REACH, (int)grid.nx - 1);
    for (int kz = max(cz - REACH, 0); kz <= min(cz + REACH, (int)grid.nz - 1); kz++)
        for (int ky = max(cy - REACH, 0); ky <= min(cy + REACH, (int)grid.ny - 1); ky++) {
            const long row = grid.nx * (ky + grid.ny * kz);
            const int end = start[row + high + 1];
            for (int j = start[row + low]; j < end; j++) {
                const double4 d = r - position[j];
                if (d.x * d.x + d.y * d.y + d.z * d.z < reach2) {
                    if (count < width) near[place + stride * count] = name ? name[j] : j;
                    count++;
                }
            }
        }
    return count;
}

/* List neighbours within a reach: for the first group of both, for others of the first alone.

   Rows from `looking` on look from a point of their own, if there are such points. Lists have the
   names of points, or their rows if these have no names. Rows whose lists are too short count on:
   the greatest count gives the length they need. */
__kernel void search(
    __global const double4 *position, __global const int *name, __global const double *look,
    int looking, int split, int count, Grid grid, __global const int *start_one,
    __global const int *start_two, double reach2, int width, long row_stride, long item_stride,
    __global int *near, __global int *middle, __global int *end, __global double4 *extremes)
{
    const int i = get_global_id(0);
    if (i >= count) return;
    const double4 r =
        look && i >= looking ? (double4)(vload3(i - looking, look), 0) : position[i];
    const double along[3] = {r.x, r.y, r.z};
    const long cell = cell_of(along[grid.first], along[grid.second], along[grid.third], grid);
    int count_near = 0;
    middle[i] = 0;
    if (cell < grid.nx * grid.ny * grid.nz) {
        const int cx = cell % grid.nx, cy = cell / grid.nx % grid.ny, cz = cell / grid.nx / grid.ny;
        const size_t place = (size_t)i * row_stride;
        count_near = add_near(
            r, cx, cy, cz, grid, start_one, position, name, reach2, width, place, item_stride,
            count_near, near);
        middle[i] = count_near;
        if (i < split)
            count_near = add_near(
                r, cx, cy, cz, grid, start_two, position, name, reach2, width, place, item_stride,
                count_near, near);
    }
    end[i] = count_near;
    extremes[i] = (double4)(count_near, 0, 0, 0);
}
