"""Steps of a lattice: velocity Verlet, or its threefold composition, with baths and collisions."""

import math
from typing import Any

import numpy as np
from numba import njit

from quintet.components.particle_dynamics.kernels.forces import Pairs, damp_all_pairs, sum_forces
from quintet.components.particle_dynamics.kernels.generator import (
    direction,
    normal,
    pass_over,
    uniform,
)
from quintet.components.particle_dynamics.laws import (
    bath_factors,
    driven_places,
    driven_rates,
    half_turn,
    heat_gained,
    prescribed_motion,
    tether_force,
)
from quintet.components.particle_dynamics.state import (
    PULL_FIRST,
    PULL_SECOND,
    TIME,
    WORK,
    Bathed,
    Driven,
    Generator,
    Model,
    State,
)
from quintet.components.shared.numba_options import EXACT
from quintet.components.shared.search.verlet_list import furthest, slack
from quintet.interfaces.component import Array

DRAWN = 6  # random numbers of a bathed point in a step
EARLY = 0.6  # of the skin: distance at which lists are rebuilt; the rest covers the next step


@njit(**EXACT)
def constrain(driven: Driven, time: float, position: Array, velocity: Array) -> None:
    """Set the prescribed motion of the driven pair along its axis, at a time [s]."""
    i, j, k = driven.first, driven.second, driven.axis
    moved, speed, _ = prescribed_motion(driven, time)
    position[i, k], position[j, k] = driven_places(driven, moved, position[i, k], position[j, k])
    velocity[i, k], velocity[j, k] = driven_rates(driven, speed, velocity[i, k], velocity[j, k])


@njit(**EXACT)
def drive(model: Model, time: float, acceleration: Array, energies: Array) -> None:
    """Write the prescribed acceleration of the driven pair, and the forces [N] of the drive."""
    driven = model.driven
    i, j, k = driven.first, driven.second, driven.axis
    _, _, push = prescribed_motion(driven, time)
    first, second = acceleration[i, k], acceleration[j, k]
    acceleration[i, k], acceleration[j, k] = driven_rates(driven, push, first, second)
    energies[PULL_FIRST] = model.mass * (acceleration[i, k] - first)
    energies[PULL_SECOND] = model.mass * (acceleration[j, k] - second)


@njit(**EXACT)
def power_of_drive(driven: Driven, velocity: Array, energies: Array) -> float:
    """Power [W] of the forces on the driven pair; 0 without one."""
    if driven.first < 0:
        return 0.0
    first = energies[PULL_FIRST] * velocity[driven.first, driven.axis]
    return first + energies[PULL_SECOND] * velocity[driven.second, driven.axis]


@njit(**EXACT)
def exchange_with_baths(
    bathed: Bathed, mass: float, boltzmann: float, dt: float, state: State
) -> None:
    """Ornstein and Uhlenbeck's velocities after a step: the O of BAOAB (Leimkuhler & Matthews)."""
    velocity = state.velocity
    for b in range(bathed.point.shape[0]):
        pass_over(state.generator, DRAWN * bathed.passed[b])
        i, temperature = bathed.point[b], state.temperature[b]
        decay, width = bath_factors(bathed.rate[b], temperature, mass, boltzmann, dt)
        for k in range(3):
            before = velocity[i, k]
            velocity[i, k] = decay * before + width * normal(state.generator)
            state.heat[b] += heat_gained(mass, velocity[i, k], before)
    pass_over(state.generator, DRAWN * bathed.passed[-1])


@njit(**EXACT)
def collide(bonds: Array, expected: float, velocity: Array, generator: Generator) -> None:
    """Rotate the relative velocities of random pairs into random directions.

    `expected` is the mean number of pairs. Masses are equal, so that each pair keeps its momentum
    and energy.
    """
    waited = -math.log(uniform(generator))
    while waited < expected:
        b = int(uniform(generator) * bonds.shape[0])
        i, j = bonds[b, 0], bonds[b, 1]
        x = velocity[i, 0] - velocity[j, 0]
        y = velocity[i, 1] - velocity[j, 1]
        z = velocity[i, 2] - velocity[j, 2]
        x, y, z = half_turn((x, y, z), direction(generator))
        velocity[i, 0] += x
        velocity[i, 1] += y
        velocity[i, 2] += z
        velocity[j, 0] -= x
        velocity[j, 1] -= y
        velocity[j, 2] -= z
        waited -= math.log(uniform(generator))


@njit(**EXACT)
def accelerate(
    time: float, model: Model, state: State, velocity: Array, pairs: Pairs, law: Any, damping: Any,
    period: Any,
) -> None:  # fmt: skip
    """Write the accelerations at a time [s], for some velocities, and the powers with them."""
    position, acceleration, bathed = state.position, state.acceleration, model.bathed
    sum_forces(position, velocity, pairs, law, damping, period, acceleration, state.lost)
    if model.literal_damping > 0.0:
        damp_all_pairs(position, velocity, model.literal_damping, acceleration, state.lost)
    for b in range(bathed.point.shape[0]):
        i = bathed.point[b]
        for k in range(3):
            place, rest = position[i, k], bathed.rest[b, k]
            acceleration[i, k] -= tether_force(bathed.tether[b], place, rest)
    inverse = 1.0 / model.mass
    for i in range(acceleration.shape[0]):
        for k in range(3):
            acceleration[i, k] *= inverse
    for f in range(model.frozen.shape[0]):
        for k in range(3):
            acceleration[model.frozen[f], k] = 0.0
    if model.driven.first >= 0:
        drive(model, time, acceleration, state.energies)


