/* Sum each column over a part of the rows; the order depends only on the number of parts. */

__kernel void sum_parts(__global const double4 *rows, int count, __global double4 *part)
{
    double4 sum = 0;
    for (int i = get_global_id(0); i < count; i += get_global_size(0)) sum += rows[i];
    part[get_global_id(0)] = sum;
}
