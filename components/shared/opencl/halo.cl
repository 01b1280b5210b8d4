/* Rows of arrays in and out of messages between ranks, as words of 8 bytes. */

/* Copy rows of an array of `width` words into a message of `stride` words a row, starting at word
   `first`. */
__kernel void pack(
    __global const int *row, int count, int width, int first, int stride,
    __global const long *from, __global long *message)
{
    const int k = get_global_id(0);
    if (k >= count) return;
    for (int w = 0; w < width; w++)
        message[k * (size_t)stride + first + w] = from[row[k] * (size_t)width + w];
}

/* Copy the rows of a message, starting at word `first`, into rows of an array. */
__kernel void unpack(
    __global const int *row, int count, int width, int first, int stride,
    __global const long *message, __global long *to)
{
    const int k = get_global_id(0);
    if (k >= count) return;
    for (int w = 0; w < width; w++)
        to[row[k] * (size_t)width + w] = message[k * (size_t)stride + first + w];
}
