"""Planes of symmetry of a fluid; imported only by a scene that asks.

To the fluid and to walls the images of fluid are fluid, with all terms between its pairs, and those
of walls and samples are these: what is left of a symmetric whole moves as that does.
"""

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.search.neighbours import Around, NeighbourLists, neighbours_among
from quintet.components.shared.symmetry import Plane, SymmetryImages, around_images
from quintet.components.shared.threads import Team
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.state import Array, State
from quintet.interfaces.component import Fields


class Symmetry:
    """The images of one fluid's rows, from one list of neighbours to the next."""

    def __init__(self, params: SphFluidParams) -> None:
        assert params.boundary.tank is not None
        walls, faces = params.boundary.tank, sorted(set(params.boundary.symmetry))
        self.images = SymmetryImages([Plane.of_face(face, walls) for face in faces])
        self.write_vectors = self.images.write_vectors
        self.write_values = self.images.write_values
        self.all_images = self.images.all_images

    def neighbours(
        self, state: State, reach: float, team: Team, query_points: Array | None,
        buffer: NDArray[np.int32],
    ) -> NeighbourLists:  # fmt: skip
        """Make room for images, and lists of the fluid, then of the boundary or query points."""
        points, first, second, looking, grid = self.around(state, reach, query_points)
        arguments = (looking, state.fluid, team, buffer, grid)
        return neighbours_among(reach, points, first, second, *arguments)

    def around(self, state: State, reach: float, query_points: Array | None) -> Around:
        """Make room for images, and find all that rows may have as neighbours."""
        rows, split = state.particles, state.fluid
        points = self.images.find(state.reference[:rows], reach)
        is_fluid = np.arange(len(points)) < split
        self.images.write_values(is_fluid, rows)
        state.position_density = self.images.with_room(state.position_density, rows)
        state.velocity_pressure = self.images.with_room(state.velocity_pressure, rows)
        self.write_images(state)
        return around_images(points, is_fluid, split, rows, reach, query_points)

    def write_images(self, state: State) -> None:
        """Write the images of all particles as they are."""
        self.images.write_all(state.particles, state.position_density, state.velocity_pressure)

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
