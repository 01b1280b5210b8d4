"""A damper of sound, -ζ h c₀ ρ∇·u beside the pressure; imported only by a scene that asks.

After the acoustic damper of Sun, Pilloton, Antuono & Colagrossi, J. Comput. Phys. 483 (2023)
112056. It is a bulk viscosity: of a flow that keeps its volume it takes nothing, and sound of wave
number k fades as e^{-½ ζ h c₀ k² t}. -ρ∇·u is dρ/dt as the flow alone makes it, without what
diffuses, as the last pass over pairs found it. Pairs feel it as they feel pressure, so that no
momentum is lost. Mirrored walls go on with what the fluid before them has, and do not pull.
Gauges read the pressure without it: what is felt of it is its own viscosity's, not the water's.

In a step of `symplectic.py` a sound wave that pairs see as ω = K c₀/h is stable while

    ¼ C² K² + ½ ζ C K² < 1,   C = dt c₀/h,

by the eigenvalues of its two variables; K = STEEPEST is what the steepest wave on a lattice has.
"""

import math

import numpy as np
from numba import njit

from quintet.components.shared.numba_options import FAST
from quintet.components.shared.search.neighbours import Lists
from quintet.components.shared.smoothing.smoothing import kernel
from quintet.components.shared.threads import Team
from quintet.components.sph_fluid.laws import Fluid, constants, pressure_term
from quintet.components.sph_fluid.mdbc import NONE
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.state import Array, State

# Greatest h |Σ V sin(k·r) ∇W| on a square or cubic lattice, cubic spline and Wendland's kernel, h
# from 1.2 to 2 spacings: 1.06 to 1.16.
STEEPEST = 1.16
SAFE = 0.9  # of the step that it allows: what is no lattice is a little steeper


def limit(damper: float) -> float:
    """Greatest step over the time that sound takes through a smoothing length."""
    return SAFE * (math.sqrt(damper**2 + (2.0 / STEEPEST) ** 2) - damper)


def damp(state: State, params: SphFluidParams, team: Team) -> None:
    """Write p/ρ² with the damper's part: of the fluid, and of dynamic walls."""
    rows = state.particles if params.boundary.method == "dbc" else state.fluid
    strength = params.acoustic_damper * params.sound_speed * params.smoothing_length
    team.run(add, rows, strength, state.squeeze, constants(params), state.place, state.motion)


def damp_walls(state: State, near: Lists, params: SphFluidParams, team: Team) -> None:
    """Add to p/ρ² of mirrored walls and samples what the fluid at their mirror points has."""
    arrays = (state.mirror, state.place, state.motion, near)
    team.run(carry, len(state.mirror), state.fluid, *arrays, constants(params))


@njit(**FAST)
def add(
    first: int, last: int, strength: float, squeeze: Array, fluid: Fluid, place: Array,
    motion: Array,
) -> None:  # fmt: skip
    """Write p/ρ² of rows [first, last) as if the damper's part, strength · dρ/dt, were pressure."""
    for i in range(first, last):
        density = place[i, 3]
        more = strength * squeeze[i] / (density * density)
        motion[i, 3] = pressure_term(density, fluid) + more


@njit(**FAST)
def carry(
    first: int, last: int, split: int, mirrors: Array, place: Array, motion: Array, near: Lists,
    fluid: Fluid,
) -> None:  # fmt: skip
    """Add the damper's mean part around their mirror points to p/ρ² of boundary rows."""
    begin, _, end, neighbour = near
    for b in range(first, last):
        i = split + b
        x, y, z = mirrors[b, 0], mirrors[b, 1], mirrors[b, 2]
        weights, sums = 0.0, 0.0
        for k in range(np.uint64(begin[i]), np.uint64(end[i])):
            j = np.uint64(neighbour[k])
            dx, dy, dz = place[j, 0] - x, place[j, 1] - y, place[j, 2] - z
            weight = kernel(dx * dx + dy * dy + dz * dz, fluid.smoothing) * fluid.mass / place[j, 3]
            weights += weight
            sums += weight * (motion[j, 3] - pressure_term(place[j, 3], fluid))
        if weights >= NONE:
            motion[i, 3] = max(motion[i, 3] + sums / weights, 0.0)
