"""One pass over pairs in a step: velocities from its forces, densities from rates extrapolated.

A particle's momentum changes in a step by exactly dt times the force of that step,
uⁿ⁺¹ = uⁿ + dt aⁿ. The density advances with its rate at a time past the step's end, extrapolated
from the last two: sound waves are then damped, not amplified.
"""

from quintet.components.shared.threads import Team
from quintet.components.sph_fluid.constants import constants
from quintet.components.sph_fluid.integration.kernels import Rows, advance
from quintet.components.sph_fluid.integration.method import Moved, StepTask
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
        task.compute_rates(0.5)
        task.apply_forces()
        dt, last = task.dt, state.last_dt
        # At most twice as far as the last step: extrapolating from a tiny step would magnify noise.
        ahead = AHEAD * min(dt / last, 2.0) if last > 0.0 else 0.0
        numbers = (state.fluid, dt, ahead, self.furthest, self.constants)
        return team.run(advance, task.rows, *numbers, Rows.of(state, task.rate))
