"""Structures that a fluid samples: rigid bodies and deforming faces, how they move and take loads.

Samples ride on what moves them, and their forces go back by the transpose of the same map.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial

import numpy as np

from quintet.coupler.coupling.exchange import Binding, Ends, Mapped
from quintet.coupler.coupling.face_samples import sample_faces
from quintet.coupler.coupling.faces import is_planar
from quintet.coupler.coupling.mapping import OffsetMap, RigidMap
from quintet.coupler.coupling.rigid_samples import Sampling as AskedSampling
from quintet.coupler.coupling.rigid_samples import (
    asked_sampling,
    body_widths,
    sample_bodies,
    unsampled,
)
from quintet.coupler.coupling.start_positions import misplaced
from quintet.interfaces.component import Array, Fields, Port
from quintet.interfaces.errors import LinkError
from quintet.interfaces.ports import FACES, LOAD, MOTION, NODE_LOAD

NEARLY = 1e-9  # m
POSES = tuple(f"motion.{one.name}" for one in MOTION.fields)


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
    """Ports and fields of one kind of structure, and how its surface is sampled."""

    motion: Port
    load: Port
    reads: tuple[str, ...]  # fields that move samples
    fills: tuple[str, ...]  # fields that their forces become
    needs: tuple[str, ...]  # fields of the structure that this takes
    works_on: tuple[tuple[str, str, str], ...]
    refuses: Callable[[Sampling, Mapping[str, Fields]], list[str]]  # of how both begin
    bind: Callable[[Sampling, Mapping[str, Fields]], Binding]


def _bind_bodies(of: Sampling, described: Mapping[str, Fields]) -> Binding:
    """Sample every body at the fluid's spacing."""
    asked, bodies = asked_sampling(described[of.fluid]), described[of.body]
    if wrong := _refused_bodies(of, described):
        raise LinkError("\n".join(wrong))
    found = sample_bodies(bodies, asked, of.mirrored)
    samples = RigidMap(found.arm, found.body, len(bodies["motion.shape"]))
    mirror = None
    if found.image is not None:
        mirror = RigidMap(found.image, found.body, samples.bodies)
    static = _static(of, found.normal, found.volume, found.body.astype(np.float64))
    maps = (partial(_move_bodies, of.body, samples, mirror), partial(_load_bodies, of, samples))
    return Binding(static, maps, (None, partial(_moment, of.body)))


def _refused_slab(of: Sampling, initial: Mapping[str, Fields]) -> list[str]:
    """Refuse a slab in which what samples stand for, 1 m along y, is not what the fluid has."""
    return [
        f"link {of.link}: in two dimensions samples stand for 1 m along y, and so must {of.fluid}; "
        f"its boxes reach over {thickness:g} m. Let them, and the walls, reach over 1 m."
        for thickness in initial.get(of.fluid, {}).get("surface.thickness", ())
        if abs(thickness - 1.0) > NEARLY
    ]


def _refused_bodies(of: Sampling, initial: Mapping[str, Fields]) -> list[str]:
    """Refuse also bodies of shapes that cannot be sampled, thin ones, and those out of place."""
    fluid, bodies = initial.get(of.fluid, {}), initial.get(of.body, {})
    wrong = _refused_slab(of, initial)
    if wrong or "surface.spacing" not in fluid or "motion.shape" not in bodies:
        return wrong
    asked = asked_sampling(fluid)
    wrong = unsampled(of.body, bodies, asked.planar) or _thin(of, bodies, asked)
    if not wrong and "motion.position" in bodies:
        wrong = misplaced((of.fluid, of.body), fluid, bodies, asked)
    return [f"link {of.link}: {sentence}" for sentence in wrong]


def _thin(of: Sampling, bodies: Fields, asked: AskedSampling) -> list[str]:
    widths, least = body_widths(bodies, asked.planar), asked.least
    return [
        f"a body must be at least {least:g} m across, a spacing of {of.fluid} and twice the depth "
        f"of the outermost samples it wants; body {body} of {of.body} is {widths[body]:g} m. "
        f"Refine the spacing of {of.fluid}, or leave the body out."
        for body in np.flatnonzero(widths < least)[:1]
    ]


