/* Motion of balls: kernels/velocity_verlet.py. A row of motion has four vectors of four numbers:

   position, radius | velocity, omega x | omega y z, end velocity x y | end velocity z, end omega

   Loads and loads of contacts are six numbers of each row. Printed laws take them as tuples, named
   `force_of_load` where the vector is `load_force`. */

#define VECTOR(a) {(a).x, (a).y, (a).z}
#define OMEGA(row, next) {(row).w, (next).x, (next).y}

/* Half kick, drift, and how far balls are from where they were listed. */
__kernel void drift(
    double dt, int loaded, int balls, double4 gravity, __global const double2 *inverse,
    __global const double *contact, __global const double *load, __global const double *listed,
    __global double4 *motion, __global double4 *orientation, __global double *part)
{
    ROOM(DRIFT_COLUMNS);
    const int i = get_global_id(0);
    double work = 0, load_work = 0, travel = 0, is_broken = 0;
    if (i < balls) {
        const double half_dt = 0.5 * dt;
        const double4 at = motion[4 * i], moving = motion[4 * i + 1], turning = motion[4 * i + 2];
        const double3 force = vload3(2 * i, contact), torque = vload3(2 * i + 1, contact);
        const double3 load_force = loaded ? vload3(2 * i, load) : 0;
        const double3 load_torque = loaded ? vload3(2 * i + 1, load) : 0;
        const double4 q = orientation[i];
        const tuple_3r x = VECTOR(at), v = VECTOR(moving), omega = OMEGA(moving, turning);
        const tuple_3r weight = VECTOR(half_dt * gravity);
        const tuple_3r force_of_contacts = VECTOR(force), torque_of_contacts = VECTOR(torque);
        const tuple_3r force_of_load = VECTOR(load_force), torque_of_load = VECTOR(load_torque);
        const tuple_4r pose = {q.x, q.y, q.z, q.w};
        const Kicked k = half_kick(
            v, omega, weight, half_dt, inverse[i].x, inverse[i].y, force_of_contacts,
            torque_of_contacts, force_of_load, torque_of_load);
        const Drifted d = drifted(x, pose, k.f0, k.f2, omega, k.f1, dt);
        motion[4 * i] = (double4)(d.f0.f0, d.f0.f1, d.f0.f2, at.w);
        motion[4 * i + 1] = (double4)(k.f0.f0, k.f0.f1, k.f0.f2, k.f1.f0);
        motion[4 * i + 2] = (double4)(k.f1.f1, k.f1.f2, d.f2.f0, d.f2.f1);
        motion[4 * i + 3] = (double4)(d.f2.f2, d.f3.f0, d.f3.f1, d.f3.f2);
        orientation[i] = (double4)(d.f1.f0, d.f1.f1, d.f1.f2, d.f1.f3);
        const double3 moved = (double3)(d.f0.f0, d.f0.f1, d.f0.f2) - vload3(i, listed);
        work = k.f3;
        load_work = k.f4;
        travel = moved.x * moved.x + moved.y * moved.y + moved.z * moved.z;
        is_broken = !isfinite(d.f1.f0 + d.f1.f1 + d.f1.f2 + d.f1.f3);
    }
    STORE(WORK, work);
    STORE(LOAD_WORK, load_work);
    STORE(TRAVEL, travel);
    STORE(BROKEN, is_broken);
    barrier(CLK_LOCAL_MEM_FENCE);
    tally(room, DRIFT_SUMS, DRIFT_COLUMNS, part);
}

/* Add up the loads of all pairs of a row: those that it lists, then those that list it, in the
   order of the pairs. Half kick with these loads. A pair has its force and depth in `push`, and
   behind them force times normal, which gives the torques with the arms of both balls, and its
   energy; its moment against rolling, and the energy of that, are in `moment`. */
