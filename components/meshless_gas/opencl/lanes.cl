/* LANES nodes go side by side, each lane by itself: compilers of processors make no vectors of
   loops over them by themselves. j is a node of each lane; after the last node lanes repeat it. */

#if LANES == 4
#define NODES_OF(name, node) \
    const int name##0 = node(0), name##1 = node(1), name##2 = node(2), name##3 = node(3)
#define GATHERED(table, i, q, width, count) \
    ((reals)( \
        table[AT(i##0, q, width, count)], table[AT(i##1, q, width, count)], \
        table[AT(i##2, q, width, count)], table[AT(i##3, q, width, count)]))
#define SCATTERED(table, i, q, width, count, values, lanes) \
    do { \
        table[AT(i##0, q, width, count)] = values.x; \
        if (lanes > 1) table[AT(i##1, q, width, count)] = values.y; \
        if (lanes > 2) table[AT(i##2, q, width, count)] = values.z; \
        if (lanes > 3) table[AT(i##3, q, width, count)] = values.w; \
    } while (0)
#define ARE_SAME(i, j) (i##0 == j##0 && i##1 == j##1 && i##2 == j##2 && i##3 == j##3)
#elif LANES == 1
#define NODES_OF(name, node) const int name##0 = node(0)
#define GATHERED(table, i, q, width, count) (table[AT(i##0, q, width, count)])
#define SCATTERED(table, i, q, width, count, values, lanes) \
    table[AT(i##0, q, width, count)] = values
#define ARE_SAME(i, j) (i##0 == j##0)
#else
#error "LANES must be 1 or 4"
#endif
