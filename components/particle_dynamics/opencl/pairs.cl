/* Forces summed over pairs; laws and structs are printed. See kernels/forces.py.

   DAMPED is defined where pairs are damped, PERIODIC where sides repeat. LANES neighbours are
   computed at a time; their forces are added one after another, in the order of the list. Where a
   list ends before its last lanes do, these have the point itself, moved out of reach. */

#if LANES == 4
typedef int4 numbers;
#define LANE(array, axis) \
    ((reals)(array[j.x].axis, array[j.y].axis, array[j.z].axis, array[j.w].axis))
#define ADD_LANES(sum, x_, y_, z_, w_) \
    sum += (double4)(x_.x, y_.x, z_.x, w_.x), sum += (double4)(x_.y, y_.y, z_.y, w_.y), \
    sum += (double4)(x_.z, y_.z, z_.z, w_.z), sum += (double4)(x_.w, y_.w, z_.w, w_.w)
#elif LANES == 1
typedef int numbers;
#define LANE(array, axis) array[j].axis
#define ADD_LANES(sum, x, y, z, w) sum += (double4)(x, y, z, w)
#else
#error "LANES must be 1 or 4"
#endif

#ifdef PERIODIC
#define IMAGE(x, number) nearest_image(x, terms.side.number, terms.per_side.number)
#else
#define IMAGE(x, number) (x)
#endif

/* Add the forces of neighbours j of a point at r, and the power that they dissipate; `beyond` is
   what is added to the distances along x. */
static double4 add_lanes(
    double4 sum, numbers j, reals beyond, double4 r, double4 u, __global const double4 *position,
    __global const double4 *velocity, PairTerms terms)
{
    reals dx = IMAGE(r.x - LANE(position, x), f0) + beyond;
    reals dy = IMAGE(r.y - LANE(position, y), f1), dz = IMAGE(r.z - LANE(position, z), f2);
    const reals square = dx * dx + dy * dy + dz * dz;
    reals force = -force_over_distance(terms.law, square), power = 0;
#ifdef DAMPED
    const reals opening = (u.x - LANE(velocity, x)) * dx + (u.y - LANE(velocity, y)) * dy
        + (u.z - LANE(velocity, z)) * dz;
    const reals weight = weight_of_damping(terms.damping, sqrt(square));
    const reals push = damping_over_distance(weight, opening, square);
    power = opening * push;
    force -= push;
#endif
    dx *= force, dy *= force, dz *= force;
    ADD_LANES(sum, dx, dy, dz, power);
    return sum;
}

/* Add the forces of neighbours `k` to `stop` of the list of point i, which begins at `near`. */
static double4 add_forces(
    double4 sum, int i, int k, int stop, __global const int *near, long item_stride, double4 r,
    double4 u, __global const double4 *position, __global const double4 *velocity, PairTerms terms)
{
#if LANES == 4
    for (; k + 4 <= stop; k += 4) {
        const int4 j = (int4)(
            near[item_stride * k], near[item_stride * (k + 1)], near[item_stride * (k + 2)],
            near[item_stride * (k + 3)]);
        sum = add_lanes(sum, j, 0, r, u, position, velocity, terms);
    }
    if (k < stop) {
        const int second = k + 1 < stop, third = k + 2 < stop;
        const double far = terms.far;
        const int4 j = (int4)(
            near[item_stride * k], second ? near[item_stride * (k + 1)] : i,
            third ? near[item_stride * (k + 2)] : i, i);
        const reals beyond = (reals)(0, second ? 0 : far, third ? 0 : far, far);
        sum = add_lanes(sum, j, beyond, r, u, position, velocity, terms);
    }
#else
    for (; k < stop; k++)
        sum = add_lanes(sum, near[item_stride * k], 0, r, u, position, velocity, terms);
#endif
    return sum;
}

/* Add damping of point i by all others, at whatever distance; the power is that with later ones. */
static double4 damp_by_all(
    double4 sum, int i, int count, double coefficient, __global const double4 *position,
    __global const double4 *velocity)
{
    const double4 r = position[i], u = velocity[i];
    sum.w = 0;
    for (int j = 0; j < count; j++) {
        if (j == i) continue;
        const double4 d = r - position[j], v = u - velocity[j];
        const double opening = v.x * d.x + v.y * d.y + v.z * d.z;
        const double push =
            damping_of_all(coefficient, opening, d.x * d.x + d.y * d.y + d.z * d.z);
        sum.xyz -= push * d.xyz;
        if (j > i) sum.w += push * opening;
    }
    return sum;
}
