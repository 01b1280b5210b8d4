"""Films that begin when a wet body comes near to a wall or another body; numpy until then."""

from collections.abc import Callable

import numpy as np

from quintet.components.shared.search.neighbours import Lists
from quintet.components.sph_fluid.boundary.method import Films
from quintet.components.sph_fluid.boundary.nearby_bodies import (
    bodies_of,
    bounds,
    near_each_other,
    near_walls,
)
from quintet.components.sph_fluid.boundary.samples import Samples
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.ranks.method import Ranks
from quintet.components.sph_fluid.state import State
from quintet.interfaces.component import Fields

WIDEST = 1.25  # spacings, of a gap that has a film, as in `film_geometry.py`
INSET = 1.0  # spacings, of a body's outermost samples below its surface, on corners too
TOUCHING = 0.5  # spacings, between a body and a wall below which water that they keep out is missed


class SelectiveFilms:
    """The films of one fluid, once a body needs one; a note where there can be none."""

    def __init__(
        self,
        params: SphFluidParams,
        samples: Samples,
        ranks: Ranks,
        make_films: Callable[[], Films],
    ) -> None:
        self.params, self.samples, self._make_films = params, samples, make_films
        self.ranks = ranks
        self.lacking = params.boundary.why_no_films(params.dimensions)
        self.films: Films | None = None
        self.notes: list[str] = []

    def join(self, state: State, static: Fields) -> None:
        """Find whether samples that links bring can have films."""
        if np.any(static.get("surface.contact", 0.0)):
            self.lacking = "a link chooses the contact potential, for which films are not available"

    def load(self, state: State) -> None:
        """Have films if a state that was loaded has them."""
        self.films = self._make_films() if len(state.film) else None

    def resize(self, state: State, lists: Lists) -> None:
        """Begin, once a body is near enough; find the films of a state with new lists."""
        if self.films is None and len(self.samples.volume):
            self._look(state, lists)
        if self.films is not None:
            self.films.resize(state, lists)

    def _look(self, state: State, lists: Lists) -> None:
        """Make films where a body needs one, or say why it has none."""
        begin, _, end, _ = lists
        number, body = bodies_of(self.samples)
        listed = self.samples.listed
        # Where all was when the lists were made, so that a state that is loaded finds the same.
        columns = [state.reference[self.samples.row], (end > begin)[listed, np.newaxis]]
        of_all = self.ranks.all_rows(self.samples.number, np.concatenate(columns, axis=1))
        places, spacing = of_all[:, :3], self.params.spacing
        is_wet = np.bincount(body, of_all[:, 3], len(number)) > 0.0
        is_wet &= number >= 0.0  # pistons, whose numbers are negative, have none
        if not is_wet.any():
            return
        boxes = bounds(places, body, len(number))
        if not self.lacking:
            reach = (WIDEST + INSET) * spacing
            is_near = near_walls(boxes, self.params, reach)
            is_near |= near_each_other(boxes, reach + INSET * spacing)
            if (is_near & is_wet).any():
                self.films = self._make_films()
                self.films.join(state, {})
        elif not self.notes:
            reach = (TOUCHING + self.params.boundary.sample_depth) * spacing
            for row in np.flatnonzero(near_walls(boxes, self.params, reach) & is_wet)[:1]:
                self.notes.append(
                    f"body {number[row]:g} touches a wall under water, and no film of water "
                    f"presses between them, since {self.lacking}: its load on the wall is too "
                    "large by the weight of the water above it. Set boundary.method to mdbc in "
                    "three dimensions without planes of symmetry, or, to leave it so, "
                    "boundary.lubrication_films to false."
                )

    def advance(self, state: State, lists: Lists, dt: float) -> None:
        """Advance the films by a step [s], if there are any, and add their push."""
        if self.films is not None:
            self.films.advance(state, lists, dt)
