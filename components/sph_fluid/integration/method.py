"""What a step in time is given, and what every scheme does with a row at its end."""

import math
from collections.abc import Callable
from typing import NamedTuple, Protocol

from numba import njit

from quintet.components.shared.threads import Team
from quintet.components.sph_fluid.laws import Constants, pressure_term
from quintet.components.sph_fluid.state import Array, State

Moved = list[tuple[float, int]]  # of each share of the rows: greatest shift² [m2], and failures


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


class StepTask(NamedTuple):
    """One step of one fluid."""

    dt: float  # s
    rows: int  # whose density obeys the equation of continuity
    rate: Array  # (n, 4) m/s2, m/s2, m/s2, kg/(m3 s), as the last pass over pairs wrote it
    compute_rates: Callable[[], None]  # writes those of the state as it is
    apply_forces: Callable[[], None]  # once, with the forces that the step is made of


class Integration(Protocol):
    """A scheme in time."""

    def step(self, state: State, task: StepTask, team: Team) -> Moved:
        """Advance a state by a step."""


@njit(inline="always")
def shift2(i, position, reference):  # type: ignore[no-untyped-def]
    """Square of how far [m] a row is from where the lists were made."""
    found = 0.0
    for d in range(3):
        found += (position[i, d] - reference[i, d]) ** 2
    return found


@njit(inline="always")
def failed(density, way2, furthest):  # type: ignore[no-untyped-def]
    """1 if a density [kg/m3] or the square of a way [m2] is out of bounds or not finite."""
    return int(not (way2 <= furthest * furthest and 0.0 < density < math.inf))


@njit(inline="always")
def write_density(i, density, constants: Constants, position, velocity):  # type: ignore[no-untyped-def]
    """Write the density of a row, and p/ρ²."""
    position[i, 3] = density
    velocity[i, 3] = pressure_term(density, constants)
