"""Contact: particles, bodies or a mesh touch the faces of a mesh, with penalty forces.

The side with the particles gets the faces as they move, finds what touches and computes the forces,
in each of its own steps; the mesh gets their reaction at its nodes. So friction has its history
where state is saved, and both sides get the same impulse, at any number of steps. Of two meshes one
has points on its faces in the place of particles. The link names the coefficients; it computes
nothing but the closing of faces.
"""

from collections.abc import Mapping
from typing import Annotated, NamedTuple

import numpy as np
from pydantic import Field

from quintet.coupler.coupling.link import Binding, Demands, Ends, Link, Mapped, Ports, Transfer
from quintet.coupler.coupling.links.keys import Between, is_stand_in, with_keys
from quintet.coupler.coupling.links.port_checks import (
    fewest,
    refuse_other_dimensions,
    requires,
)
from quintet.interfaces.component import Array, Fields, Port
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import NotNegative, Positive, parameters
from quintet.interfaces.ports import (
    CONTACT_ACTIVITY,
    CONTACT_LOAD,
    CONTACT_SURFACE_LOAD,
    NODE_LOAD,
    OPEN_FACES,
    PLANAR_CONTACT_FACES,
    PLANAR_CONTACT_SURFACE,
)

MOTION = ("position", "velocity")
OF_NODES = ("mass",)
OF_FACES = ("bulk", "shear", "thickness")
WHY = (
    "a penalty force must follow the motion of both sides in every step: both step once in every "
    "window, and the side with contact_with_faces, which computes the force, steps before the mesh "
    "that it acts on"
)


@parameters
class ContactKeys:
    """Particles, bodies or a mesh touch the faces of a mesh.

    Parameters
    ----------
    between
        The particles or bodies, and the mesh, in either order. Of two meshes the side with
        `contact_with_faces` computes the forces; if both have it, the first.
    friction : 1
        Coulomb's coefficient.
    stiffness : 1
        Scale of the stiffness (SLSFAC). At 1 a contact of particles gives way as much as one layer
        of particles and one layer of elements under the same pressure, two meshes as one layer of
        each, and spheres follow Hertz.
    safety : 1
        Share of the predicted stable step of contact that is used.
    points_across : 1
        Points across a particle, along both sides, that bear its force on the faces below them; 1
        if not given. With 3 flat bodies press alike on faces that the spacing does not divide; it
        takes more time. It must be 1 for spheres. Of two meshes: number of contact points across
        each face of the other mesh, 4 if not given.
    """

    between: Between
    friction: NotNegative = 0.0
    stiffness: Positive = 1.0
    safety: Positive = 0.9
    points_across: Annotated[int, Field(ge=1, le=4)] | None = None


class Coefficients(NamedTuple):
    """Numbers of the link, the same for all of its faces."""

    friction: float
    stiffness: float
    safety: float
    points: int  # 0: as many as the component takes by itself


@with_keys(ContactKeys)
def make(name: str, keys: ContactKeys, ports: Mapping[str, Ports]) -> Link:
    """Make a link with its coefficients."""
    points = keys.points_across or 0
    coefficients = Coefficients(keys.friction, keys.stiffness, keys.safety, points)
    return join(name, keys.between, ports, coefficients)


def join(
    name: str, pair: tuple[str, str], ports: Mapping[str, Ports], coefficients: Coefficients
) -> "Contact":
    """Match two components: one computes contact forces, the other has faces with nodes."""
    complaints = []
    for particles, mesh in (pair, pair[::-1]):
        loaded = not is_stand_in(ports[mesh])
        lacks = requires(ports[particles], particles, PLANAR_CONTACT_FACES, CONTACT_LOAD)
        lacks += requires(ports[mesh], mesh, NODE_LOAD if loaded else None, PLANAR_CONTACT_SURFACE)
        if not lacks:
            faces = _named(ports[particles][0], PLANAR_CONTACT_FACES)
            surface = _named(ports[mesh][1], PLANAR_CONTACT_SURFACE)
            refuse_other_dimensions(name, {particles: faces, mesh: surface})
            takes, gives = ({port.name for port in side} for side in ports[mesh])
            load = CONTACT_SURFACE_LOAD if CONTACT_SURFACE_LOAD.name in takes else NODE_LOAD
            ways = Ways(load.name if loaded else "", OPEN_FACES.name in gives)
            return Contact(name, particles, mesh, coefficients, ways)
        complaints.append(lacks)
    raise SceneError(f"link {name}: contact needs: {fewest(complaints)}. Link others.")


