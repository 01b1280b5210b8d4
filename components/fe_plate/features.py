"""Optional physics as objects: pressures on faces, and the integration of the elements."""

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from quintet.components.fe_plate.build import Structure
from quintet.components.fe_plate.kernels.eight_points import step_eight_points
from quintet.components.fe_plate.kernels.elements import step_elements
from quintet.components.fe_plate.kernels.ten_nodes import step_ten_nodes
from quintet.components.fe_plate.loads import add_pressure
from quintet.components.fe_plate.params import Pressure
from quintet.components.fe_plate.ranks.method import Ranks, Rows
from quintet.components.fe_plate.ranks.one import OneRank
from quintet.components.fe_plate.state import Array, State
from quintet.components.shared.contact.one_rank import require_one_rank
from quintet.interfaces.component import Fields, Keys, Resources

if TYPE_CHECKING:
    from quintet.components.fe_plate.partner_faces import PartnerFaces

Stepped = tuple[float, float, int]  # stable step [s], least volume over that at the start, of which
Kernel = Callable[..., Stepped]


def ranks(resources: Resources, ends: Callable[[int], list[int]]) -> Ranks:
    """The ranks that share the elements out, and each its own by `ends` among threads."""
    communicator = resources.communicator
    if communicator is None or communicator.size == 1:
        return OneRank()
    # Only a structure of several ranks loads mpi4py.
    from quintet.components.fe_plate.ranks.several import SeveralRanks

    return SeveralRanks(communicator, ends)


def partner_faces(
    static: Fields, joined: Keys, surface: Fields, velocity: Array, resources: Resources
) -> "PartnerFaces | None":
    """Faces of a partner's mesh that a surface touches; None where no link joins them."""
    if "contact_faces" not in joined:
        return None
    # Scenes without contact of two meshes do not import it.
    from quintet.components.fe_plate.partner_faces import PartnerFaces

    require_one_rank("a structure", resources)
    return PartnerFaces(static, surface, velocity)


class Pressures:
    """Pressures on outer faces, along their normals as they move; none on eroded elements."""

    def __init__(self, pressures: tuple[Pressure, ...], built: Structure) -> None:
        self.loads, self.built = list(zip(pressures, built.pressed, strict=True)), built
        corners = [built.mesh.side[faces].ravel() for faces in built.pressed]
        nodes = np.unique(np.concatenate(corners)) if corners else np.zeros(0, np.int64)
        self.nodes = nodes[nodes >= 0]  # that any of them acts on

    def add(self, state: State, time: float) -> None:
        """Add the loads [N] of a time [s]."""
        mesh, places = self.built.mesh, self.built.face_places
        for load, faces in self.loads:
            if pressure := load.at(time):
                intact = places.subset(faces).active(state) > 0.0
                add_pressure(mesh, state, faces[intact], pressure)


class Loads:
    """Loads on nodes over a step: those of partners on the surface, and pressures."""

    def __init__(self, surface: Rows, pressures: Pressures) -> None:
        self.surface, self.pressures = surface, pressures
        self.left = True  # whether the state may hold loads of an earlier step

    def write(self, state: State, partners: Array, time: float) -> bool:
        """Write all loads of a step that begins at a time [s]; whether any is not 0.

        Parameters
        ----------
        state
        partners : (k, 3) float array, N
            On the nodes of the whole surface.
        time : float, s
        """
        loaded = bool(self.pressures.loads) or bool(partners.any())
        if loaded or self.left:
            state.load[self.pressures.nodes] = 0.0
            state.load[self.surface.rows] = partners[self.surface.ids]
            self.pressures.add(state, time)
        self.left = loaded
        return loaded


def stepping_kernel(points: int) -> Kernel:
    """Kernel that steps the blocks of elements with 1, 4 or 8 points; others are not compiled."""
    return {1: _one_point, 4: _ten_nodes, 8: _eight_points}[points]


def _one_point(begin: int, end: int, first: int, *arguments: object) -> Stepped:
    """Step blocks that are counted from a part's first one on."""
    result: Stepped = step_elements(first + begin, first + end, *arguments)
    return result


def _eight_points(begin: int, end: int, first: int, *arguments: object) -> Stepped:
    result: Stepped = step_eight_points(first + begin, first + end, *arguments)
    return result


def _ten_nodes(begin: int, end: int, first: int, *arguments: object) -> Stepped:
    result: Stepped = step_ten_nodes(first + begin, first + end, *arguments)
    return result
