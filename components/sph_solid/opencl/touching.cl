/* Contact of particles that were no neighbours at the start: see kernels/touching.py, whose laws
   are printed. Lists are ascending, so that sums do not depend on when they were made. */

/* Whether two rows of places at the start, with the numbers of the joined bodies, were apart. */
static int were_apart(double4 a, double4 b, double support2)
{
    const double4 d = a - b;
    return d.x * d.x + d.y * d.y + d.z * d.z >= support2 || d.w != 0;
}

/* List what is within a reach of each particle and was apart from it, in ascending order of rows,
   or of the numbers that these have in `order`. Lists that are too short count on: the greatest
   count tells how long they must be. */
__kernel void list_touching(
    int count, __global const double4 *position, __global const double4 *start,
    __global const int *order, double support2, double reach2,
    __global const long *key, Grid grid, __global const int *cell_start, int width, long row_stride,
    long item_stride, __global int *near, __global int *end, __global double4 *extremes)
{
    const int i = get_global_id(0);
    if (i >= count) return;
    const double4 r = position[i];
    const double along_axes[3] = {r.x, r.y, r.z};
    const long cell = cell_of(
        along_axes[grid.first], along_axes[grid.second], along_axes[grid.third], grid);
    const int cx = cell % grid.nx, cy = cell / grid.nx % grid.ny, cz = cell / grid.nx / grid.ny;
    const int low = max(cx - REACH, 0), high = min(cx + REACH, (int)grid.nx - 1);
    __global int *list = near + (size_t)i * row_stride;
    int listed = 0;
    for (int kz = max(cz - REACH, 0); kz <= min(cz + REACH, (int)grid.nz - 1); kz++)
        for (int ky = max(cy - REACH, 0); ky <= min(cy + REACH, (int)grid.ny - 1); ky++) {
            const long row = grid.nx * (ky + grid.ny * kz);
            for (int k = cell_start[row + low]; k < cell_start[row + high + 1]; k++) {
                const int j = key[k] & ROW;
                const double4 d = r - position[j];
                if (!(d.x * d.x + d.y * d.y + d.z * d.z < reach2)) continue;
                if (!were_apart(start[i], start[j], support2)) continue;
                if (listed < width) {
                    int place = listed;
                    for (; place; place--) {
                        const int last = list[item_stride * (place - 1)];
                        if (order ? order[last] < order[j] : last < j) break;
                        list[item_stride * place] = last;
                    }
                    list[item_stride * place] = j;
                }
                listed++;
            }
        }
    end[i] = listed;
    extremes[i] = (double4)(listed, 0, 0, 0);
}

static double part_of(double4 row, double axis)
{
    return axis == 0 ? row.x : axis == 1 ? row.y : row.z;
}

/* Add the accelerations of contact to `heats`, and its power to the heating; `nominal` has rho_0.
   Planes are an axis, a position, and the side that is computed. */
__kernel void touch(
    int count, double spacing, double support, __global const double4 *start,
    __global const double4 *position, __global const double4 *motion,
    __global const double4 *nominal, int planes, __global const double4 *plane,
    __global const int *near, __global const int *end, long row_stride, long item_stride,
    __global double *heats, __global double *heating)
{
    const int i = get_global_id(0);
    if (i >= count) return;
    const double4 r = position[i], u = motion[i];
    const double rest = nominal[3 * i + 2].z, stiff_i = stiffness(rest, u.w);
    const double per = 1.0 / (rest * r.w);
    double3 sum = vload3(i, heats);
    double heat = heating[i];
    for (int k = 0; k < end[i]; k++) {
        const int j = near[(size_t)i * row_stride + k * item_stride];
        const double4 d = r - position[j], change = u - motion[j];
        const double square = d.x * d.x + d.y * d.y + d.z * d.z;
        if (!is_touching(square, spacing)) continue;
        const double stiff = 0.5 * (stiff_i + stiffness(nominal[3 * j + 2].z, motion[j].w));
        const tuple_3r apart = {d.x, d.y, d.z};
        const tuple_3r f = contact_force(apart, square, stiff, r.w * position[j].w, spacing);
        const double power = f.f0 * change.x + f.f1 * change.y + f.f2 * change.z;
        sum += per * (double3)(f.f0, f.f1, f.f2);
        heat -= 0.5 * power * per;
    }
    for (int k = 0; k < planes; k++) {
        const double axis = plane[k].x, at = plane[k].y, inward = plane[k].z;
        if (2.0 * (inward * (part_of(start[i], axis) - at)) < support) continue;
        const double apart = 2.0 * inward * (part_of(r, axis) - at);
        if (apart >= spacing) continue;
        const double push = inward * plane_force(apart, stiff_i * r.w, spacing);
        sum += (double3)(axis == 0, axis == 1, axis == 2) * (push * per);
        heat -= push * part_of(u, axis) * per;
    }
    vstore3(sum, i, heats);
    heating[i] = heat;
}
