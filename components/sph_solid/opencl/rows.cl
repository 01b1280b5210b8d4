/* Loops over rows: what a search begins with, and whether one is needed. */

/* Places in a step's middle and velocities, after particles have been reflected. */
__kernel void fill(
    int count, double dt, __global const double *position, __global const double *velocity,
    __global double4 *place, __global double4 *motion)
{
    const int i = get_global_id(0);
    if (i >= count) return;
    place[i].xyz = vload3(i, position) + 0.5 * dt * vload3(i, velocity);
    motion[i].xyz = vload3(i, velocity);
}

/* Rows of vectors and minus these; the last column tells of those that are not finite. */
__kernel void survey(
    int count, __global const double4 *rows, __global double4 *most, __global double4 *least)
{
    const int i = get_global_id(0);
    if (i >= count) return;
    const double3 r = rows[i].xyz;
    most[i] = (double4)(r, !(isfinite(r.x) && isfinite(r.y) && isfinite(r.z)));
    least[i] = (double4)(-r, 0);
}

/* Mark particles whose energy, strain, temperature or damage is not finite. */
__kernel void find_not_finite(
    int count, __global const double *energy, __global const double *strain,
    __global const double *temperature, __global const double *damage,
    __global double4 *extremes)
{
    const int i = get_global_id(0);
    if (i >= count) return;
    const double4 numbers = {energy[i], strain[i], temperature[i], damage[i]};
    extremes[i] = all(isfinite(numbers)) ? 0.0 : 1.0;
}

/* Where particles are as they are listed. */
__kernel void note_places(
    int count, __global const double4 *place, __global double *reference)
{
    const int i = get_global_id(0);
    if (i < count) vstore3(place[i].xyz, i, reference);
}

/* How far particles are from where they were listed, in the middle of a step and at its end. */
__kernel void displacements(
    int count, double dt, __global const double4 *place, __global const double *position,
    __global const double *velocity, __global const double *reference, __global double4 *middle,
    __global double4 *last)
{
    const int i = get_global_id(0);
    if (i >= count) return;
    const double3 from = vload3(i, reference);
    middle[i] = (double4)(place[i].xyz - from, 0);
    last[i] = (double4)(vload3(i, position) + dt * vload3(i, velocity) - from, 0);
}

static double square_of(double4 d) { return d.x * d.x + d.y * d.y + d.z * d.z; }

/* Mark particles further than a limit from their listed place, less the mean displacement. */
__kernel void mark_fast(
    int count, double4 mean_of_middle, double4 mean_of_last, double limit2,
    __global const double4 *middle, __global const double4 *last, __global uchar *is_fast)
{
    const int i = get_global_id(0);
    if (i >= count) return;
    const double furthest =
        max_real(square_of(middle[i] - mean_of_middle), square_of(last[i] - mean_of_last));
    is_fast[i] = furthest > limit2;
}

/* Whether a place is nearer to a plane (axis, position, inward) than pairs act. */
static int is_near_plane(double3 at, double4 plane, double support)
{
    const double along = plane.x == 0 ? at.x : plane.x == 1 ? at.y : at.z;
    return plane.z * (along - plane.y) < support;
}

/* Whether each particle meets one of a few that may be missing in its list, or is one of these and
   near a plane, or a ring that became much wider or narrower; see neighbours.py:may_miss and
   kernels/motion.py:meets_unlisted. */
__kernel void meet_few(
    int count, int few, __global const int *fast, int plane_count, __global const double4 *planes,
    double support, double skin, double dt, __global const double4 *place,
    __global const double *position, __global const double *velocity,
    __global const double *reference, __global double4 *extremes)
{
    const int j = get_global_id(0);
    if (j >= count) return;
    int is_met = 0;
    const double3 middle = place[j].xyz, start = vload3(j, reference);
    const double3 last = vload3(j, position) + dt * vload3(j, velocity);
    for (int q = 0; q < few; q++) {
        const int i = fast[q];
        if (i == j) {
            for (int k = 0; k < plane_count; k++)
                is_met |= is_near_plane(middle, planes[k], support)
                    || is_near_plane(last, planes[k], support);
#ifdef RINGS
            is_met |= fabs(last.x - start.x) > WIDER * start.x;
#endif
        }
        const double3 from = vload3(i, reference) - start, near = place[i].xyz - middle;
        const double3 later = vload3(i, position) + dt * vload3(i, velocity) - last;
        const tuple_3r before = {from.x, from.y, from.z}, apart = {near.x, near.y, near.z};
        const tuple_3r apart_later = {later.x, later.y, later.z};
        is_met |= meets(apart, before, support, skin) || meets(apart_later, before, support, skin);
    }
    extremes[j] = (double4)(is_met, 0, 0, 0);
}
