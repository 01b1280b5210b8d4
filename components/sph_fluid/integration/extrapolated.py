"""One pass over pairs in a step: velocities from its forces, densities from rates extrapolated.

A particle's momentum changes in a step by exactly dt times the force of that step,
uⁿ⁺¹ = uⁿ + dt aⁿ. The density advances with its rate at a time past the step's end, extrapolated
from the last two: sound waves are then damped, not amplified.
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

# How many steps ahead of its last value the rate of density is taken, by extrapolation. One makes
# sound waves neutral to second order in ω dt; a little more damps them, up to ω dt = 0.5.
AHEAD = 1.25


class Extrapolated:
    """The scheme for one fluid."""

    def __init__(self, params: SphFluidParams) -> None:
        self.furthest, self.constants = params.spacing, constants(params)

    def step(self, state: State, task: StepTask, team: Team) -> Moved:
        """Advance a state by a step."""
        task.compute_rates()
        task.apply_forces()
        dt, last = task.dt, state.last_dt
        # At most twice as far as the last step: extrapolating from a tiny step would magnify noise.
        ahead = AHEAD * min(dt / last, 2.0) if last > 0.0 else 0.0
        numbers = (state.fluid, dt, ahead, self.furthest, self.constants)
        return team.run(advance, task.rows, *numbers, Rows.of(state, task.rate))


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
