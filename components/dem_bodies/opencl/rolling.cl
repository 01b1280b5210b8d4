/* Resistance against rolling of pairs that touch: kernels/rolling_resistance.py. */

/* Moment of each pair on its first ball with its energy, and the elastic part of it. */
__kernel void roll(
    double dt, int count, int stride, int rows, __global const int *row,
    __global const int *partner, __global const int *constants_row,
    __global const double4 *constants, __global const double4 *plane,
    __global const double4 *motion, __global const double *history, __global const double4 *push,
    __global double4 *spring, __global double4 *moment)
{
    const int k = get_global_id(0);
    if (k < count) {
        const double inverse_root = history[3 * (size_t)stride + k];
        const int m = WIDTH * constants_row[k];
        const double arm = constants[m + 1].w;
        moment[k] = 0;
        if (inverse_root == 0) {
            spring[k] = 0;
        } else if (arm != 0) {
            const int b = partner[k], i = 4 * row[k], j = 4 * min(b, rows - 1);
            const double4 d = b < rows ? motion[i] - motion[j] : plane[b - rows];
            const double per_length =
                b < rows ? 1 / sqrt(d.x * d.x + d.y * d.y + d.z * d.z) : 1;
            const double4 ib = motion[i + 1], ic = motion[i + 2], id = motion[i + 3];
            const double4 jb = motion[j + 1], jc = motion[j + 2], jd = motion[j + 3];
            const tuple_3r normal = VECTOR(per_length * d), elastic = VECTOR(spring[k]);
            const tuple_3r force = VECTOR(push[2 * k]);
            const tuple_3r mean = {ib.w - jb.w, ic.x - jc.x, ic.y - jc.y};
            const tuple_3r end = {id.y - jd.y, id.z - jd.z, id.w - jd.w};
            const Resisting r = resistance(
                elastic, normal, constants[m].x, inverse_root, arm, constants[m + 2].x, force, mean,
                end, dt);
            moment[k] = (double4)(r.f0.f0, r.f0.f1, r.f0.f2, r.f2);
            spring[k] = (double4)(r.f1.f0, r.f1.f1, r.f1.f2, 0);
        }
    }
}
