"""Glue: particles hang on the faces of a mesh, give it force and mass, and move with it.

Seed: Dyanov, Kazantsev, Chelakov, LOGOS, equations 2 to 4: f_M += φ f_S, M_M += φ m_S,
v_S = Σ φ v_M, with the shape functions φ of the face on which a particle lies at the start.
"""

from collections.abc import Mapping
from typing import TypeVar

from quintet.coupler.coupling.exchange import (
    Binding,
    Demands,
    Ends,
    Link,
    Mapped,
    Ports,
    Transfer,
    Works,
    requires,
)
from quintet.coupler.coupling.faces import project
from quintet.coupler.coupling.links.keys import Between, is_stand_in, with_keys
from quintet.interfaces.component import Fields
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import Count, parameters
from quintet.interfaces.ports import (
    FACE_ACTIVITY,
    GLUE_ACTIVITY,
    GLUED,
    GLUED_LOAD,
    NODE_GLUE,
    NODE_LOAD,
)

T = TypeVar("T")
FORCE = ("glued_load.force", "node_load.force")
ERODED = ("face_activity.active", "glue_activity.active")
# Glued chains of equal masses, thirty transits of a wave, step a tenth of the limit: the energy
# stays within 1 % when both sides step once a window, one after the other; an impulse that is
# summed over two or four steps against a velocity that is held meanwhile gains 28 % and 66 %,
# both sides at once grow without bound, and iterated windows lose 15 % in ten transits.
WHY = (
    "glue is stable only when both sides step once in every window, one after the other: at a "
    "ratio of 2 it gains 28 % of its energy in thirty transits of a wave, at 4 66 %; in parallel "
    "it grows without bound, iterated it loses 15 % in ten"
)


@parameters
class GlueKeys:
    """Particles hang on the faces of a mesh.

    Parameters
    ----------
    between
        The particles and the mesh, in either order.
    substeps : 1
        Steps of one side in a step of the other: 1, as any other number feeds energy in.
    """

    between: Between
    substeps: Count = 1

    def __post_init__(self) -> None:
        if self.substeps != 1:
            raise ValueError(f"substeps must be 1; found {self.substeps}: {WHY}. Leave it out.")


@with_keys(GlueKeys)
def make(name: str, given: GlueKeys, ports: Mapping[str, Ports]) -> Link:
    """Make a link of steps that are equal on both sides."""
    return join(name, given.between, ports)


def join(name: str, pair: tuple[str, str], ports: Mapping[str, Ports]) -> "Glue":
    """Match two components: one has glued particles, the other faces with nodes."""
    first, second = pair
    complaints = []
    for particles, mesh in ((first, second), (second, first)):
        moved, loaded = (not is_stand_in(ports[one]) for one in (particles, mesh))
        lacks = requires(ports[particles], particles, GLUED if moved else None, GLUED_LOAD)
        lacks += requires(ports[mesh], mesh, NODE_LOAD if loaded else None, NODE_GLUE)
        if not lacks:
            gives = {port.name for port in ports[mesh][1]}
            takes = {port.name for port in ports[particles][0]}
            frees = FACE_ACTIVITY.name in gives and GLUE_ACTIVITY.name in takes
            return Glue(name, particles, mesh, (loaded, moved, frees))
        complaints.append("; ".join(lacks))
    raise SceneError(f"link {name}: glue needs: {' or: '.join(complaints)}. Link others.")


class Glue:
    """Forces and masses to nodes, velocities back."""

    def __init__(self, name: str, particles: str, mesh: str, ways: tuple[bool, bool, bool]) -> None:
        """Glue two components; `ways`: force to the mesh, motion and freeing to the particles."""
        self.name, self.particles, self.mesh, self.ways = name, particles, mesh, ways
        self.partner: dict[str, str] = {}
        self.works: dict[str, Works] = {particles: [("glued_load.force", "glued.velocity", "")]}
        load = Transfer(
            particles,
            mesh,
            reads=("glued_load.force",),
            fills=("node_load.force",),
            sums=(FORCE,),
            works_on=(("node_load.force", "node_glue.velocity", "integral"),),
        )
        move = Transfer(mesh, particles, reads=("node_glue.velocity",), fills=("glued.velocity",))
        free = Transfer(mesh, particles, reads=(ERODED[0],), fills=(ERODED[1],))
        self.transfers = self._those((load, move, free))

    def _those(self, each: tuple[T, T, T]) -> tuple[T, ...]:
        """Of three things for the three ways, those of the ways that it has."""
        return tuple(one for one, has in zip(each, self.ways, strict=True) if has)

    def demands(self) -> Demands:
        """One step of both sides in every window, one after the other."""
        return Demands(equal_steps=True, schemes=("serial",), reason=WHY)

    def bind(self, described: Mapping[str, Fields]) -> Binding:
        """Hang the particles on the faces, and their mass on the nodes."""
        glued, mesh = described[self.particles], described[self.mesh]
        shape = project(
            glued["glued_load.position"], mesh["node_glue.start"], mesh["node_glue.corner"]
        ).shape
        mass = shape.map_conservative(glued["glued_load.mass"][:, None])[:, 0]

        def load(_: Ends, end: Ends) -> Mapped:
            return {FORCE[1]: shape.map_conservative(end[self.particles][FORCE[0]])}

        def move(_: Ends, end: Ends) -> Mapped:
            return {"glued.velocity": shape.map_consistent(end[self.mesh]["node_glue.velocity"])}

        def free(_: Ends, end: Ends) -> Mapped:
            return {ERODED[1]: end[self.mesh][ERODED[0]][shape.face]}

        static = {self.mesh: {"node_load.added_mass": mass}}
        return Binding(static, self._those((load, move, free)))
