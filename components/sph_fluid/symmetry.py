"""Planes of symmetry of a fluid; imported only by a scene that asks.

To the fluid and to walls the images of fluid are fluid, with all terms between its pairs, and those
of walls and samples are these: what is left of a symmetric whole moves as that does.
"""

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.search.neighbours import NeighbourLists
from quintet.components.shared.symmetry import Plane, SymmetryImages, neighbours_and_images
from quintet.components.shared.threads import Team
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.state import Array, State


class Images:
    """The images of one fluid's rows, from one list of neighbours to the next."""

    def __init__(self, params: SphFluidParams) -> None:
        assert params.boundary.walls is not None
        walls = params.boundary.walls
        self.images = SymmetryImages(
            [Plane.of_face(face, walls) for face in sorted(set(params.boundary.symmetry))]
        )
        self.reflect = self.images.all_images

    def neighbours(
        self, state: State, reach: float, team: Team, query_points: Array | None,
        room: NDArray[np.int32],
    ) -> NeighbourLists:  # fmt: skip
        """Make room for images, and lists of the fluid, then of the boundary or query points."""
        rows = state.particles
        points = self.images.find(state.reference[:rows], reach)
        wet = np.arange(len(points)) < state.fluid
        self.images.write_values(wet, rows)
        state.place = self.images.with_room(state.place, rows)
        state.motion = self.images.with_room(state.motion, rows)
        self.fill(state)
        split = state.fluid
        return neighbours_and_images(points, wet, split, rows, reach, team, query_points, room)

    def fill(self, state: State) -> None:
        """Write the images of the state as it is."""
        self.images.write_positions(state.place, state.particles)
        self.images.write_vectors(state.motion, state.particles)

    def turn(self, velocity: Array, first: int) -> None:
        """Write velocities (n + images, 4) of images, which begin with row `first`."""
        self.images.write_vectors(velocity, first)

    def copy(self, first: int, *lists: NDArray[np.floating] | None) -> None:
        """Write values (n + images,) of images, from row `first` on: those of their origins."""
        for values in lists:
            if values is not None:
                self.images.write_values(values, first)

    def turn_back(self, state: State) -> None:
        """Let fluid that passed a plane change places with its image."""
        rows = slice(state.fluid)
        pull = [state.pull] if len(state.pull) else []
        self.images.reflect_crossed(state.place[rows], state.motion[rows], *pull)

    def refuse(self, points: Array) -> None:
        """Raise where samples (samples, 3) m are behind a plane."""
        self.images.require_before(points, "surface: sample")
