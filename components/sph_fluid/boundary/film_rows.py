"""The rows that films lie between, wherever they are owned: each rank computes all films."""

import numpy as np

from quintet.components.shared.search.neighbours import Lists
from quintet.components.sph_fluid.boundary.film_geometry import Faces, Films
from quintet.components.sph_fluid.boundary.kernels.films import write_fluid_share
from quintet.components.sph_fluid.laws import Constants
from quintet.components.sph_fluid.ranks.method import Ranks
from quintet.components.sph_fluid.state import Array, State


class FilmRows:
    """Rows of walls and samples between which some films lie, as they are now.

    Parameters
    ----------
    films : Films
    faces : Faces
        Those in which the films were found.
    ranks : Ranks
    """

    def __init__(self, films: Films, faces: Faces, ranks: Ranks) -> None:
        self._ranks = ranks
        needed, place = np.unique(np.concatenate([films.row, films.across]), return_inverse=True)
        self._sides = np.split(place.reshape(-1), 2)
        self._keys = np.flatnonzero(faces.rank[needed] == ranks.rank)
        self._rows = faces.row[needed[self._keys]]
        self._here = np.flatnonzero(faces.rank[films.row] == ranks.rank)
        self._here_row = faces.row[films.row[self._here]]

    def now(self, state: State) -> tuple[Array, Array]:
        """What each film (m,) lies between now: its own side and what it faces, (m, 8) each.

        Columns are x, y, z [m], density [kg/m3], p/ρ² and the mirror point [m].
        """
        rows = state.fluid + self._rows
        pressure = state.velocity_pressure[rows, 3:]
        columns = [state.position_density[rows], pressure, state.mirror_point[self._rows]]
        of_all = self._ranks.all_rows(self._keys, np.concatenate(columns, axis=1))
        near_side, far_side = (of_all[side] for side in self._sides)
        return near_side, far_side

    def fluid_share(self, state: State, foot: Array, lists: Lists, constants: Constants) -> Array:
        """Σ V W (m,) of the fluid around the feet (m, 3) m of all films."""
        share = np.empty(len(self._here))
        feet = foot[self._here]
        position = state.position_density
        write_fluid_share(self._here_row, feet, state.fluid, position, lists, constants, share)
        return self._ranks.all_rows(self._here, share)