def _static(of: Sampling, normal: Array, volume: Array, body: Array) -> dict[str, Mapped]:
    """Static fields of the samples; what presses on them only if the fluid asks."""
    fields: Mapped = {"surface.normal": normal, "surface.volume": volume, "surface.body": body}
    if of.contact is not None:
        fields["surface.contact"] = np.full(len(body), of.contact)
    return {of.fluid: fields}


def _move_bodies(
    body: str, samples: RigidMap, mirror: RigidMap | None, _: Ends, end: Ends
) -> Mapped:
    given = end[body]
    position, velocity = samples.map_consistent(*(given[key] for key in POSES))
    moved = {"surface.position": position, "surface.velocity": velocity}
    if mirror is not None:
        arms = mirror.arms(given["motion.orientation"])
        moved["surface.mirror"] = given["motion.position"][samples.body] + arms
    return moved


def _load_bodies(of: Sampling, samples: RigidMap, start: Ends, end: Ends) -> Mapped:
    # An impulse was gathered along the way between the two poses: use their middle.
    turns = [one[of.body]["motion.orientation"] for one in (start, end)]
    arms = 0.5 * (samples.arms(turns[0]) + samples.arms(turns[1]))
    force, torque = samples.map_conservative(end[of.fluid]["surface_load.force"], arms)
    return {"load.force": force, "load.torque": torque}


def _moment(body: str, start: Ends, end: Ends, mapped: Fields) -> Array:
    centre = 0.5 * (start[body]["motion.position"] + end[body]["motion.position"])
    turn = np.cross(centre, mapped["load.force"]) + mapped["load.torque"]
    return np.asarray(turn.sum(axis=0))


def _bind_faces(of: Sampling, described: Mapping[str, Fields]) -> Binding:
    """Sample the body below every face as the fluid asks for it."""
    asked, mesh = asked_sampling(described[of.fluid]), described[of.body]
    if wrong := _refused_faces(of, described):
        raise LinkError("\n".join(wrong))
    found = sample_faces(mesh["faces.start"], mesh["faces.corner"], asked)
    if found.room < asked.least * (1.0 - NEARLY):
        raise LinkError(
            f"link {of.link}: a body must be at least {asked.least:g} m thick between its faces, a "
            f"spacing of {of.fluid} and twice the depth of the outermost samples it wants; behind "
            f"face {found.thin} of {of.body} it is {found.room:g} m. Refine the spacing of "
            f"{of.fluid}, or leave one of its sides out of its coupled faces."
        )
    maps = partial(_move_faces, of, found.offset), partial(_load_faces, of, found.offset)
    static = _static(of, found.normal, found.volume, np.zeros(len(found.volume)))
    return Binding(static, maps, (None, partial(_node_moment, of.body)))


def _refused_faces(of: Sampling, initial: Mapping[str, Fields]) -> list[str]:
    """Refuse also a mesh of other dimensions than the fluid."""
    fluid, mesh = initial.get(of.fluid, {}), initial.get(of.body, {})
    wrong = _refused_slab(of, initial)
    if wrong or "surface.spacing" not in fluid or "faces.start" not in mesh:
        return wrong
    planar = asked_sampling(fluid).planar
    if planar == is_planar(mesh, "faces"):
        return []
    flat, solid = (of.fluid, of.body) if planar else (of.body, of.fluid)
    return [
        f"link {of.link}: both sides must have two dimensions or both three; {flat} has two, "
        f"{solid} has three. Set dimensions = 2 in both, or 3 in both."
    ]


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
    works_on=(
        ("load.force", "motion.velocity", "motion.position"),
        ("load.torque", "motion.angular_velocity", "motion.orientation"),
    ),
    refuses=_refused_bodies,
    bind=_bind_bodies,
)
FACES_OF_A_MESH = Structure(
    motion=FACES,
    load=NODE_LOAD,
    reads=("faces.position", "faces.velocity"),
    fills=("node_load.force",),
    needs=("faces.position",),
    works_on=(("node_load.force", "faces.velocity", "faces.position"),),
    refuses=_refused_faces,
    bind=_bind_faces,
)
