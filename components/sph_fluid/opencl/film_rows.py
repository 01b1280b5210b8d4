"""The rows that films lie between, of a fluid on a device; imported only by a scene with films."""

from typing import Any

import numpy as np

from quintet.components.shared.opencl.arrays import DeviceArray, run
from quintet.components.shared.opencl.types import bytes_of
from quintet.components.shared.search.neighbours import Lists
from quintet.components.sph_fluid.boundary.film_geometry import Faces, Films
from quintet.components.sph_fluid.laws import Constants
from quintet.components.sph_fluid.opencl.device_state import DeviceState
from quintet.components.sph_fluid.ranks.method import Ranks
from quintet.components.sph_fluid.state import Array, State


class DeviceFilmRows:
    """As `FilmRows`: films are computed on the host, from some rows of the devices of all ranks.

    Parameters
    ----------
    kernels : two pyopencl.Kernel
        `film_sides` and `fluid_share` of `films.cl`.
    rows : DeviceState
    films : Films
    faces : Faces
        Those in which the films were found.
    ranks : Ranks
    """

    def __init__(
        self, kernels: tuple[Any, Any], rows: DeviceState, films: Films, faces: Faces, ranks: Ranks
    ) -> None:
        self._rows, (self._film_sides, self._share_kernel) = rows, kernels
        self._ranks = ranks
        needed, place = np.unique(np.concatenate([films.row, films.across]), return_inverse=True)
        self._sides = np.split(place.reshape(-1), 2)
        self._keys = np.flatnonzero(faces.rank[needed] == ranks.rank)
        self._here = np.flatnonzero(faces.rank[films.row] == ranks.rank)
        own_rows, own_faces = faces.row[needed[self._keys]], faces.row[films.row[self._here]]
        self._needed = DeviceArray.of(rows.queue, own_rows.astype(np.int32))
        self._side = DeviceArray(rows.queue, (len(own_rows), 8))
        self._face = DeviceArray.of(rows.queue, own_faces.astype(np.int32))
        self._foot = DeviceArray(rows.queue, (len(own_faces), 3))
        self._share = DeviceArray(rows.queue, (len(own_faces),))

    def now(self, state: State) -> tuple[Array, Array]:
        """Both sides of each film (m,) now, as of `FilmRows`."""
        rows, count = self._rows, self._side.shape[0]
        run(
            rows.queue, self._film_sides, count, np.int32(count), self._needed,
            np.int32(rows.split), rows.position, rows.velocity, rows.mirror, self._side,
        )  # fmt: skip
        sides = self._ranks.all_rows(self._keys, self._side.get())
        near_side, far_side = (sides[side] for side in self._sides)
        return near_side, far_side

    def fluid_share(self, state: State, foot: Array, lists: Lists, constants: Constants) -> Array:
        """Σ V W (m,) of the fluid around the feet (m, 3) m of all films."""
        rows, device_lists, count = self._rows, self._rows.lists, len(self._here)
        self._foot.put(foot[self._here])
        run(
            rows.queue, self._share_kernel, count, np.int32(count), self._face,
            np.int32(rows.split), self._foot, rows.position, device_lists.near, device_lists.end,
            device_lists.row_stride, device_lists.item_stride, bytes_of(constants, np.float64),
            self._share,
        )  # fmt: skip
        return self._ranks.all_rows(self._here, self._share.get())
