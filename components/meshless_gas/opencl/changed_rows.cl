/* Some rows of tables, which the host has changed or reads; values are by rows. */

/* Read rows; the first word goes to `first`. */
__kernel void read_rows(
    int count, int width, int whole, int first, __global const int *rows,
    __global const double *table, __global double *values)
{
    const int word = get_global_id(0), row = word / width, q = word % width;
    if (row < count) values[(size_t)first + word] = table[AT(rows[row], q, width, whole)];
}

__kernel void write_rows(
    int count, int width, int whole, __global const int *rows, __global const double *values,
    __global double *table)
{
    const int word = get_global_id(0), row = word / width, q = word % width;
    if (row < count) table[AT(rows[row], q, width, whole)] = values[word];
}

__kernel void write_rows_of_nodes(
    int count, int width, int whole, __global const int *rows, __global const int *values,
    __global int *table)
{
    const int word = get_global_id(0), row = word / width, q = word % width;
    if (row < count) table[AT(rows[row], q, width, whole)] = values[word];
}
