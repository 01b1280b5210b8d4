"""Fluid and structure: surface samples move with bodies or faces, and carry forces back.

The fluid takes samples and gives a force on each; it never learns what moves them. The body
gives its shape or its faces; it never learns how finely they are sampled. `contact` says what
presses between the fluid and the samples of this link: what does at the fluid's walls, or a contact
potential, of a fluid whose port asks for it.
"""

from collections.abc import Mapping

import numpy as np

from quintet.coupler.coupling.body_samples import fill, mirrors
from quintet.coupler.coupling.exchange import Leg, Ports, Works, requires
from quintet.coupler.coupling.mapping import RigidMap, ShapeMap, sample_faces
from quintet.interfaces.component import Array, Fields, Port
from quintet.interfaces.errors import LinkError, SceneError
from quintet.interfaces.ports import (
    CONTACT,
    FACES,
    LOAD,
    MIRRORED_SURFACE,
    MOTION,
    NODE_LOAD,
    SURFACE,
    SURFACE_LOAD,
)

WORK = ("surface_load.force", "surface.velocity", "surface.position")


def join(
    name: str, between: tuple[str, str], ports: Mapping[str, Ports], potential: bool = False
) -> "RigidFsi | FaceFsi":
    """Match two components: one samples a surface, the other moves bodies or faces.

    With `potential` the fluid is asked to press on the samples by a contact potential.
    """
    first, second = between
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
        contact = _contact(name, fluid, surface, potential)
        found = (RigidFsi if rigid else FaceFsi)(name, fluid, body, mirrored, contact)
        found.legs = found.legs if loaded else found.legs[:1]
        return found
    raise SceneError(
        f"link {name}: fsi needs a component that takes surface and gives surface_load, and one "
        f"that gives motion and takes load, or gives faces and takes node_load; {first} takes "
        f"{_names(ports[first][0])} and gives {_names(ports[first][1])}, {second} takes "
        f"{_names(ports[second][0])} and gives {_names(ports[second][1])}. Link others."
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


def _names(ports: tuple[Port, ...]) -> str:
    return ", ".join(port.name for port in ports) or "nothing"


class RigidFsi:
    """Samples ride on rigid bodies; their forces become a force and a torque on each."""

    def __init__(
        self, name: str, fluid: str, body: str, mirrored: bool = False, contact: float | None = None
    ) -> None:
        self.name, self.fluid, self.body = name, fluid, body
        self.mirrored, self.contact = mirrored, contact
        self.map: RigidMap
        self.mirror: RigidMap  # of the samples' mirror points, where the fluid takes them
        # Arms (n, 3) m and centres (bodies, 3) m in the world, at the last two times known.
        self.memory: tuple[tuple[Array, Array], ...] = ()
        self.partner = {fluid: SURFACE.name}
        self.works: dict[str, Works] = {fluid: [WORK]}
        self.legs = [
            Leg(body, fluid, self._move),
            Leg(
                fluid,
                body,
                self._load,
                sums=(("surface_load.force", "load.force"),),
                works_on=(
                    ("load.force", "motion.velocity", "motion.position"),
                    ("load.torque", "motion.angular_velocity", ""),
                ),
                moment=self._moment,
            ),
        ]

    def describe(self, described: Mapping[str, Fields]) -> dict[str, dict[str, Array]]:
        """Sample every body at the fluid's spacing."""
        stated = described[self.fluid]
        spacing, depth = float(stated["surface.spacing"][0]), float(stated["surface.depth"][0])
        inset = float(stated.get("surface.inset", [0.5 * spacing])[0])
        shapes, sizes = described[self.body]["motion.shape"], described[self.body]["motion.size"]
        self._check(sizes, max(spacing, 2.0 * inset))
        pairs = zip(shapes, sizes, strict=True)
        parts = [fill(int(shape), size, spacing, depth, inset) for shape, size in pairs]
        owner = np.repeat(np.arange(len(parts)), [len(arm) for arm, _, _ in parts])
        self.map = RigidMap(np.concatenate([arm for arm, _, _ in parts]), owner, len(parts))
        if self.mirrored:
            images = [
                mirrors(int(shape), size, arm, normal)
                for shape, size, (arm, normal, _) in zip(shapes, sizes, parts, strict=True)
            ]
            self.mirror = RigidMap(np.concatenate(images), owner, len(parts))
        return {
            self.fluid: {
                "surface.normal": np.concatenate([normal for _, normal, _ in parts]),
                "surface.volume": np.concatenate([volume for _, _, volume in parts]),
                "surface.body": owner.astype(np.float64),
                **_marks(self.contact, len(owner)),
            }
        }

    def _check(self, sizes: Array, least: float) -> None:
        widths = sizes.min(axis=1)
        for body in np.flatnonzero(widths < least)[:1]:
            raise LinkError(
                f"link {self.name}: a body must be at least {least:g} m across, a spacing of "
                f"{self.fluid} and twice the depth of the outermost samples it wants; body "
                f"{body} of {self.body} is {widths[body]:g} m. Refine the spacing "
                f"of {self.fluid}, or leave the body out."
            )

    def _move(self, given: Fields) -> dict[str, Array]:
        centre, turn = given["motion.position"], given["motion.orientation"]
        spin, velocity = given["motion.angular_velocity"], given["motion.velocity"]
        arms = self.map.arms(turn)
        self.memory = (*self.memory[-1:], (arms, centre))
        body = self.map.body
        moved = {
            "surface.position": centre[body] + arms,
            "surface.velocity": velocity[body] + np.cross(spin[body], arms),
        }
        if self.mirrored:
            moved["surface.mirror"] = centre[body] + self.mirror.arms(turn)
        return moved

    def _load(self, given: Fields) -> dict[str, Array]:
        if not self.memory:  # before the first window nothing has moved, and nothing was pushed
            rest = np.zeros((self.map.bodies, 3))
            return {"load.force": rest, "load.torque": rest}
        # An impulse was gathered along the way between the last two poses: use their middle.
        arms = 0.5 * (self.memory[0][0] + self.memory[-1][0])
        force, torque = self.map.spread(given["surface_load.force"], arms)
        return {"load.force": force, "load.torque": torque}

    def _moment(self, brought: Fields) -> Array:
        if not self.memory:
            return np.zeros(3)
        centre = 0.5 * (self.memory[0][1] + self.memory[-1][1])
        turn = np.cross(centre, brought["load.force"]) + brought["load.torque"]
        return np.asarray(turn.sum(axis=0))


class FaceFsi:
    """Samples ride on the faces of a mesh; their forces go to its nodes."""

    def __init__(
        self, name: str, fluid: str, body: str, mirrored: bool = False, contact: float | None = None
    ) -> None:
        self.name, self.fluid, self.body = name, fluid, body
        self.mirrored, self.contact = mirrored, contact
        self.map: ShapeMap
        self.memory = None
        self.partner = {fluid: SURFACE.name}
        self.works: dict[str, Works] = {fluid: [WORK]}
        self.legs = [
            Leg(body, fluid, self._move),
            Leg(
                fluid,
                body,
                self._load,
                sums=(("surface_load.force", "node_load.force"),),
                works_on=(("node_load.force", "faces.velocity", "faces.position"),),
            ),
        ]

    def describe(self, described: Mapping[str, Fields]) -> dict[str, dict[str, Array]]:
        """Sample every face at the fluid's spacing."""
        spacing = float(described[self.fluid]["surface.spacing"][0])
        mesh = described[self.body]
        position = mesh["faces.start"]
        self.map, area, normal = sample_faces(position, mesh["faces.corner"], spacing)
        return {
            self.fluid: {
                "surface.normal": normal,
                "surface.volume": area * spacing,
                "surface.body": np.zeros(len(area)),
                **_marks(self.contact, len(area)),
            }
        }

    def _move(self, given: Fields) -> dict[str, Array]:
        moved = {
            "surface.position": self.map.gather(given["faces.position"]),
            "surface.velocity": self.map.gather(given["faces.velocity"]),
        }
        if self.mirrored:  # samples lie on the faces, each its own image
            moved["surface.mirror"] = moved["surface.position"]
        return moved

    def _load(self, given: Fields) -> dict[str, Array]:
        return {"node_load.force": self.map.spread(given["surface_load.force"])}
