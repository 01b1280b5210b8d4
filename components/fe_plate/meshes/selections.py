"""How a scene chooses nodes, faces and elements of a mesh: by boxes and by named sets."""

from quintet.components.fe_plate.meshes.params import Direction
from quintet.components.shared.geometry.selections import ByBox, ByBoxOrSet
from quintet.interfaces.params import parameters


@parameters
class NodeSet(ByBox):
    """Nodes by a name, as files of meshes have them: those that are in a box at the start.

    Parameters
    ----------
    name
        By which `fixed`, `coupled_faces` and `pressures` choose them.
    """

    name: str


@parameters
class Fixed(ByBoxOrSet):
    """Nodes that are held: those that are in a box at the start, or in a set.

    Parameters
    ----------
    directions
        Along which they keep their places; all for clamped ones, the normal for a symmetry plane.
    """

    directions: tuple[Direction, ...] = ("x", "y", "z")


@parameters
class Faces(ByBoxOrSet):
    """Outer faces: those all of whose nodes are in a box at the start, or in a set of nodes."""


@parameters
class Elements(ByBoxOrSet):
    """Elements: those all of whose nodes are in a box at the start, or in a set of nodes.

    Parameters
    ----------
    element_set
        In place of both: a set of elements of a mesh's file.
    """

    element_set: str = ""

    def __post_init__(self) -> None:
        if self.node_set and self.element_set:
            raise ValueError(
                "a selection must have a node_set or an element_set; found both. Remove one."
            )
        self.require_one(self.node_set or self.element_set)