def _named(ports: tuple[Port, ...], wanted: Port) -> Port:
    return next(port for port in ports if port.name == wanted.name)


class Ways(NamedTuple):
    """What crosses beside motion."""

    load: str  # port by which the mesh takes forces; none of a stand-in
    opens: bool  # whether the mesh says which of its faces are open

    @property
    def erodes(self) -> bool:
        """Whether erosion may open inner faces, which the mesh lists on request."""
        return self.load == CONTACT_SURFACE_LOAD.name


class Contact(Link):
    """Motion of faces to what touches them, forces back to their nodes."""

    def __init__(
        self, name: str, particles: str, mesh: str, coefficients: Coefficients, ways: Ways
    ) -> None:
        self.name, self.particles, self.mesh = name, particles, mesh
        self.coefficients, self.ways = coefficients, ways
        surface = tuple(f"{PLANAR_CONTACT_SURFACE.name}.{field}" for field in MOTION)
        move = Transfer(
            mesh,
            particles,
            reads=(*surface, f"{OPEN_FACES.name}.active") if ways.opens else surface,
            fills=(
                *(f"{PLANAR_CONTACT_FACES.name}.{field}" for field in MOTION),
                f"{CONTACT_ACTIVITY.name}.active",
            ),
            conservative=False,
        )
        load = Transfer(
            particles,
            mesh,
            reads=(f"{CONTACT_LOAD.name}.force",),
            fills=(f"{ways.load}.force",),
        )
        self.transfers = (move, load) if ways.load else (move,)

    def demands(self) -> Demands:
        """One step of both sides in every window, the particles first."""
        return Demands(
            equal_steps=True,
            schemes=("serial",),
            reason=WHY,
            judged=False,
            first=(self.particles, self.mesh),
        )

    def requests(self, described: Mapping[str, Fields]) -> dict[str, Fields]:
        """Which inner faces of the mesh erosion may open."""
        inner = f"{PLANAR_CONTACT_SURFACE.name}.inner"
        return {self.mesh: {inner: np.ones(1)}} if self.ways.erodes else {}

    def bind(self, described: Mapping[str, Fields]) -> Binding:
        """Hand on what describes the faces, with the coefficients of the link."""
        name = PLANAR_CONTACT_SURFACE.name
        mesh = {
            key.partition(".")[2]: array
            for key, array in described[self.mesh].items()
            if key.startswith(f"{name}.")
        }
        corner = closed(mesh["corner"])
        count, of = len(corner), self.coefficients
        static = {
            "corner": corner,
            "width": widths(mesh["start"], corner),
            "friction": np.full(count, of.friction),
            "stiffness": np.full(count, of.stiffness),
            "safety": np.array([of.safety]),
            "points": np.array([float(of.points)]),
            **{key: mesh[key] for key in (*OF_NODES, *OF_FACES, "step")},
        }
        if "dimensions" in mesh:
            static["dimensions"] = mesh["dimensions"]
        always = np.ones(count)

        def move(_: Ends, end: Ends) -> Mapped:
            outputs = end[self.mesh]
            moved = {
                f"{PLANAR_CONTACT_FACES.name}.{field}": outputs[f"{name}.{field}"]
                for field in MOTION
            }
            active = outputs[f"{OPEN_FACES.name}.active"] if self.ways.opens else always
            return moved | {f"{CONTACT_ACTIVITY.name}.active": active}

        def load(_: Ends, end: Ends) -> Mapped:
            return {f"{self.ways.load}.force": end[self.particles][f"{CONTACT_LOAD.name}.force"]}

        taken = {f"{PLANAR_CONTACT_FACES.name}.{key}": array for key, array in static.items()}
        return Binding({self.particles: taken}, (move, load)[: len(self.transfers)])


def widths(node: Array, corner: Array) -> Array:
    """Length (m,) m of the shortest side of faces, closed, of their nodes at (k, 3) m."""
    x = node[corner.astype(np.int64)]
    side = np.linalg.norm(x - np.roll(x, 1, axis=1), axis=2)
    return np.asarray(np.where(side > 0.0, side, np.inf).min(axis=1, initial=np.inf))


def closed(face: Array) -> Array:
    """Corners (m, 4) of faces, closed: the last of a triangle stands twice, edges go back."""
    third = np.where(face[:, 2] < 0.0, face[:, 1], face[:, 2])
    back = np.where(face[:, 2] < 0.0, face[:, 0], third)
    fourth = np.where(face[:, 3] < 0.0, back, face[:, 3])
    return np.stack([face[:, 0], face[:, 1], third, fourth], axis=1)
