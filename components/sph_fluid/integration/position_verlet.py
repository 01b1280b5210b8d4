"""Position Verlet, with density as a position; imported only by a scene that asks.

    ρ' = ρⁿ + ½dt ρ̇ⁿ,  r' = rⁿ + ½dt uⁿ
    uⁿ⁺¹ = uⁿ + dt a(r', ρ', u'),  u' = uⁿ + ½dt aⁿ
    rⁿ⁺¹ = r' + ½dt uⁿ⁺¹,  ρⁿ⁺¹ = ρ' + ½dt ρ̇(rⁿ⁺¹, uⁿ⁺¹)

There are two passes over pairs in a step, one in its middle and one at its end, which also begins
the next step. Both r and ρ follow u alone, and u follows both alone, so that without viscosity the
scheme is symplectic and of second order (Leimkuhler & Matthews, Molecular Dynamics (2015), ch. 3):
sound is neither damped nor amplified. u' serves viscosity.
"""

from numba import njit

from quintet.components.shared.numba_options import EXACT
from quintet.components.shared.threads import Team
from quintet.components.sph_fluid.integration.method import (
    Moved,
    Rows,
    StepTask,
    failed,
    shift2,
    write_density,
)
from quintet.components.sph_fluid.laws import Constants
from quintet.components.sph_fluid.pairs.constants import constants
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.state import State


class PositionVerlet:
    """The scheme for one fluid."""

    def __init__(self, params: SphFluidParams) -> None:
        self.furthest, self.constants = params.spacing, constants(params)

    def step(self, state: State, task: StepTask, team: Team) -> Moved:
        """Advance a state by a step."""
        dt, rate = task.dt, task.rate
        if not len(state.acceleration):
            task.compute_rates()
            state.previous_density_rate[: task.rows] = rate[: task.rows, 3]
            state.acceleration = rate[: state.fluid, :3].copy()
        numbers, rows = (state.fluid, dt), Rows.of(state, rate)
        team.run(half_step, task.rows, *numbers, self.constants, rows)
        task.compute_rates()
        task.apply_forces()
        team.run(kick, state.fluid, dt, rows)
        task.compute_rates()
        return team.run(finish, task.rows, *numbers, self.furthest, self.constants, rows)


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
    """Bring density to the end of the step; return as `extrapolated.advance` does."""
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
