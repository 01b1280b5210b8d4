/* Rows sorted by cell, and pairs listed, as contact/ball_search.py does it; key_of and the numbers
   are printed. A key is that of a ball's cell, and the row that the ball had. */

#define NEAR_ROWS 9 /* of cells: the ball's own and those around it, three cells in each */

/* Keys of the balls; those beyond them sort last. */
__kernel void number_balls(
    int balls, double width, __global const double4 *motion, __global long2 *key)
{
    const int i = get_global_id(0);
    const double4 at = motion[4 * min(i, balls)];
    key[i] = (long2)(i < balls ? key_of(at.x, at.y, at.z, width) : LONG_MAX, i);
}

/* A pass of Batcher's bitonic sort over keys, a power of two; keys are all different. */
__kernel void sort_keys(__global long2 *key, int size, int distance)
{
    const int i = get_global_id(0), j = i ^ distance;
    if (j <= i) return;
    const long2 a = key[i], b = key[j];
    const int is_later = a.x > b.x || (a.x == b.x && a.y > b.y);
    if (is_later == ((i & size) == 0)) {
        key[i] = b;
        key[j] = a;
    }
}

/* Copy rows of words of 8 bytes in the order of keys. */
__kernel void take_rows(
    int balls, int width, __global const long2 *key, __global const long *from, __global long *to)
{
    const int i = get_global_id(0);
    if (i >= balls) return;
    const size_t source = key[i].y * (size_t)width, target = i * (size_t)width;
    for (int w = 0; w < width; w++) to[target + w] = from[source + w];
}

/* Where balls are as they are listed. */
__kernel void note_places(int balls, __global const double4 *motion, __global double *listed)
{
    const int i = get_global_id(0);
    if (i < balls) vstore3(motion[4 * i].xyz, i, listed);
}

/* How many of sorted keys are less than one. */
static int rows_below(__global const long2 *key, int balls, long cell)
{
    int low = 0, high = balls;
    while (low < high) {
        const int middle = (low + high) / 2;
        if (key[middle].x < cell) low = middle + 1;
        else high = middle;
    }
    return low;
}

/* Whether two balls are nearer than the skin; likewise a ball and a plane. */
static int is_near(double4 a, double4 b, double skin)
{
    const double4 d = a - b;
    const double near = a.w + b.w + skin;
    return d.x * d.x + d.y * d.y + d.z * d.z < near * near;
}

static int is_near_plane(double4 a, double4 plane, double skin)
{
    return plane.x * a.x + plane.y * a.y + plane.z * a.z - plane.w - a.w < skin;
}

/* For each row `j` that may be near row i, in rising order. */
#define FOR_NEAR(act) \
    for (int part = 0; part < NEAR_ROWS; part++) { \
        const long cell = key[i].x + (part / 3 - 1) * LAYER + (part % 3 - 1) * ROW_OF_CELLS - 1; \
        const int stop = rows_below(key, balls, cell + 3); \
        for (int j = rows_below(key, balls, cell); j < stop; j++) \
            if (j != i && is_near(at, motion[4 * j], skin)) { act } \
    }

/* How many planes and later rows are near each row, and how many earlier ones. */
__kernel void count_near(
    int balls, int planes, double skin, __global const long2 *key, __global const double4 *motion,
    __global const double4 *plane, __global int *later, __global int *earlier)
{
    const int i = get_global_id(0);
    if (i >= balls) return;
    const double4 at = motion[4 * i];
    int count = 0, before = 0;
    for (int p = 0; p < planes; p++) count += is_near_plane(at, plane[p], skin);
    FOR_NEAR(if (j > i) count++; else before++;)
    later[i] = count;
    earlier[i] = before;
}

/* Pairs of each row: planes first, then later rows. */
__kernel void list_near(
    int balls, int planes, double skin, __global const long2 *key, __global const double4 *motion,
    __global const double4 *plane, __global const int *begin, __global int *row,
    __global int *partner)
{
    const int i = get_global_id(0);
    if (i >= balls) return;
    const double4 at = motion[4 * i];
    int k = begin[i];
    for (int p = 0; p < planes; p++)
        if (is_near_plane(at, plane[p], skin)) {
            row[k] = i;
            partner[k++] = balls + 1 + p;
        }
    FOR_NEAR(if (j > i) { row[k] = i; partner[k++] = j; })
}