@njit(**EXACT)
def begin(model: Model, state: State, pairs: Pairs, law: Any, damping: Any, period: Any) -> None:
    """Compute the accelerations at the start, after setting the driven pair."""
    time = state.energies[TIME]
    if model.driven.first >= 0:
        constrain(model.driven, time, state.position, state.velocity)
    accelerate(time, model, state, state.velocity, pairs, law, damping, period)


@njit(**EXACT)
def drift(dt: float, position: Array, velocity: Array) -> None:
    """Move points by their velocities."""
    for i in range(position.shape[0]):
        for k in range(3):
            position[i, k] += dt * velocity[i, k]


@njit(**EXACT)
def kick(dt: float, velocity: Array, acceleration: Array) -> None:
    """Change velocities by the accelerations."""
    for i in range(velocity.shape[0]):
        for k in range(3):
            velocity[i, k] += dt * acceleration[i, k]


@njit(**EXACT)
def average(dt: float, mass: float, velocity: Array, kinetic: Array) -> float:
    """Add kinetic energies times the step to their integrals; return the sum of squared speeds."""
    squares = 0.0
    for i in range(velocity.shape[0]):
        square = 0.0
        for k in range(3):
            square += velocity[i, k] * velocity[i, k]
        kinetic[i] += dt * 0.5 * mass * square
        squares += square
    return squares


@njit(**EXACT)
def add_work(h: float, model: Model, state: State, velocity: Array) -> None:
    """Add what pairs dissipate and the drive does in a time [s], at the present powers."""
    for i in range(state.lost.shape[0]):
        state.dissipated[i] += h * state.lost[i]
    state.energies[WORK] += h * power_of_drive(model.driven, velocity, state.energies)


@njit(**EXACT)
def open_stage(h: float, boltzmann: float, model: Model, state: State) -> None:
    """Kick and drift; up to the middle of the drift, where baths act, if anything is random."""
    add_work(0.5 * h, model, state, state.velocity)
    kick(0.5 * h, state.velocity, state.acceleration)
    if model.is_random:
        drift(0.5 * h, state.position, state.velocity)
        exchange_with_baths(model.bathed, model.mass, boltzmann, h, state)
    else:
        drift(h, state.position, state.velocity)


@njit(**EXACT)
def collide_once(h: float, model: Model, velocity: Array, generator: Generator) -> None:
    """Let nearest points collide as often as they do in a time [s]."""
    if model.collision_rate > 0.0:
        expected = model.collision_rate * h * model.bonds.shape[0]
        collide(model.bonds, expected, velocity, generator)


@njit(**EXACT)
def place(h: float, model: Model, state: State, predicted: Array, is_damped: bool) -> None:
    """Bring points to where forces are computed, and predict the velocities that are damped."""
    position, velocity = state.position, state.velocity
    if model.is_random:
        drift(0.5 * h, position, velocity)
    state.energies[TIME] += h
    if is_damped:
        # Damping takes the velocity at the step's end, to the accuracy of the step.
        predicted[:] = velocity
        kick(0.5 * h, predicted, state.acceleration)
    if model.driven.first >= 0:
        constrain(model.driven, state.energies[TIME], position, predicted)
        constrain(model.driven, state.energies[TIME], position, velocity)


@njit(**EXACT)
def close_stage(
    h: float, model: Model, state: State, predicted: Array, pairs: Pairs, law: Any, damping: Any,
    period: Any,
) -> None:  # fmt: skip
    """Compute the forces and kick."""
    position, velocity, time = state.position, state.velocity, state.energies[TIME]
    accelerate(time, model, state, predicted, pairs, law, damping, period)
    kick(0.5 * h, velocity, state.acceleration)
    if model.driven.first >= 0:
        constrain(model.driven, time, position, velocity)
    add_work(0.5 * h, model, state, velocity)


@njit(**EXACT)
def advance(
    steps: int, dt: float, skin: float, averaged_from: float, boltzmann: float, model: Model,
    state: State, pairs: Pairs, law: Any, damping: Any, period: Any,
) -> int:  # fmt: skip
    """Advance until all steps are done or the neighbour lists must be rebuilt.

    Parameters
    ----------
    steps : int
    dt : float, s
    skin : float, m
        Distance that two points may move together before an unlisted pair can interact.
    averaged_from : float, s
        From when kinetic energies are averaged.
    boltzmann : float, J/K
    model, state, pairs, law, damping, period
        As in `accelerate`; the state is advanced.

    Returns
    -------
    int
        Number of steps done; -1 if points moved further in a step than the lists allow, or if
        velocities are not finite.
    """
    is_damped = damping is not None or model.literal_damping > 0.0
    predicted = np.empty_like(state.velocity) if is_damped else state.velocity
    for step in range(steps):
        for s in range(model.stages.shape[0]):
            h = model.stages[s] * dt
            open_stage(h, boltzmann, model, state)
            collide_once(h, model, state.velocity, state.generator)
            place(h, model, state, predicted, is_damped)
            close_stage(h, model, state, predicted, pairs, law, damping, period)
        weight = dt if state.energies[TIME] > averaged_from else 0.0
        squares = average(weight, model.mass, state.velocity, state.kinetic)
        moved = furthest(state.position, state.listed)
        if not (math.isfinite(squares) and slack(skin, moved) > 0.0):
            return -1
        if slack(EARLY * skin, moved) < 0.0:
            return step + 1
    return steps
