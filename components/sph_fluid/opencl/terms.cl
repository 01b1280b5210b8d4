/* Terms that scenes may add, in double precision: damper of sound, Shepard filter, XSPH. Laws and
   structs are printed; see pairs/kernels.py. */

/* Write p/rho^2 of rows with the damper's part. */
__kernel void damp_pressure(
    int count, double strength, __global const double *minus_rho_div_u,
    __global const double4 *position, __global double4 *velocity, Constants constants)
{
    const int i = get_global_id(0);
    if (i >= count) return;
    velocity[i].w =
        damped_pressure_term(position[i].w, minus_rho_div_u[i], strength, constants);
}

/* Add the damper's mean part around their mirror points to p/rho^2 of walls and samples; samples
   under the contact potential have stiffness in its place. */
__kernel void mirror_damping(
    int split, int count, __global const double *mirror, __global const long *sample,
    __global const double4 *position,
    __global double4 *velocity, __global const int *near, __global const int *end,
    long row_stride, long item_stride, Constants constants)
{
    const int b = get_global_id(0), i = split + b;
    if (i >= count || sample[b] == BY_POTENTIAL) return;
    const double3 at = vload3(b, mirror);
    double weights = 0, sum = 0;
    for (int k = 0; k < end[i]; k++) {
        const int j = near[(size_t)i * row_stride + item_stride * k];
        const double4 r = position[j];
        const double weight =
            kernel_of(square_of(r.xyz - at), constants.smoothing) * constants.mass / r.w;
        weights += weight;
        sum += weight * (velocity[j].w - pressure_term(r.w, constants));
    }
    if (weights >= NO_FLUID) velocity[i].w = max_real(velocity[i].w + sum / weights, 0.0);
}

/* Filtered densities of the fluid. */
__kernel void filter_density(
    int split, __global const double4 *position, __global const int *near,
    __global const int *middle, long row_stride, long item_stride, Constants constants,
    __global double *density)
{
    const int i = get_global_id(0);
    if (i >= split) return;
    const double4 at = position[i];
    double weights = 0, volumes = 0;
    for (int k = 0; k < middle[i]; k++) {
        const double4 r = position[near[(size_t)i * row_stride + item_stride * k]];
        const double weight = kernel_of(square_of(at.xyz - r.xyz), constants.smoothing);
        weights += weight;
        volumes += weight / r.w;
    }
    density[i] = weights / volumes;
}

/* Densities that were filtered, and their pressures; rows of buffers keep theirs. */
__kernel void take_density(
    int split, __global const double *density, __global const long *role,
    __global double4 *position, __global double4 *velocity, Constants constants)
{
    const int i = get_global_id(0);
    if (i >= split) return;
    if (!role || role[i] == 0) position[i].w = density[i];
    velocity[i].w = pressure_term(position[i].w, constants);
}

/* Move the fluid with velocities for a time. */
__kernel void move_by(
    int split, double time, __global const double *drift, __global double4 *position)
{
    const int i = get_global_id(0);
    if (i < split) position[i].xyz += time * vload3(i, drift);
}
