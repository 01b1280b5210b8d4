"""In which precision pairs are computed: double, unless a scene asks for single."""

from typing import Protocol

from quintet.components.shared.threads import Team
from quintet.components.sph_fluid.kernels import BoundaryRows, Particles
from quintet.components.sph_fluid.laws import PairLaw
from quintet.components.sph_fluid.state import State


class Precision(Protocol):
    """What a pass over pairs is given."""

    def resize(self, state: State, density: float) -> None:
        """Make room for a state of new lists, of a fluid of a density [kg/m3] at no pressure."""

    def particles(self, state: State, team: Team) -> Particles:
        """All rows of the state as they are now."""

    def boundary(self, rows: BoundaryRows) -> BoundaryRows:
        """What boundary rows have beside particles."""

    def law(self, law: PairLaw) -> PairLaw:
        """Numbers of the pair law."""


class DoublePrecision:
    """The state and its law as they are."""

    def resize(self, state: State, density: float) -> None:
        """Nothing to do: nothing is copied."""

    def particles(self, state: State, team: Team) -> Particles:
        """All rows of the state itself."""
        return Particles(state.position_density, state.velocity_pressure)

    def boundary(self, rows: BoundaryRows) -> BoundaryRows:
        """Return the rows themselves."""
        return rows

    def law(self, law: PairLaw) -> PairLaw:
        """Return the law itself."""
        return law
