"""A damper of sound, -ζ h c₀ ρ∇·u beside the pressure; imported only by a scene that asks.

After the acoustic damper of Sun, Pilloton, Antuono & Colagrossi, J. Comput. Phys. 483 (2023)
112056. It is a bulk viscosity: of a flow that keeps its volume it takes nothing, and sound of wave
number k fades as e^{-½ ζ h c₀ k² t}. -ρ∇·u is dρ/dt as the flow alone makes it, without what
diffuses, as the last pass over pairs found it. Pairs feel it as they feel pressure, so that no
momentum is lost. Mirrored walls go on with what the fluid before them has, and do not pull.
Gauges read the pressure without it: what is felt of it is its own viscosity's, not the water's.

In a step of position Verlet a sound wave that pairs see as ω = K c₀/h is stable while

    ¼ C² K² + ½ ζ C K² < 1,   C = dt c₀/h,

by the eigenvalues of its two variables; K is what the steepest wave on a lattice has, STEEPEST of
the kernel.
"""

import math

from quintet.components.shared.search.neighbours import Lists
from quintet.components.shared.smoothing.smoothing import STEEPEST, Kernel
from quintet.components.shared.threads import Team
from quintet.components.sph_fluid.boundary.method import BoundaryMethod
from quintet.components.sph_fluid.constants import constants
from quintet.components.sph_fluid.pairs.kernels import add_mirrored_damping, write_damped_pressure
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.state import State

SAFE = 0.9  # of the step that it allows: what is no lattice is a little steeper


def courant_limit(damper: float, kernel: Kernel) -> float:
    """Greatest step over the time that sound takes through a smoothing length."""
    return SAFE * (math.sqrt(damper**2 + (2.0 / STEEPEST[kernel]) ** 2) - damper)


class AcousticDamper:
    """The damper of the fluid, and of walls that obey its equations."""

    reads_images = False

    def __init__(self, params: SphFluidParams, boundary: BoundaryMethod) -> None:
        self.boundary, self.constants = boundary, constants(params)
        self.strength = params.acoustic_damper * params.sound_speed * params.smoothing_length

    def write_pressure(self, state: State, lists: Lists, team: Team) -> None:
        """Write p/ρ² with the damper's part."""
        rows = self.boundary.rows_with_density_rate(state)
        arrays = (state.minus_rho_div_u, state.position_density, state.velocity_pressure)
        team.run(write_damped_pressure, rows, self.strength, *arrays, self.constants)


class MirroredDamper:
    """The damper's part at mirrored walls and samples."""

    reads_images = True

    def __init__(self, params: SphFluidParams, boundary: BoundaryMethod) -> None:
        self.boundary, self.constants = boundary, constants(params)

    def write_pressure(self, state: State, lists: Lists, team: Team) -> None:
        """Add to p/ρ² of walls and samples what the fluid at their mirror points has of it."""
        arrays = (state.mirror_point, state.position_density, state.velocity_pressure, lists)
        rows, mask = len(state.mirror_point), self.boundary.mask
        team.run(add_mirrored_damping, rows, state.fluid, *arrays, mask, self.constants)
