"""Glue: particles hang on the faces of a mesh, give it force and mass, and move with it.

Seed: Dyanov, Kazantsev, Chelakov, LOGOS, equations 2 to 4: f_M += φ f_S, M_M += φ m_S,
v_S = Σ φ v_M, with the shape functions φ of the face on which a particle lies at the start.

Where a face erodes its particles are freed, and their mass is taken off the nodes. A particle goes
on as its nodes gave it out; the force that it gave last acts on these, and none on it in its first
free step: so momentum stays to rounding, where the mesh steps before the particles.
"""

from collections.abc import Mapping
from typing import NamedTuple, TypeVar

import numpy as np

from quintet.coupler.coupling.link import (
    Binding,
    Demands,
    Ends,
    Link,
    Mapped,
    Ports,
    Transfer,
)
from quintet.coupler.coupling.links.keys import Between, is_stand_in, with_keys
from quintet.coupler.coupling.links.port_checks import fewest, requires
from quintet.coupler.coupling.links.sampled_structures import OF_POINTS, answered
from quintet.coupler.coupling.mapping import ShapeMap
from quintet.interfaces.component import Array, Fields
from quintet.interfaces.errors import LinkError, SceneError
from quintet.interfaces.params import Count, Positive, parameters
from quintet.interfaces.ports import (
    FACE_ACTIVITY,
    GLUE_ACTIVITY,
    GLUED,
    GLUED_LOAD,
    NODE_GLUE,
    NODE_LOAD,
    NODE_MASS,
)

