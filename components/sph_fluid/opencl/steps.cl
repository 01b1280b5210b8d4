/* Steps of rows in double precision: see integration/kernels.py. Laws and structs are printed.

   Fluid rows write into `extremes` the square of how far they went since lists were made, and of
   their speed where the scheme needs it; infinity where a step failed. */

static double4 as_doubles(RATE4 rate) { return (double4)(rate.x, rate.y, rate.z, rate.w); }

/* Write the density of a row, and p/rho^2; that of walls and samples is at least that at rest. */
static void write_density(
    int i, int split, double density, Constants constants, __global double4 *position,
    __global double4 *velocity)
{
    if (i >= split) density = max_real(density, constants.density);
    position[i].w = density;
    velocity[i].w = pressure_term(density, constants);
}

/* Advance rows by a step, with one pass over pairs. */
__kernel void advance(
    int split, int count, double dt, double ahead, double furthest, Constants constants,
    __global double4 *position, __global double4 *velocity, __global const RATE4 *rates,
    __global double *previous, __global const double *reference, __global double4 *extremes)
{
    const int i = get_global_id(0);
    if (i >= count) return;
    const double4 rate = as_doubles(rates[i]);
    const double density_rate = rate.w + ahead * (rate.w - previous[i]);
    const double density = position[i].w + dt * density_rate;
    previous[i] = rate.w;
    if (i < split) {
        const double3 way = dt * (velocity[i].xyz + 0.5 * dt * rate.xyz);
        position[i].xyz += way;
        velocity[i].xyz += dt * rate.xyz;
        extremes[i].z = square_of(position[i].xyz - vload3(i, reference));
        extremes[i].w = failed(density, square_of(way), furthest) ? INFINITY : 0;
    }
    write_density(i, split, density, constants, position, velocity);
}

/* Begin position Verlet with the rates of the state as it is. */
__kernel void begin(
    int split, int count, __global const RATE4 *rates, __global double *previous,
    __global double *acceleration)
{
    const int i = get_global_id(0);
    if (i >= count) return;
    const double4 rate = as_doubles(rates[i]);
    previous[i] = rate.w;
    if (i < split) vstore3(rate.xyz, i, acceleration);
}

/* Bring rows to the middle of the step. */
__kernel void half_step(
    int split, int count, double dt, Constants constants, __global double4 *position,
    __global double4 *velocity, __global const double *previous,
    __global const double *acceleration)
{
    const int i = get_global_id(0);
    if (i >= count) return;
    const double density = position[i].w + 0.5 * dt * previous[i];
    if (i < split) {
        position[i].xyz += 0.5 * dt * velocity[i].xyz;
        velocity[i].xyz += 0.5 * dt * vload3(i, acceleration);
    }
    write_density(i, split, density, constants, position, velocity);
}

/* Bring velocity and position of the fluid to the end of the step. */
__kernel void kick(
    int split, double dt, __global double4 *position, __global double4 *velocity,
    __global const RATE4 *rates, __global const double *acceleration)
{
    const int i = get_global_id(0);
    if (i >= split) return;
    velocity[i].xyz += dt * (as_doubles(rates[i]).xyz - 0.5 * vload3(i, acceleration));
    position[i].xyz += 0.5 * dt * velocity[i].xyz;
}

/* Bring density to the end of the step. */
__kernel void finish(
    int split, int count, double dt, double furthest, Constants constants,
    __global double4 *position, __global double4 *velocity, __global const RATE4 *rates,
    __global double *previous, __global double *acceleration, __global const double *reference,
    __global double4 *extremes)
{
    const int i = get_global_id(0);
    if (i >= count) return;
    const double4 rate = as_doubles(rates[i]);
    const double density = position[i].w + 0.5 * dt * rate.w;
    previous[i] = rate.w;
    if (i < split) {
        vstore3(rate.xyz, i, acceleration);
        const double speed2 = square_of(velocity[i].xyz);
        extremes[i].z = square_of(position[i].xyz - vload3(i, reference));
        extremes[i].w = failed(density, dt * dt * speed2, furthest) ? INFINITY : speed2;
    }
    write_density(i, split, density, constants, position, velocity);
}
