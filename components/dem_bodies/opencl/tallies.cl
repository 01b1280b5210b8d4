/* Sums and greatest of many rows. Every group of GROUP work items reduces its rows, and one group
   for each column reduces what the groups found: no bit depends on the device's units.

   A column of a group stands in local memory at COLUMN(c), one number of each item. */

#define COLUMN(c) ((c) * (GROUP + 1))
#define ROOM(columns) __local double room[(columns) * (GROUP + 1)]
#define STORE(c, number) room[COLUMN(c) + get_local_id(0)] = number

/* The next number of a column that is added up, or of which the maximum is taken; NaN is never the
   maximum, as in numba. */
static double tallied(int is_sum, double total, double number)
{
    return is_sum ? total + number : max_real(total, number);
}

/* Reduce the columns of a group, of which the first are sums, after all items have stored. */
static void tally(__local const double *room, int sums, int columns, __global double *part)
{
    const int c = get_local_id(0);
    if (c >= columns) return;
    double total = c < sums ? 0 : -FAR;
    for (int k = 0; k < GROUP; k++) total = tallied(c < sums, total, room[COLUMN(c) + k]);
    part[c * get_num_groups(0) + get_group_id(0)] = total;
}

/* Reduce the column of this group over the parts of all groups of another kernel. */
__kernel void collect(
    int groups, int sums, int first, __global const double *part, __global double *report)
{
    __local double room[GROUP];
    const int c = get_group_id(0), item = get_local_id(0), is_sum = c < sums;
    double total = is_sum ? 0 : -FAR;
    for (int k = item; k < groups; k += GROUP)
        total = tallied(is_sum, total, part[c * groups + k]);
    room[item] = total;
    barrier(CLK_LOCAL_MEM_FENCE);
    if (item) return;
    for (int k = 1; k < GROUP; k++) total = tallied(is_sum, total, room[k]);
    report[first + c] = total;
}
