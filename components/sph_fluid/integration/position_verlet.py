"""Position Verlet, with density as a position; imported only by a scene that asks.

    ρ' = ρⁿ + ½dt ρ̇ⁿ,  r' = rⁿ + ½dt uⁿ
    uⁿ⁺¹ = uⁿ + dt a(r', ρ', u'),  u' = uⁿ + ½dt aⁿ
    rⁿ⁺¹ = r' + ½dt uⁿ⁺¹,  ρⁿ⁺¹ = ρ' + ½dt ρ̇(rⁿ⁺¹, uⁿ⁺¹)

There are two passes over pairs in a step, one in its middle and one at its end, which also begins
the next step. Both r and ρ follow u alone, and u follows both alone, so that without viscosity the
scheme is symplectic and of second order (Leimkuhler & Matthews, Molecular Dynamics (2015), ch. 3):
sound is neither damped nor amplified. u' serves viscosity.
"""

from quintet.components.shared.threads import Team
from quintet.components.sph_fluid.constants import constants
from quintet.components.sph_fluid.integration.kernels import Rows, finish, half_step, kick
from quintet.components.sph_fluid.integration.method import Moved, StepTask
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
            task.compute_rates(0.0)
            state.previous_density_rate[: task.rows] = rate[: task.rows, 3]
            state.acceleration = rate[: state.fluid, :3].copy()
        numbers, rows = (state.fluid, dt), Rows.of(state, rate)
        team.run(half_step, task.rows, *numbers, self.constants, rows)
        task.compute_rates(0.5)
        task.apply_forces()
        team.run(kick, state.fluid, dt, rows)
        task.compute_rates(1.0)
        return team.run(finish, task.rows, *numbers, self.furthest, self.constants, rows)
