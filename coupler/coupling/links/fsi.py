"""Fluid and structure: surface samples move with bodies or faces, whose loads they map back.

The fluid takes samples and gives a force on each; it never learns what moves them. The body
gives its shape or its faces; it never learns how finely they are sampled. `contact` says what
presses between the fluid and the samples of this link: what does at the fluid's walls, or a contact
potential, of a fluid whose port asks for it.
"""

from collections.abc import Mapping
from functools import partial
from typing import Any

import numpy as np

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
from quintet.coupler.coupling.links.keys import between
from quintet.coupler.coupling.mapping import RigidMap, sample_faces
from quintet.coupler.coupling.rigid_samples import (
    Sampling,
    asked_sampling,
    body_widths,
    sample_bodies,
    unsampled,
)
from quintet.coupler.coupling.start_positions import misplaced
from quintet.interfaces.component import Array, Fields, Port
from quintet.interfaces.errors import LinkError, SceneError
from quintet.interfaces.params import shown
from quintet.interfaces.ports import (
    CONTACT,
    DIMENSIONS,
    FACES,
    LOAD,
    MIRRORED_SURFACE,
    MOTION,
    NODE_LOAD,
    SURFACE,
    SURFACE_LOAD,
)

NEARLY = 1e-9  # m
CONTACTS = ("walls", "potential")  # as at the fluid's walls, or by a contact potential
WORK = ("surface_load.force", "surface.velocity", "surface.position")


def make(number: int, given: dict[str, Any], ports: Mapping[str, Ports]) -> Link:
    """Make the link of a scene's table: ``between``, and which ``contact`` it asks for."""
    name, pair = between(number, given, ports, "contact")
    contact = given.get("contact", CONTACTS[0])
    if contact not in CONTACTS:
        raise SceneError(
            f"links.{number}.contact must be one of {', '.join(CONTACTS)}, as at the fluid's walls "
            f"or by a contact potential; found {shown(contact)}. Correct it, or leave it out for "
            "walls."
        )
    return join(name, pair, ports, contact == "potential")


def join(
    name: str, pair: tuple[str, str], ports: Mapping[str, Ports], potential: bool = False
) -> "RigidFsi | FaceFsi":
    """Match two components: one samples a surface, the other moves bodies or faces.

    With `potential` the fluid is asked to press on the samples by a contact potential.
    """
    first, second = pair
    for fluid, body in ((first, second), (second, first)):
        takes = {port.name for port in ports[fluid][0]}
        gives = {port.name for port in ports[body][1]}
        if SURFACE.name not in takes or not gives & {MOTION.name, FACES.name}:
            continue
        rigid = MOTION.name in gives
        motion, load = (MOTION, LOAD) if rigid else (FACES, NODE_LOAD)
        lacks = requires(ports[fluid], fluid, MIRRORED_SURFACE, SURFACE_LOAD)
        # What is moved by a path or a recording takes no load, and is sent none.
        loaded = load.name in {port.name for port in ports[body][0]}
        lacks += requires(ports[body], body, load if loaded else None, motion)
        if lacks:
            raise SceneError(f"link {name}: {'; '.join(lacks)}. Correct the ports.")
        surface = next(port for port in ports[fluid][0] if port.name == SURFACE.name)
        mirrored = any(field.name == "mirror" for field in surface.fields)
        moving = next(port for port in ports[body][1] if port.name == motion.name)
        _same_dimensions(name, {fluid: surface, body: moving})
        contact = _contact(name, fluid, surface, potential)
        kind = RigidFsi if rigid else FaceFsi
        return kind(name, fluid, body, mirrored, contact, loaded)
    raise SceneError(
        f"link {name}: fsi needs a component that takes surface and gives surface_load, and one "
        f"that gives motion and takes load, or gives faces and takes node_load; {first} takes "
        f"{_names(ports[first][0])} and gives {_names(ports[first][1])}, {second} takes "
        f"{_names(ports[second][0])} and gives {_names(ports[second][1])}. Link others."
    )


def _same_dimensions(name: str, ports: Mapping[str, Port]) -> None:
    """Refuse a fluid of two dimensions beside bodies of three, and the reverse."""
    planar = [
        one
        for one, port in ports.items()
        if any(field.name == DIMENSIONS.name for field in (*port.static, *port.states))
    ]
    if len(planar) == 1:
        (solid,) = set(ports) - set(planar)
        raise SceneError(
            f"link {name}: both sides must have two dimensions or both three; {planar[0]} has two, "
            f"{solid} has three. Set dimensions = 2 in both, or 3 in both."
        )