/* Pairs that list each row, in the order of the pairs. */
__kernel void list_incoming(
    int balls, double skin, __global const long2 *key, __global const double4 *motion,
    __global const int *begin, __global const int *partner, __global const int *incoming_begin,
    __global int *incoming)
{
    const int i = get_global_id(0);
    if (i >= balls) return;
    const double4 at = motion[4 * i];
    int place = incoming_begin[i];
    FOR_NEAR(
        if (j < i)
            for (int k = begin[j]; k < begin[j + 1]; k++)
                if (partner[k] == i) incoming[place++] = k;
    )
}

/* History of pairs that touched; tangential force changes sign if the pair's balls have changed
   places. */
__kernel void carry_history(
    int count, int rows, __global const long2 *key, __global const int *row,
    __global const int *partner, int former_stride, __global const int *former_begin,
    __global const int *former_partner, __global const double *former_history,
    __global const double4 *former_spring, int stride, __global double *history,
    __global double4 *spring)
{
    const int k = get_global_id(0);
    if (k >= count) return;
    const int a = key[row[k]].y, b = partner[k] < rows ? (int)key[partner[k]].y : partner[k];
    const int first = min(a, b), second = max(a, b);
    const double sign = b < a ? -1 : 1;
    __global const double *former_inverse_root = former_history + 3 * (size_t)former_stride;
    int former_pair = -1;
    for (int q = former_begin[first]; q < former_begin[first + 1]; q++)
        if (former_partner[q] == second && former_inverse_root[q] != 0) former_pair = q;
    for (int number = 0; number < 3; number++) {
        const size_t former = number * (size_t)former_stride + former_pair;
        history[number * (size_t)stride + k] = former_pair < 0 ? 0 : sign * former_history[former];
    }
    history[3 * (size_t)stride + k] = former_pair < 0 ? 0 : former_inverse_root[former_pair];
#ifdef ROLLS
    spring[k] = former_pair < 0 ? 0 : sign * former_spring[former_pair];
#endif
}

/* Constants of each pair: a plane is a ball of infinite radius. */
__kernel void write_constants(
    int count, int rows, int materials, __global const int *row, __global const int *partner,
    __global const double4 *motion, __global const double2 *inverse, __global const long *material,
    __global const long *plane_material, __global const double *material_pairs,
    __global int *constants_row, __global double4 *constants)
{
    const int k = get_global_id(0);
    if (k >= count) return;
    const int i = row[k], b = partner[k], is_ball = b < rows;
    const double radius_i = motion[4 * i].w, radius_j = motion[4 * min(b, rows - 1)].w;
    const double radius = is_ball ? 1 / (1 / radius_i + 1 / radius_j) : radius_i;
    const double per_mass = inverse[i].x + (is_ball ? inverse[b].x : 0);
    const long other = is_ball ? material[b] : plane_material[b - rows];
    __global const double *material_constants =
        material_pairs + 5 * (material[i] * materials + other);
    const Constants c = pair_constants(
        material_constants[0], material_constants[1], material_constants[2],
        material_constants[3], radius, 1 / per_mass);
    double arm = 0, per_inertia = 0;
#ifdef ROLLS
    arm = material_constants[4] * radius;
    per_inertia = inverse_inertia(inverse[i].x, inverse[i].y, radius_i);
    if (is_ball) per_inertia += inverse_inertia(inverse[b].x, inverse[b].y, radius_j);
#endif
    constants_row[k] = k;
    constants[WIDTH * k] = (double4)(c.f0, c.f1, c.f2, c.f3);
    constants[WIDTH * k + 1] = (double4)(c.f4, c.f5, c.f6, arm);
    constants[WIDTH * k + 2] = (double4)(per_inertia, 0, 0, 0);
}
