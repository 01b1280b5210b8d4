"""What a fluid asks of images: in planes of symmetry, or a period away; a fluid without any."""

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.search.neighbours import NeighbourLists, neighbours_within
from quintet.components.shared.threads import Team
from quintet.components.sph_fluid.state import Array, State
from quintet.interfaces.component import Fields


class SymmetryPlanes(Protocol):
    """Faces of the tank behind which all is mirrored, or goes on from the opposite face."""

    def neighbours(
        self, state: State, reach: float, team: Team, query_points: Array | None,
        buffer: NDArray[np.int32],
    ) -> NeighbourLists:  # fmt: skip
        """Lists of the fluid, then of the boundary or query points, with images among them."""

    def write_images(self, state: State) -> None:
        """Write the images of all particles as they are."""

    def write_vectors(self, vectors: Array, rows: int) -> None:
        """Write the images of vectors (rows + images, 4)."""

    def write_values(self, values: NDArray[np.floating], rows: int) -> None:
        """Write the images of values (rows + images,)."""

    def reflect_crossed(self, state: State) -> None:
        """Bring back fluid that passed a plane."""

    def wrap(self, state: State) -> None:
        """Bring back fluid that passed a face of a tank that repeats, before lists are made."""

    def wrapped_samples(self, fields: Fields) -> Fields:
        """Samples of bodies where they are in a tank that repeats."""

    def require_before(self, samples: Array) -> None:
        """Refuse samples (samples, 3) m behind a plane."""

    def all_images(self, points: Array) -> Array:
        """Points (m, 2 or 3) m, then their images in all planes and edges."""


class NoSymmetry:
    """A fluid that is computed as a whole."""

    def neighbours(
        self, state: State, reach: float, team: Team, query_points: Array | None,
        buffer: NDArray[np.int32],
    ) -> NeighbourLists:  # fmt: skip
        """Lists of the fluid, then of the boundary or query points."""
        points = state.reference[: state.particles]
        return neighbours_within(reach, points, state.fluid, team, query_points, buffer)

    def write_images(self, state: State) -> None:
        """Nothing to do: there are no images."""

    def write_vectors(self, vectors: Array, rows: int) -> None:
        """Nothing to do: there are no images."""

    def write_values(self, values: NDArray[np.floating], rows: int) -> None:
        """Nothing to do: there are no images."""

    def reflect_crossed(self, state: State) -> None:
        """Nothing to do: there is no plane to pass."""

    def wrap(self, state: State) -> None:
        """Nothing to do: nothing repeats."""

    def wrapped_samples(self, fields: Fields) -> Fields:
        """Return them as they are."""
        return fields

    def require_before(self, samples: Array) -> None:
        """Nothing to do: there is no plane to be behind."""

    def all_images(self, points: Array) -> Array:
        """Return the points alone."""
        return points