def _contact(name: str, fluid: str, surface: Port, potential: bool) -> float | None:
    """Code of what presses on the samples, for a fluid that lets its links choose it."""
    if any(field.name == CONTACT.name for field in surface.static):
        return float(potential)
    if potential:
        raise SceneError(
            f"link {name}: contact potential needs a fluid that lets links choose their contact; "
            f"port {surface.name} of {fluid} does not say {CONTACT.name}. Remove contact, or "
            f"choose a boundary of {fluid} that does, without films."
        )
    return None


def _marks(contact: float | None, samples: int) -> dict[str, Array]:
    """Static field that tells the fluid what presses on these samples, if it asks."""
    return {} if contact is None else {"surface.contact": np.full(samples, contact)}


def _thick(name: str, stated: Fields) -> list[str]:
    """Refuse a slab in which what samples stand for, 1 m along y, is not what the fluid has."""
    return [
        f"in two dimensions samples stand for 1 m along y, and so must {name}; its boxes reach "
        f"over {thickness:g} m. Let them, and the walls, reach over 1 m."
        for thickness in stated.get("surface.thickness", ())
        if abs(thickness - 1.0) > NEARLY
    ]


def _names(ports: tuple[Port, ...]) -> str:
    return ", ".join(port.name for port in ports) or "nothing"


class RigidFsi:
    """Samples ride on rigid bodies; their forces become a force and a torque on each."""

    def __init__(
        self,
        name: str,
        fluid: str,
        body: str,
        mirrored: bool = False,
        contact: float | None = None,
        loaded: bool = True,
    ) -> None:
        self.name, self.fluid, self.body = name, fluid, body
        self.mirrored, self.contact = mirrored, contact
        self.partner = {fluid: SURFACE.name}
        self.works: dict[str, Works] = {fluid: [WORK]}
        poses = tuple(f"motion.{one.name}" for one in MOTION.fields)
        move = Transfer(body, fluid, reads=poses, fills=_sampled(mirrored))
        load = Transfer(
            fluid,
            body,
            reads=("surface_load.force",),
            fills=("load.force", "load.torque"),
            needs=poses,
            sums=(("surface_load.force", "load.force"),),
            works_on=(
                ("load.force", "motion.velocity", "motion.position"),
                ("load.torque", "motion.angular_velocity", "motion.orientation"),
            ),
        )
        self.transfers = (move, load) if loaded else (move,)

    def demands(self) -> Demands:
        """Nothing: any steps, any scheme."""
        return Demands()

    def bind(self, described: Mapping[str, Fields]) -> Binding:
        """Sample every body at the fluid's spacing."""
        asked, bodies = asked_sampling(described[self.fluid]), described[self.body]
        if wrong := self.refuses(described):
            raise LinkError("\n".join(wrong))
        found = sample_bodies(bodies, asked, self.mirrored)
        samples = RigidMap(found.arm, found.body, len(bodies["motion.shape"]))
        mirror = None
        if found.image is not None:
            mirror = RigidMap(found.image, found.body, samples.bodies)
        static = {
            self.fluid: {
                "surface.normal": found.normal,
                "surface.volume": found.volume,
                "surface.body": found.body.astype(np.float64),
                **_marks(self.contact, len(found.body)),
            }
        }
        count = len(self.transfers)
        maps = (partial(self._move, samples, mirror), partial(self._load, samples))
        return Binding(static, maps[:count], (None, self._moment)[:count])

    def refuses(self, initial: Mapping[str, Fields]) -> list[str]:
        """See `exchange.refused_starts`."""
        fluid, bodies = initial.get(self.fluid, {}), initial.get(self.body, {})
        if "surface.spacing" not in fluid:
            return []
        asked, where = asked_sampling(fluid), f"link {self.name}: "
        wrong = _thick(self.fluid, fluid)
        if "motion.shape" in bodies:
            wrong += unsampled(self.body, bodies, asked.planar) or self._thin(bodies, asked)
            if not wrong and "motion.position" in bodies:
                wrong += misplaced((self.fluid, self.body), fluid, bodies, asked)
        return [where + sentence for sentence in wrong]

    def _thin(self, bodies: Fields, asked: Sampling) -> list[str]:
        widths, least = body_widths(bodies, asked.planar), asked.least
        return [
            f"a body must be at least {least:g} m across, a spacing of "
            f"{self.fluid} and twice the depth of the outermost samples it wants; body "
            f"{body} of {self.body} is {widths[body]:g} m. Refine the spacing "
            f"of {self.fluid}, or leave the body out."
            for body in np.flatnonzero(widths < least)[:1]
        ]

    def _move(self, samples: RigidMap, mirror: RigidMap | None, _: Ends, end: Ends) -> Mapped:
        given = end[self.body]
        pose = (given[f"motion.{one.name}"] for one in MOTION.fields)
        position, velocity = samples.gather(*pose)
        moved = {"surface.position": position, "surface.velocity": velocity}
        if mirror is not None:
            arms = mirror.arms(given["motion.orientation"])
            moved["surface.mirror"] = given["motion.position"][samples.body] + arms
        return moved

    def _load(self, samples: RigidMap, start: Ends, end: Ends) -> Mapped:
        # An impulse was gathered along the way between the two poses: use their middle.
        turns = [one[self.body]["motion.orientation"] for one in (start, end)]
        arms = 0.5 * (samples.arms(turns[0]) + samples.arms(turns[1]))
        force, torque = samples.spread(end[self.fluid]["surface_load.force"], arms)
        return {"load.force": force, "load.torque": torque}

    def _moment(self, start: Ends, end: Ends, mapped: Fields) -> Array:
        centre = 0.5 * (start[self.body]["motion.position"] + end[self.body]["motion.position"])
        turn = np.cross(centre, mapped["load.force"]) + mapped["load.torque"]
        return np.asarray(turn.sum(axis=0))