__kernel void kick(
    double dt, int loaded, int balls, int rows, double4 gravity, __global const double2 *inverse,
    __global const double *load, __global const int *begin, __global const int *partner,
    __global const int *incoming_begin, __global const int *incoming,
    __global const double4 *push, __global const double4 *moment, __global double4 *motion,
    __global double *contact, __global double *part)
{
    ROOM(KICK_COLUMNS);
    const int i = get_global_id(0);
    double sums[KICK_COLUMNS] = {0};
    if (i < balls) {
        const double4 at = motion[4 * i], moving = motion[4 * i + 1];
        double4 turning = motion[4 * i + 2];
        double3 force = 0, torque = 0;
        for (int k = begin[i]; k < begin[i + 1]; k++) {
            const double4 f = push[2 * k];
            if (f.w <= 0) continue;
            const double4 turn = push[2 * k + 1];
            double3 by_pair = (at.w - 0.5 * f.w) * turn.xyz;
            sums[ENERGY] += turn.w;
#ifdef ROLLS
            by_pair += moment[k].xyz;
            sums[ENERGY] += moment[k].w;
#endif
            force += f.xyz;
            torque += by_pair;
            sums[CONTACTS] += 1;
            if (partner[k] < rows) continue;
            const tuple_3r acting = VECTOR(f), position = VECTOR(at);
            const tuple_3r about_origin = cross_of(acting, position);
            sums[GROUND] -= f.x;
            sums[GROUND + 1] -= f.y;
            sums[GROUND + 2] -= f.z;
            sums[GROUND + 3] += about_origin.f0 - by_pair.x;
            sums[GROUND + 4] += about_origin.f1 - by_pair.y;
            sums[GROUND + 5] += about_origin.f2 - by_pair.z;
        }
        for (int slot = incoming_begin[i]; slot < incoming_begin[i + 1]; slot++) {
            const int k = incoming[slot];
            const double4 f = push[2 * k];
            if (f.w <= 0) continue;
            force -= f.xyz;
            torque += (at.w - 0.5 * f.w) * push[2 * k + 1].xyz;
#ifdef ROLLS
            torque -= moment[k].xyz;
#endif
            sums[CONTACTS] += 1;
        }
        vstore3(force, 2 * i, contact);
        vstore3(torque, 2 * i + 1, contact);
        const double half_dt = 0.5 * dt;
        const double3 load_force = loaded ? vload3(2 * i, load) : 0;
        const double3 load_torque = loaded ? vload3(2 * i + 1, load) : 0;
        const tuple_3r v = VECTOR(moving), omega = OMEGA(moving, turning);
        const tuple_3r weight = VECTOR(half_dt * gravity);
        const tuple_3r force_of_contacts = VECTOR(force), torque_of_contacts = VECTOR(torque);
        const tuple_3r force_of_load = VECTOR(load_force), torque_of_load = VECTOR(load_torque);
        const Kicked k = half_kick(
            v, omega, weight, half_dt, inverse[i].x, inverse[i].y, force_of_contacts,
            torque_of_contacts, force_of_load, torque_of_load);
        motion[4 * i + 1] = (double4)(k.f0.f0, k.f0.f1, k.f0.f2, k.f1.f0);
        turning.x = k.f1.f1;
        turning.y = k.f1.f2;
        motion[4 * i + 2] = turning;
        sums[WORK] = k.f3;
        sums[LOAD_WORK] = k.f4;
        const double omega2 = inner(k.f1, k.f1);
        sums[VELOCITY2] = inner(k.f0, k.f0);
        sums[ROTATION2] = at.w * at.w * omega2;
        sums[CENTRIPETAL] = at.w * omega2;
        if (loaded) {
            const double3 pull = inverse[i].x * load_force + gravity.xyz;
            const double3 up = inverse[i].y * load_torque;
            sums[ACCELERATION2] = pull.x * pull.x + pull.y * pull.y + pull.z * pull.z;
            sums[SPIN_UP2] = at.w * at.w * (up.x * up.x + up.y * up.y + up.z * up.z);
        }
    }
    for (int c = 0; c < KICK_COLUMNS; c++) STORE(c, sums[c]);
    barrier(CLK_LOCAL_MEM_FENCE);
    tally(room, KICK_SUMS, KICK_COLUMNS, part);
}

/* Motion as ports have it, in the order of the bodies: positions, velocities, orientations and
   angular velocities one after another. */
__kernel void pack_motion(
    int balls, __global const long *body, __global const double4 *motion,
    __global const double4 *orientation, __global double *packed)
{
    const int i = get_global_id(0);
    if (i >= balls) return;
    const size_t b = body[i], count = balls;
    const double4 moving = motion[4 * i + 1], turning = motion[4 * i + 2];
    vstore3(motion[4 * i].xyz, b, packed);
    vstore3(moving.xyz, b, packed + 3 * count);
    vstore4(orientation[i], b, packed + 6 * count);
    vstore3((double3)(moving.w, turning.x, turning.y), b, packed + 10 * count);
}
