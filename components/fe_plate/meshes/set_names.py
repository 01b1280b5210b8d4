"""Names of sets by which a scene chooses nodes and elements, checked before a mesh is laid out."""

from collections.abc import Iterable, Sequence

from quintet.components.fe_plate.meshes.files import read
from quintet.components.fe_plate.meshes.params import MeshedPart
from quintet.components.fe_plate.meshes.selections import NodeSet
from quintet.components.shared.geometry.selections import ByBoxOrSet
from quintet.components.shared.geometry.shapes import Mesh
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import unknown

Place = tuple[str, ByBoxOrSet]  # key of the scene, and what it selects


def refuse_unknown_sets(
    parts: Sequence[MeshedPart], node_sets: Sequence[NodeSet], places: Iterable[Place]
) -> None:
    """Refuse selections by names that neither the scene nor a mesh's file has.

    Raises
    ------
    SceneError
        With a sentence for each of them.
    """
    nodes = {node_set.name for node_set in node_sets}
    elements: set[str] = set()
    for part in parts:
        if isinstance(shape := part.geometry, Mesh):
            loaded = read(shape.file, part.coincident_nodes, part.parts)
            nodes |= loaded.sets.keys()
            elements |= loaded.groups.keys()
    known = {"node_set": sorted(nodes), "element_set": sorted(elements)}
    mistakes = [
        unknown(f"{where}: {key} {name}", name, names)
        for where, selection in places
        for key, names in known.items()
        if (name := getattr(selection, key, "")) and name not in names
    ]
    if mistakes:
        raise SceneError(mistakes)
