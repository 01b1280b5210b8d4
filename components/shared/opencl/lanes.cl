/* LANES neighbours of row i are summed at a time, each lane by itself, and the lanes are added in
   order at the end. Where a list ends before its last lanes do, these have row i itself, moved out
   of reach. */

#if LANES == 4
#define GATHERED(array, part) \
    ((reals)(array[j0].part, array[j1].part, array[j2].part, array[j3].part))
#define NUMBERS(array) ((reals)(array[j0], array[j1], array[j2], array[j3]))
#define TOTAL(lanes) ((lanes.x + lanes.y) + (lanes.z + lanes.w))
#define GREATEST(lanes) max_real(max_real(lanes.x, lanes.y), max_real(lanes.z, lanes.w))
#define NEAR(lane) (k + lane < stop ? near[place + item_stride * (k + lane)] : i)
#define ROWS const int j0 = NEAR(0), j1 = NEAR(1), j2 = NEAR(2), j3 = NEAR(3)
#define BEYOND(x) \
    (k + 4 <= stop ? (reals)0 : (reals)(0, k + 1 < stop ? 0 : x, k + 2 < stop ? 0 : x, x))
#elif LANES == 1
#define GATHERED(array, part) array[j].part
#define NUMBERS(array) array[j]
#define TOTAL(lanes) lanes
#define GREATEST(lanes) lanes
#define ROWS const int j = near[place + item_stride * k]
#define BEYOND(x) 0
#else
#error "LANES must be 1 or 4"
#endif
