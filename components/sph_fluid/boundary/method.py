"""What a boundary method must do: how walls and surface samples act on the fluid."""

from collections.abc import Callable, Sequence
from typing import Any, Protocol

from quintet.components.shared.search.neighbours import Lists
from quintet.components.shared.threads import Team
from quintet.components.sph_fluid.boundary.symmetry_planes import SymmetryPlanes
from quintet.components.sph_fluid.laws import ContactPotential
from quintet.components.sph_fluid.state import Array, State, Whole
from quintet.interfaces.component import Fields

MakeFilmRows = Callable[..., Any]  # of films, their faces and ranks: as `film_rows.py:FilmRows`


class BoundaryMethod(Protocol):
    """Dynamic particles, mirrored ones, or a contact potential."""

    contact: ContactPotential  # numbers of the contact potential, where there is one
    mask: Array  # (n,) 1 for rows at which it acts, 0 for others; (0,) if it acts at all, or none
    stable_dt: float  # s, largest step that it allows
    by_potential: Whole  # (k,) samples under the contact potential
    reads_images: bool  # whether `write_pressure` reads more than the rows that it writes

    def start(self, state: State) -> None:
        """Make the walls ready, before there are samples."""

    def join(self, state: State, static: Fields) -> None:
        """Make surface samples ready that links bring."""

    def follow_samples(self, state: State, fields: Fields, first: int = 0) -> None:
        """Follow samples that were placed, from the first one of the port on, or another one."""

    def load(self, state: State) -> None:
        """Follow a state that was loaded."""

    def rows_with_density_rate(self, state: State) -> int:
        """Rows whose density obeys the equation of continuity, from the first on."""

    def displacement(self, state: State) -> float:
        """Furthest [m] that its query points are from where the lists were made."""

    def query_points(self, state: State) -> tuple[Array | None, Whole]:
        """Places (m, 3) m from which it looks for fluid, and where samples' lists stand.

        None: every boundary particle looks from where it is.
        """

    def resize(self, state: State, symmetry: SymmetryPlanes) -> None:
        """Follow a state with new lists."""

    def write_pressure(self, state: State, lists: Lists, team: Team) -> None:
        """Write density and pressure of the boundary, before a pass over pairs."""

    def apparent_velocity(self, state: State, lists: Lists, team: Team) -> Array:
        """Velocities (n, 4) m/s as the fluid's kinematic viscosity sees them."""

    def energy(self, state: State, lists: Lists, team: Team) -> float:
        """Energy [J] that it stores."""


class Films(Protocol):
    """Films in narrow gaps: from the start, from when a body needs one, or never."""

    @property
    def notes(self) -> Sequence[str]:
        """What the user should read."""

    def join(self, state: State, static: Fields) -> None:
        """Make room for films at samples that links bring."""

    def load(self, state: State) -> None:
        """Follow a state that was loaded."""

    def resize(self, state: State, lists: Lists) -> None:
        """Find the films of a state with new lists."""

    def advance(self, state: State, lists: Lists, dt: float) -> None:
        """Advance the films by a step [s], and add their push to the samples' force."""


class NoFilms:
    """A fluid without films, and one without surfaces."""

    notes: Sequence[str] = ()

    def join(self, state: State, static: Fields) -> None:
        """Nothing to do: there are no films."""

    def load(self, state: State) -> None:
        """Nothing to do: there are no films."""

    def resize(self, state: State, lists: Lists) -> None:
        """Nothing to do: there are no films."""

    def advance(self, state: State, lists: Lists, dt: float) -> None:
        """Nothing to do: there are no films."""
