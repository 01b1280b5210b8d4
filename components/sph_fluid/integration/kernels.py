"""Loops that advance rows of a state in time; those of one scheme are compiled alone."""

import math
from typing import NamedTuple

from numba import njit

from quintet.components.shared.numba_options import EXACT
from quintet.components.sph_fluid.laws import Constants, pressure_term
from quintet.components.sph_fluid.state import Array, State


class Rows(NamedTuple):
    """Rows of a state as kernels advance them."""

    position: Array  # (n, 4) m, m, m, kg/m3: x, y, z, ρ
    velocity: Array  # (n, 4) m/s, m/s, m/s, Pa m6/kg2: u, v, w, p/ρ²
    rate: Array  # (n, 4) m/s2, m/s2, m/s2, kg/(m3 s), of the last pass over pairs
    previous_density_rate: Array  # (n,) kg/(m3 s)
    acceleration: Array  # (fluid, 3) m/s2, at the last step's end; (0, 3) if it is not wanted
    reference: Array  # (n, 3) m, where the neighbour lists were made

    @classmethod
    def of(cls, state: State, rate: Array) -> "Rows":
        """Rows of a state, and their rates (n, 4)."""
        return cls(
            state.position_density, state.velocity_pressure, rate, state.previous_density_rate,
            state.acceleration, state.reference,
        )  # fmt: skip


@njit(inline="always")
def shift2(i, position, reference):  # type: ignore[no-untyped-def]
    """Square of how far [m] a row is from where the lists were made."""
    sum2 = 0.0
    for d in range(3):
        sum2 += (position[i, d] - reference[i, d]) ** 2
    return sum2


@njit(inline="always")
def failed(density, way2, furthest):  # type: ignore[no-untyped-def]
    """1 if a density [kg/m3] or the square of a way [m2] is out of bounds or not finite."""
    return int(not (way2 <= furthest * furthest and 0.0 < density < math.inf))


@njit(inline="always")
def write_density(i, density, constants: Constants, position, velocity):  # type: ignore[no-untyped-def]
    """Write the density of a row, and p/ρ²."""
    position[i, 3] = density
    velocity[i, 3] = pressure_term(density, constants)


@njit(**EXACT)
def advance(
    first: int, last: int, split: int, dt: float, ahead: float, furthest: float,
    constants: Constants, rows: Rows,
) -> tuple[float, int]:  # fmt: skip
    """Advance rows by a step.

    Parameters
    ----------
    first, last : int
        Rows to advance, of which the first `split` of all are fluid.
    dt : float, s
    ahead : float, 1
        Steps from the last rate of density to the one that is taken.
    furthest : float, m
        That a particle may move.
    constants, rows

    Returns
    -------
    float, int
        Greatest shift² [m2] since the lists were made; failures.
    """
    position, velocity, rate, previous, _, reference = rows
    moved, failures = 0.0, 0
    for i in range(first, last):
        density_rate = rate[i, 3] + ahead * (rate[i, 3] - previous[i])
        previous[i] = rate[i, 3]
        density = position[i, 3] + dt * density_rate
        if i < split:
            way2 = 0.0
            for d in range(3):
                way = dt * (velocity[i, d] + 0.5 * dt * rate[i, d])
                position[i, d] += way
                velocity[i, d] += dt * rate[i, d]
                way2 += way * way
            moved = max(moved, shift2(i, position, reference))
            failures += failed(density, way2, furthest)
        else:
            density = max(density, constants.density)
        write_density(i, density, constants, position, velocity)
    return moved, failures


@njit(**EXACT)
def half_step(
    first: int, last: int, split: int, dt: float, constants: Constants, rows: Rows
) -> None:
    """Bring rows [first, last) to the middle of the step: r', ρ', u'."""
    position, velocity, _, previous, acceleration, _ = rows
    for i in range(first, last):
        density = position[i, 3] + 0.5 * dt * previous[i]
        if i < split:
            for d in range(3):
                position[i, d] += 0.5 * dt * velocity[i, d]
                velocity[i, d] += 0.5 * dt * acceleration[i, d]
        else:
            density = max(density, constants.density)
        write_density(i, density, constants, position, velocity)


@njit(**EXACT)
def kick(first: int, last: int, dt: float, rows: Rows) -> None:
    """Bring velocity and position of fluid rows [first, last) to the end of the step."""
    position, velocity, rate, _, acceleration, _ = rows
    for i in range(first, last):
        for d in range(3):
            velocity[i, d] += dt * (rate[i, d] - 0.5 * acceleration[i, d])
            position[i, d] += 0.5 * dt * velocity[i, d]


@njit(**EXACT)
def finish(
    first: int, last: int, split: int, dt: float, furthest: float, constants: Constants, rows: Rows
) -> tuple[float, int]:
    """Bring density to the end of the step; return as `advance` does."""
    position, velocity, rate, previous, acceleration, reference = rows
    moved, failures = 0.0, 0
    for i in range(first, last):
        previous[i] = rate[i, 3]
        density = position[i, 3] + 0.5 * dt * rate[i, 3]
        if i < split:
            speed2 = 0.0
            for d in range(3):
                acceleration[i, d] = rate[i, d]
                speed2 += velocity[i, d] ** 2
            moved = max(moved, shift2(i, position, reference))
            failures += failed(density, dt * dt * speed2, furthest)
        else:
            density = max(density, constants.density)
        write_density(i, density, constants, position, velocity)
    return moved, failures
