/* Contacts of pairs: kernels/ball_contacts.py. LANES pairs are computed at once.

   A pair has WIDTH vectors of constants, by its row of them: those of laws.py:pair_constants, then
   the arm and the inverse inertia of its resistance against rolling. Its history stands number by
   number, STRIDE numbers apart. Pairs reduce extremes alone: rows add up what pairs store. */

#if LANES == 4
#define EACH(a, part) ((reals)((a##0).part, (a##1).part, (a##2).part, (a##3).part))
#define READ(array, number) vload4(0, (array) + (number) * (size_t)stride + first)
#define WRITE(value, array, number) vstore4(value, 0, (array) + (number) * (size_t)stride + first)
#define FOR_LANES(act) act(0, x) act(1, y) act(2, z) act(3, w)
#define PART(a, lane) a.lane
#define IS_ANY(truths) any(truths)
#define GREATEST_OF(a) max_real(max_real(a.x, a.y), max_real(a.z, a.w))
#elif LANES == 1
#define EACH(a, part) (a##0).part
#define READ(array, number) (array)[(number) * (size_t)stride + first]
#define WRITE(value, array, number) (array)[(number) * (size_t)stride + first] = value
#define FOR_LANES(act) act(0, x)
#define PART(a, lane) a
#define IS_ANY(truths) (truths)
#define GREATEST_OF(a) a
#else
#error "LANES must be 1 or 4"
#endif

#define THREE(a, x, b, y, c, z) {EACH(a, x), EACH(b, y), EACH(c, z)}
#define OVER(a, x, b, y, c, z) \
    {EACH(i##a, x) - EACH(j##a, x), EACH(i##b, y) - EACH(j##b, y), EACH(i##c, z) - EACH(j##c, z)}

/* From a ball's partner to it: another ball, or a plane of a number from 0 on. */
static double4 apart(double4 at, double4 other, int number, __global const double4 *plane)
{
    if (number < 0) return at - other;
    const tuple_3r x = VECTOR(at), n = VECTOR(plane[number]);
    const tuple_3r d = from_plane(x, at.w, n, plane[number].w);
    return (double4)(d.f0, d.f1, d.f2, 0);
}

/* Motion of both rows of a lane's pair, and its constants. Lanes past the end repeat the last
   pair. */
#define READ_PAIR(lane, part) \
    const int k##lane = min(first + lane, count - 1), b##lane = partner[k##lane]; \
    const int p##lane = 4 * row[k##lane], q##lane = 4 * min(b##lane, rows - 1); \
    const double4 ia##lane = motion[p##lane], ib##lane = motion[p##lane + 1], \
        ic##lane = motion[p##lane + 2], id##lane = motion[p##lane + 3], \
        ja##lane = motion[q##lane], jb##lane = motion[q##lane + 1], \
        jc##lane = motion[q##lane + 2], jd##lane = motion[q##lane + 3], \
        d##lane = apart(ia##lane, ja##lane, b##lane - rows, plane); \
    const int m##lane = WIDTH * constants_row[k##lane]; \
    const double4 ca##lane = constants[m##lane], cb##lane = constants[m##lane + 1];

#define WRITE_PUSH(lane, part) \
    push[2 * (first + lane)] = (double4)( \
        PART(acting.f0.f0, part), PART(acting.f0.f1, part), PART(acting.f0.f2, part), \
        PART(contact.f1, part)); \
    push[2 * (first + lane) + 1] = (double4)( \
        PART(force_cross_normal.f0, part), PART(force_cross_normal.f1, part), \
        PART(force_cross_normal.f2, part), PART(acting.f2, part));

#define WEIGH(lane, part) \
    PART(weight, part) = damping_weight( \
        PART(before, part), PART(contact.f1, part), PART(closing, part), dt);

/* Force and torques of each pair, its energy, and its history. */
__kernel void touch(
    double dt, int count, int stride, int rows, __global const int *row,
    __global const int *partner, __global const int *constants_row,
    __global const double4 *constants, __global const double4 *plane,
    __global const double4 *motion, __global double *history, __global double4 *push,
    __global double *part)
{
    ROOM(PAIR_COLUMNS);
    const int first = LANES * get_global_id(0);
    double overlap = -FAR, relative = 0, stiffness = 0;
    if (first < count) {
        FOR_LANES(READ_PAIR)
        const reals radius = EACH(ia, w), radii = radius + EACH(ja, w), other = radii - radius;
        const tuple_3v r = THREE(d, x, d, y, d, z);
        const tuple_3v v = OVER(b, x, b, y, b, z), end_v = OVER(c, z, c, w, d, x);
        const tuple_3v omega_i = THREE(ib, w, ic, x, ic, y), omega_j = THREE(jb, w, jc, x, jc, y);
        const tuple_3v end_i = THREE(id, y, id, z, id, w), end_j = THREE(jd, y, jd, z, jd, w);
        const Kinematics contact =
            kinematics(r, radii, radius, v, end_v, omega_i, omega_j, end_i, end_j);
        const reals before = READ(history, 3), closing = -inner_of_lanes(contact.f4, contact.f0);
        const mask is_touching = contact.f1 > (reals)0;
        reals weight = 1;
        if (IS_ANY((before == (reals)0) & is_touching)) { FOR_LANES(WEIGH) }
        const tuple_7v c = {
            EACH(ca, x), EACH(ca, y), EACH(ca, z), EACH(ca, w), EACH(cb, x), EACH(cb, y),
            EACH(cb, z)};
        const tuple_3v spring = {READ(history, 0), READ(history, 1), READ(history, 2)};
        const tuple_3v roots = {
            contact.f2, sqrt(contact.f2), 1 / max_reals(contact.f2, (reals)LEAST)};
        const Acting acting = contact_force(
            c, spring, before, contact.f0, max_reals(contact.f1, (reals)0), roots, weight,
            contact.f3, contact.f4, dt);
        const tuple_3v force_cross_normal = cross_of_lanes(acting.f0, contact.f0);
        WRITE(acting.f1.f0, history, 0);
        WRITE(acting.f1.f1, history, 1);
        WRITE(acting.f1.f2, history, 2);
        const reals inverse = is_touching ? roots.f2 : (reals)0;
        WRITE(inverse, history, 3);
        FOR_LANES(WRITE_PUSH)
        const reals part_of_radius = relative_depth(contact.f1, radius, other);
        const reals stiff = c.f5 * contact.f2;
        overlap = GREATEST_OF(contact.f1);
        relative = max_real(0, GREATEST_OF(part_of_radius));
        stiffness = max_real(0, GREATEST_OF(stiff));
    }
    STORE(OVERLAP, overlap);
    STORE(RELATIVE, relative);
    STORE(STIFFNESS, stiffness);
    barrier(CLK_LOCAL_MEM_FENCE);
    tally(room, PAIR_SUMS, PAIR_COLUMNS, part);
}
