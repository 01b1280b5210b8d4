"""Position Verlet, with density as a position; imported only by a scene that asks.

    ρ' = ρⁿ + ½dt ρ̇ⁿ,  r' = rⁿ + ½dt uⁿ
    uⁿ⁺¹ = uⁿ + dt a(r', ρ', u'),  u' = uⁿ + ½dt aⁿ
    rⁿ⁺¹ = r' + ½dt uⁿ⁺¹,  ρⁿ⁺¹ = ρ' + ½dt ρ̇(rⁿ⁺¹, uⁿ⁺¹)

There are two passes over pairs in a step, one in its middle and one at its end, which also begins
the next step. Both r and ρ follow u alone, and u follows both alone, so that without viscosity the
scheme is symplectic and of second order (Leimkuhler & Matthews, Molecular Dynamics (2015), ch. 3):
sound is neither damped nor amplified. u' serves viscosity.
"""

import math
from collections.abc import Callable

from numba import njit

from quintet.components.shared.numba_options import EXACT
from quintet.components.shared.threads import Team
from quintet.components.sph_fluid.laws import Fluid, pressure_term
from quintet.components.sph_fluid.state import Array, State


def step(
    state: State, team: Team, advancing: int, dt: float, furthest: float, fluid: Fluid,
    rate: Array, meet: Callable[[], None], act: Callable[[], None],
) -> list[tuple[float, int]]:  # fmt: skip
    """Advance by dt [s]; return what `end` does, of each share of the rows.

    `meet` writes the rates of the state as it is; `act` is called once with those of the middle.
    """
    if not len(state.pull):
        meet()
        state.before[:advancing], state.pull = rate[:advancing, 3], rate[: state.fluid, :3].copy()
    rows, now = (advancing, state.fluid), (state.place, state.motion)
    team.run(begin, *rows, dt, fluid, state.before, state.pull, *now)
    meet()
    act()
    team.run(kick, state.fluid, dt, rate, state.pull, *now)
    meet()
    numbers = (dt, furthest, fluid, rate, state.reference, state.before, state.pull)
    return team.run(end, *rows, *numbers, *now)


@njit(**EXACT)
def begin(
    first: int, last: int, split: int, dt: float, fluid: Fluid, before: Array, pull: Array,
    place: Array, motion: Array,
) -> None:  # fmt: skip
    """Bring rows [first, last) to the middle of the step: r', ρ', u'."""
    for i in range(first, last):
        place[i, 3] = place[i, 3] + 0.5 * dt * before[i]
        if i < split:
            for d in range(3):
                place[i, d] += 0.5 * dt * motion[i, d]
                motion[i, d] += 0.5 * dt * pull[i, d]
        else:
            place[i, 3] = max(place[i, 3], fluid.density)
        motion[i, 3] = pressure_term(place[i, 3], fluid)


@njit(**EXACT)
def kick(
    first: int, last: int, dt: float, rate: Array, pull: Array, place: Array, motion: Array
) -> None:
    """Bring velocity and place of fluid rows [first, last) to the end of the step."""
    for i in range(first, last):
        for d in range(3):
            motion[i, d] += dt * (rate[i, d] - 0.5 * pull[i, d])
            place[i, d] += 0.5 * dt * motion[i, d]


@njit(**EXACT)
def end(
    first: int, last: int, split: int, dt: float, furthest: float, fluid: Fluid, rate: Array,
    reference: Array, before: Array, pull: Array, place: Array, motion: Array,
) -> tuple[float, int]:  # fmt: skip
    """Bring density to the end of the step; return the greatest shift² since the list, failures."""
    moved, failed = 0.0, 0
    for i in range(first, last):
        before[i] = rate[i, 3]
        density = place[i, 3] + 0.5 * dt * rate[i, 3]
        if i < split:
            speed2, moved2 = 0.0, 0.0
            for d in range(3):
                pull[i, d] = rate[i, d]
                speed2 += motion[i, d] ** 2
                moved2 += (place[i, d] - reference[i, d]) ** 2
            moved = max(moved, moved2)
            near = dt * dt * speed2 <= furthest * furthest
            failed += int(not (near and 0.0 < density < math.inf))
        else:
            density = max(density, fluid.density)
        place[i, 3] = density
        motion[i, 3] = pressure_term(density, fluid)
    return moved, failed