T = TypeVar("T")
FORCE = ("glued_load.force", "node_load.force")
ERODED = ("face_activity.active", "glue_activity.active")
HUNG = "node_mass.added"
BESIDE = 0.1  # of a longest side: particles further beside all faces are above none
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
    reach : 1
        How far from its face a particle may lie at the start, over the longest side of the face.
    """

    between: Between
    substeps: Count = 1
    reach: Positive = 1.0

    def __post_init__(self) -> None:
        if self.substeps != 1:
            raise ValueError(f"substeps must be 1; found {self.substeps}: {WHY}. Leave it out.")


@with_keys(GlueKeys)
def make(name: str, keys: GlueKeys, ports: Mapping[str, Ports]) -> Link:
    """Make a link of steps that are equal on both sides."""
    return join(name, keys.between, ports, keys.reach)


def join(
    name: str, pair: tuple[str, str], ports: Mapping[str, Ports], reach: float = 1.0
) -> "Glue":
    """Match two components: one has glued particles, the other faces with nodes."""
    first, second = pair
    complaints = []
    for particles, mesh in ((first, second), (second, first)):
        moved, loaded = (not is_stand_in(ports[side]) for side in (particles, mesh))
        lacks = requires(ports[particles], particles, GLUED if moved else None, GLUED_LOAD)
        lacks += requires(ports[mesh], mesh, NODE_LOAD if loaded else None, NODE_GLUE)
        if not lacks:
            takes, gives = ({port.name for port in side} for side in ports[mesh])
            freed = GLUE_ACTIVITY.name in {port.name for port in ports[particles][0]}
            frees = FACE_ACTIVITY.name in gives and freed
            returns = frees and NODE_MASS.name in takes
            return Glue(name, (particles, mesh), Ways(loaded, moved, frees, returns), reach)
        complaints.append(lacks)
    raise SceneError(f"link {name}: glue needs: {fewest(complaints)}. Link others.")


class Ways(NamedTuple):
    """What crosses a glued interface; stand-ins take nothing."""

    loads: bool  # forces to the mesh
    moves: bool  # velocities to the particles
    frees: bool  # which faces eroded, to the particles
    returns: bool  # what still hangs on the nodes, to the mesh


class Glue(Link):
    """Forces and masses to nodes, velocities back."""

    def __init__(self, name: str, pair: tuple[str, str], ways: Ways, reach: float) -> None:
        self.name, (self.particles, self.mesh), self.ways, self.reach = name, pair, ways, reach
        particles, mesh = pair
        returned = ways.loads and ways.returns
        load = Transfer(
            particles,
            mesh,
            reads=("glued_load.force",),
            fills=("node_load.force", HUNG) if returned else ("node_load.force",),
            needs=(ERODED[0],) if returned else (),
        )
        move = Transfer(
            mesh,
            particles,
            reads=("node_glue.velocity",),
            fills=("glued.velocity",),
            conservative=False,
        )
        free = Transfer(mesh, particles, reads=(ERODED[0],), fills=(ERODED[1],))
        self.transfers = self._those((load, move, free))

    def _those(self, each: tuple[T, T, T]) -> tuple[T, ...]:
        """Of three things for the first three ways, those of the ways that it has."""
        return tuple(way for way, has in zip(each, self.ways[:3], strict=True) if has)

    def demands(self) -> Demands:
        """One step of both sides in every window, one after the other."""
        return Demands(equal_steps=True, schemes=("serial",), reason=WHY)

    def requests(self, described: Mapping[str, Fields]) -> dict[str, Fields]:
        """On which faces the particles hang."""
        points = described[self.particles]["glued_load.position"]
        return {self.mesh: {f"{NODE_GLUE.name}.points": points}}

    def bind(self, described: Mapping[str, Fields]) -> Binding:
        """Hang the particles on the faces, and their mass on the nodes."""
        glued, mesh = described[self.particles], described[self.mesh]
        samples = answered(self.name, self.mesh, NODE_GLUE.name, mesh, OF_POINTS)
        node, weight, face, gap, size, beyond = samples
        on = face.astype(np.int64)  # (particles,) face of each
        self._refuse_outside(glued["glued_load.position"], on, gap, size, beyond)
        shape = ShapeMap(node.astype(np.int64), weight, len(mesh["node_glue.start"]))
        each = glued["glued_load.mass"]
        mass = _hung(shape, each)
        returned = HUNG in self.transfers[0].fills

        def load(_: Ends, end: Ends) -> Mapped:
            mapped = {FORCE[1]: shape.map_conservative(end[self.particles][FORCE[0]])}
            if returned:
                active = end[self.mesh][ERODED[0]][on]
                mapped[HUNG] = mass if active.all() else _hung(shape, each * active)
            return mapped

        def move(_: Ends, end: Ends) -> Mapped:
            return {"glued.velocity": shape.map_consistent(end[self.mesh]["node_glue.velocity"])}

        def free(_: Ends, end: Ends) -> Mapped:
            return {ERODED[1]: end[self.mesh][ERODED[0]][on]}

        static = {self.mesh: {"node_load.added_mass": mass}}
        return Binding(static, self._those((load, move, free)))

    def _refuse_outside(
        self, place: Array, face: Array, gap: Array, size: Array, beyond: Array
    ) -> None:
        """Refuse particles that lie beside all faces, or too far above them."""
        beside, far = beyond > BESIDE * size, gap > self.reach * size
        for row in np.flatnonzero(beside | far)[:1]:
            how = f"{beyond[row]:.3g} m beside" if beside[row] else f"{gap[row]:.3g} m from"
            raise LinkError(
                f"link {self.name}: a glued particle must lie above a face of {self.mesh}, no "
                f"further from it than reach = {self.reach:g} of its longest side; particle {row} "
                f"of {self.particles}, at {np.array2string(place[row], precision=4)} m, is {how} "
                f"the nearest one, face {face[row]} of {size[row]:.3g} m. Let "
                "the faces reach under all glued particles, glue fewer, or raise reach."
            )


def _hung(shape: ShapeMap, mass: Array) -> Array:
    """Mass (nodes,) kg that hangs on the nodes, of particles (n,) kg."""
    return shape.map_conservative(mass[:, None])[:, 0]
