/* Motion over a step: velocity Verlet, with places and velocities in its middle. See
   kernels/motion.py and glue.py. */

/* Whether a particle hangs on a partner's mesh. */
static int is_attached(long glue, __global const double *active)
{
    return glue >= 0 && active[glue] > 0;
}

/* Bring velocities and places to the middle of a step; attached particles have the mesh's. Write
   how far all will be at its end from where they were listed, and minus that. */
__kernel void kick(
    int count, double dt, __global const long *glue, __global const double *active,
    __global const double *pulled, __global const double *position, __global double *velocity,
    __global double *acceleration, __global const double *failed, __global const double *volume,
    __global const double *reference, __global double4 *place, __global double4 *motion,
    __global double4 *most, __global double4 *least)
{
    const int i = get_global_id(0);
    if (i >= count) return;
    double3 u = vload3(i, velocity), a = vload3(i, acceleration);
    if (is_attached(glue[i], active)) {
        u = vload3(glue[i], pulled);
        a = 0;
        vstore3(a, i, acceleration);
    }
    u += 0.5 * dt * a;
    vstore3(u, i, velocity);
    const double3 at = vload3(i, position);
    motion[i] = (double4)(u, failed[i]);
    place[i] = (double4)(at + 0.5 * dt * u, volume[i]);
    const double3 moved = at + dt * u - vload3(i, reference);
    most[i] = (double4)(moved, 0);
    least[i] = (double4)(-moved, 0);
}

/* Hold what is fixed, and write forces on glued particles, without gravity. Bring velocities to
   the step's end, and energies half a step on; count what is not finite in `extremes`.

   REFERENCE is defined where neighbours are those of the start: `forced` are then accelerations by
   stresses, and `heats` those by the forces that heat, whose heating was computed with velocities
   that the old acceleration predicted. */
__kernel void finish(
    int count, double dt, double4 gravity, __global const Solid *laws,
    __global const long *material, __global const double *volume, __global const long *fixed,
    __global const long *glue, __global const double *active, __global double *force,
    __global double *velocity, __global double *acceleration, __global double *heating,
    __global double *energy, __global double4 *extremes
#ifdef REFERENCE
    , __global const double *forced, __global const double *heats
#endif
)
{
    const int i = get_global_id(0);
    if (i >= count) return;
    const double3 moves =
        (double3)(!(fixed[i] & 1), !(fixed[i] & 2), !(fixed[i] & 4));
#ifdef REFERENCE
    const double3 heat = vload3(i, heats), before = vload3(i, acceleration);
    double3 a = moves * (vload3(i, forced) + heat);
#else
    double3 a = moves * vload3(i, acceleration);
#endif
    if (glue[i] >= 0) {
        const double mass = volume[i] * laws[material[i]].density;
        vstore3(active[glue[i]] * (mass * a), glue[i], force);
    }
    a = is_attached(glue[i], active) ? 0 : moves * (a + gravity.xyz);
    vstore3(a, i, acceleration);
#ifdef REFERENCE
    const double3 product = heat * (a - before);
    heating[i] -= 0.5 * dt * (product.x + product.y + product.z);
#endif
    energy[i] += 0.5 * dt * heating[i];
    const double3 u = vload3(i, velocity) + 0.5 * dt * a;
    vstore3(u, i, velocity);
    extremes[i].y = !isfinite(u.x * u.x + u.y * u.y + u.z * u.z);
}