class FaceFsi:
    """Samples lie on the faces of a mesh; their forces go to its nodes."""

    def __init__(
        self,
        name: str,
        fluid: str,
        body: str,
        mirrored: bool = False,
        contact: float | None = None,
        loaded: bool = True,
    ) -> None:
        self.name, self.fluid, self.body = name, fluid, body
        self.mirrored, self.contact = mirrored, contact
        self.partner = {fluid: SURFACE.name}
        self.works: dict[str, Works] = {fluid: [WORK]}
        faces = ("faces.position", "faces.velocity")
        move = Transfer(body, fluid, reads=faces, fills=_sampled(mirrored))
        load = Transfer(
            fluid,
            body,
            reads=("surface_load.force",),
            fills=("node_load.force",),
            sums=(("surface_load.force", "node_load.force"),),
            works_on=(("node_load.force", "faces.velocity", "faces.position"),),
        )
        self.transfers = (move, load) if loaded else (move,)

    def demands(self) -> Demands:
        """Nothing: any steps, any scheme."""
        return Demands()

    def bind(self, described: Mapping[str, Fields]) -> Binding:
        """Sample every face at the fluid's spacing."""
        spacing = float(described[self.fluid]["surface.spacing"][0])
        mesh = described[self.body]
        shape, area, normal = sample_faces(mesh["faces.start"], mesh["faces.corner"], spacing)

        def move(_: Ends, end: Ends) -> Mapped:
            moved = {
                "surface.position": shape.gather(end[self.body]["faces.position"]),
                "surface.velocity": shape.gather(end[self.body]["faces.velocity"]),
            }
            if self.mirrored:  # samples lie on the faces, each its own image
                moved["surface.mirror"] = moved["surface.position"]
            return moved

        def load(_: Ends, end: Ends) -> Mapped:
            return {"node_load.force": shape.spread(end[self.fluid]["surface_load.force"])}

        static = {
            self.fluid: {
                "surface.normal": normal,
                "surface.volume": area * spacing,
                "surface.body": np.zeros(len(area)),
                **_marks(self.contact, len(area)),
            }
        }
        return Binding(static, (move, load)[: len(self.transfers)])


def _sampled(mirrored: bool) -> tuple[str, ...]:
    """Inputs of a fluid whose surface samples are moved."""
    moved = ("surface.position", "surface.velocity")
    return (*moved, "surface.mirror") if mirrored else moved
