"""Structures that a fluid samples: rigid bodies and deforming faces, how they move and take loads.

Whoever moves a structure says where its samples are; they ride on it, and their forces go back by
the transpose of the same map.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial

import numpy as np

from quintet.coupler.coupling.link import Binding, Ends, Mapped
from quintet.coupler.coupling.mapping import OffsetMap, RigidMap, ShapeMap
from quintet.interfaces.component import Array, Fields, Port
from quintet.interfaces.errors import LinkError
from quintet.interfaces.ports import DIMENSIONS, FACES, LOAD, MOTION, NODE_LOAD

POSES = tuple(f"motion.{field.name}" for field in MOTION.fields)
# What an answer to a request for samples holds, and the shape of one row.
OF_BODIES: dict[str, tuple[int, ...]] = {"arm": (3,), "normal": (3,), "volume": (), "body": ()}
OF_FACES: dict[str, tuple[int, ...]] = {
    "node": (4,), "weight": (4,), "along": (4,), "across": (4,),
    "depth": (), "side": (3,), "normal": (3,), "volume": (),
}  # fmt: skip
OF_POINTS: dict[str, tuple[int, ...]] = {
    "node": (4,), "weight": (4,), "face": (), "gap": (), "size": (), "beyond": (),
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Sampling:
    """Whose surface is sampled for which fluid, and what that fluid asks of samples."""

    link: str
    fluid: str
    body: str
    mirrored: bool  # whether each sample has an image within the body
    contact: float | None  # code of what presses on samples, of a fluid that lets links choose


@dataclass(frozen=True, slots=True)
class Structure:
    """Ports and fields of one kind of structure, and how its samples move."""

    motion: Port
    load: Port
    reads: tuple[str, ...]  # fields that move samples
    fills: tuple[str, ...]  # fields that their forces become
    needs: tuple[str, ...]  # fields of the structure that this takes
    bind: Callable[[Sampling, Fields], Binding]


def request(of: Sampling, port: str, stated: Fields) -> dict[str, Array]:
    """What a fluid that states this asks of whoever moves a structure, by `Component.sample`."""
    spacing = stated["surface.spacing"]
    asked = {
        "spacing": spacing,
        "depth": stated["surface.depth"],
        "inset": stated.get("surface.inset", 0.5 * spacing),
        "mirror": np.array([float(of.mirrored)]),
        "dimensions": stated.get(f"surface.{DIMENSIONS.name}", np.array([3.0])),
    }
    return {f"{port}.{name}": np.asarray(array, np.float64) for name, array in asked.items()}


def answered(
    link: str, name: str, port: str, answer: Fields, shapes: Mapping[str, tuple[int, ...]]
) -> list[Array]:
    """Fields of an answer to a request for samples, checked: a row for each sample."""
    answers = [answer.get(f"{port}.{field}") for field in shapes]
    rows = -1 if answers[0] is None else len(answers[0])
    for (field, shape), array in zip(shapes.items(), answers, strict=True):
        if array is None or array.shape != (rows, *shape):
            raise LinkError(
                f"link {link}: sample of {name} must answer with {port}.{field} of shape "
                f"{('n', *shape)}, a row for each sample; found "
                f"{'none' if array is None else array.shape}. Correct it."
            )
    return [array for array in answers if array is not None]


def _bind_bodies(of: Sampling, bodies: Fields) -> Binding:
    """Let samples ride on rigid bodies."""
    arm, normal, volume, number = answered(of.link, of.body, "motion", bodies, OF_BODIES)
    owner, count = number.astype(np.int64), len(bodies["motion.mass"])
    samples, mirror = RigidMap(arm, owner, count), None
    if of.mirrored:
        (image,) = answered(of.link, of.body, "motion", bodies, {"image": (3,)})
        mirror = RigidMap(image, owner, count)
    maps = (partial(_move_bodies, of.body, samples, mirror), partial(_load_bodies, of, samples))
    return Binding(_static(of, normal, volume, number), maps, (None, partial(_moment, of.body)))


def _static(of: Sampling, normal: Array, volume: Array, body: Array) -> dict[str, Mapped]:
    """Static fields of the samples; what presses on them only if the fluid asks."""
    fields: Mapped = {"surface.normal": normal, "surface.volume": volume, "surface.body": body}
    if of.contact is not None:
        fields["surface.contact"] = np.full(len(body), of.contact)
    return {of.fluid: fields}


def _move_bodies(
    body: str, samples: RigidMap, mirror: RigidMap | None, _: Ends, end: Ends
) -> Mapped:
    outputs = end[body]
    position, velocity = samples.map_consistent(*(outputs[key] for key in POSES))
    moved = {"surface.position": position, "surface.velocity": velocity}
    if mirror is not None:
        arms = mirror.arms(outputs["motion.orientation"])
        moved["surface.mirror"] = outputs["motion.position"][samples.body] + arms
    return moved


def _load_bodies(of: Sampling, samples: RigidMap, start: Ends, end: Ends) -> Mapped:
    # An impulse was gathered along the way between the two poses: use their middle.
    turns = [outputs[of.body]["motion.orientation"] for outputs in (start, end)]
    arms = 0.5 * (samples.arms(turns[0]) + samples.arms(turns[1]))
    force, torque = samples.map_conservative(end[of.fluid]["surface_load.force"], arms)
    return {"load.force": force, "load.torque": torque}


def _moment(body: str, start: Ends, end: Ends, mapped: Fields) -> Array:
    centre = 0.5 * (start[body]["motion.position"] + end[body]["motion.position"])
    turn = np.cross(centre, mapped["load.force"]) + mapped["load.torque"]
    return np.asarray(turn.sum(axis=0))


def _bind_faces(of: Sampling, mesh: Fields) -> Binding:
    """Let samples ride below the faces of a mesh."""
    samples = answered(of.link, of.body, "faces", mesh, OF_FACES)
    node, *weights, depth, side, normal, volume = samples
    nodes = len(mesh["faces.start"])
    surface, along, across = (ShapeMap(node.astype(np.int64), weight, nodes) for weight in weights)
    offset = OffsetMap(surface, along, across, depth, side)
    maps = partial(_move_faces, of, offset), partial(_load_faces, of, offset)
    static = _static(of, normal, volume, np.zeros(len(volume)))
    return Binding(static, maps, (None, partial(_node_moment, of.body)))


def _move_faces(of: Sampling, samples: OffsetMap, _: Ends, end: Ends) -> Mapped:
    position, velocity = (end[of.body][f"faces.{key}"] for key in ("position", "velocity"))
    place, moving, mirror = samples.map_consistent(position, velocity)
    moved = {"surface.position": place, "surface.velocity": moving}
    return moved | {"surface.mirror": mirror} if of.mirrored else moved


def _load_faces(of: Sampling, samples: OffsetMap, start: Ends, end: Ends) -> Mapped:
    # As of bodies: at the middle between the two ends of the window.
    middle = 0.5 * (start[of.body]["faces.position"] + end[of.body]["faces.position"])
    force = end[of.fluid]["surface_load.force"]
    return {"node_load.force": samples.map_conservative(force, middle)}


def _node_moment(body: str, start: Ends, end: Ends, mapped: Fields) -> Array:
    middle = 0.5 * (start[body]["faces.position"] + end[body]["faces.position"])
    return np.asarray(np.cross(middle, mapped["node_load.force"]).sum(axis=0))


RIGID_BODIES = Structure(
    motion=MOTION,
    load=LOAD,
    reads=POSES,
    fills=("load.force", "load.torque"),
    needs=POSES,
    bind=_bind_bodies,
)
FACES_OF_A_MESH = Structure(
    motion=FACES,
    load=NODE_LOAD,
    reads=("faces.position", "faces.velocity"),
    fills=("node_load.force",),
    needs=("faces.position",),
    bind=_bind_faces,
)
