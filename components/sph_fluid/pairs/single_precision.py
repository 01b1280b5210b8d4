"""Pairs in single precision; imported only by a scene that asks.

The state stays double. Positions are copied relative to the middle of the fluid and densities to
ρ₀, so that what is rounded away is 6e-8 of the fluid's extent and of its compression.
"""

import math

from quintet.components.shared.single_precision import SingleCopy, rounded
from quintet.components.shared.threads import Team
from quintet.components.sph_fluid.kernels import BoundaryRows, Particles
from quintet.components.sph_fluid.laws import PairLaw
from quintet.components.sph_fluid.ranks.method import Ranks
from quintet.components.sph_fluid.state import Array, State


class SinglePrecision:
    """Copies of one fluid's state, and its law."""

    def __init__(self, ranks: Ranks) -> None:
        self._ranks = ranks

    def resize(self, state: State, density: float) -> None:
        """Make room for a state of new lists, whose densities are counted from one [kg/m3]."""
        origin = (*self._centre(state.reference[: state.fluid]), density)
        self.position = SingleCopy(state.position_density.shape, origin)
        self.velocity = SingleCopy(state.velocity_pressure.shape, (0.0, 0.0, 0.0, 0.0))

    def _centre(self, points: Array) -> tuple[float, float, float]:
        """Middle [m] of the box around the fluid of all ranks, by the points (n, 3) m of this."""
        high = [float(axis.max(initial=-math.inf)) for axis in points.T]
        depth = [float((-axis).max(initial=-math.inf)) for axis in points.T]
        x, y, z, a, b, c = self._ranks.greatest(*high, *depth)
        return 0.5 * (x - a), 0.5 * (y - b), 0.5 * (z - c)

    def particles(self, state: State, team: Team) -> Particles:
        """Copy the state as it is now."""
        return Particles(
            self.position.of(state.position_density, team),
            self.velocity.of(state.velocity_pressure, team),
        )

    def boundary(self, rows: BoundaryRows) -> BoundaryRows:
        """Round what boundary rows have beside particles."""
        single: BoundaryRows = rounded(rows)
        return single

    def law(self, law: PairLaw) -> PairLaw:
        """Round the numbers of the law, with densities above that at no pressure."""
        constants = law.constants._replace(base=law.constants.density)
        single: PairLaw = rounded(law._replace(constants=constants))
        return single
