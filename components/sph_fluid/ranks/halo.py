"""Copies of the fluid and the boundary of other ranks, and images in planes of symmetry."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.domain.copies import CopiesAndImages, Group
from quintet.components.shared.domain.sorting import grid_of_all
from quintet.components.shared.search.neighbours import Around, NeighbourLists, neighbours_among
from quintet.components.shared.symmetry import Plane, SymmetryImages
from quintet.components.shared.threads import Team
from quintet.components.sph_fluid.ranks.several import Keys
from quintet.components.sph_fluid.state import Array, State, Whole
from quintet.interfaces.component import Fields


class HaloAndImages:
    """Copies and images of one fluid's rows, in place of its planes of symmetry alone.

    Parameters
    ----------
    communicator : mpi4py communicator
    keys : Keys
        Of this rank's rows.
    planes : list of Plane
        Of symmetry.
    """

    def __init__(self, communicator: Any, keys: Keys, planes: list[Plane]) -> None:
        self._communicator, self._keys = communicator, keys
        self._rows = CopiesAndImages(communicator, planes)
        self.images: SymmetryImages = self._rows.images
        self.all_images = self.images.all_images
        self.write_vectors = self._rows.write_vectors

    @property
    def rows(self) -> tuple[list[Whole], list[Whole]]:
        """For each rank the rows that it gets, and the rows into which its rows go."""
        return self._rows.sent, self._rows.received

    def neighbours(
        self, state: State, reach: float, team: Team, query_points: Array | None,
        buffer: NDArray[np.int32],
    ) -> NeighbourLists:  # fmt: skip
        """Make room for copies and images, and lists of the fluid, then of the boundary."""
        points, first, second, looking, grid = self.around(state, reach, query_points)
        arguments = (looking, state.fluid, team, buffer, grid)
        return neighbours_among(reach, points, first, second, *arguments)

    def around(self, state: State, reach: float, query_points: Array | None) -> Around:
        """Make room for copies and images, and find all that rows may have as neighbours."""
        rows, split = state.particles, state.fluid
        fluid, boundary = state.reference[:split], state.reference[split:rows]
        others = boundary if query_points is None else query_points
        looking = np.concatenate([fluid, others])
        groups = [
            Group(fluid, self._keys.fluid, looking),
            Group(boundary, self._keys.boundary, fluid),
        ]
        extended = self._rows.copy(groups, reach)
        points, (first, second) = self._rows.find_images(extended, reach)
        state.position_density = self._rows.with_room(state.position_density, rows)
        state.velocity_pressure = self._rows.with_room(state.velocity_pressure, rows)
        self.write_images(state)
        grid = grid_of_all(self._communicator, points.take(first, axis=0), reach)
        return Around(points, first, second, looking, grid)

    def write_images(self, state: State) -> None:
        """Write copies and images of all particles as they are."""
        self._rows.write_all(state.particles, state.position_density, state.velocity_pressure)

    def write_values(self, values: NDArray[np.floating], rows: int) -> None:
        """Write copies and images of values (rows + copies + images,)."""
        self._rows.write_values(values, rows)

    def reflect_crossed(self, state: State) -> None:
        """Let fluid that passed a plane change places with its image."""
        rows = slice(state.fluid)
        vectors = [state.velocity_pressure[rows]]
        vectors += [state.acceleration] if len(state.acceleration) else []
        self.images.reflect_crossed(state.position_density[rows], *vectors)

    def wrap(self, state: State) -> None:
        """Nothing to do: nothing repeats."""

    def wrapped_samples(self, fields: Fields) -> Fields:
        """Return them as they are."""
        return fields

    def require_before(self, samples: Array) -> None:
        """Refuse samples (samples, 3) m behind a plane."""
        self.images.require_before(samples, "surface: sample")
