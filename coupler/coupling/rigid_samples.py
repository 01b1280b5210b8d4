"""Sampling all rigid bodies of a component as a fluid asks for it, in two dimensions or three."""

from dataclasses import dataclass

import numpy as np

from quintet.coupler.coupling import body_samples, planar_samples
from quintet.interfaces.component import Array, Fields
from quintet.interfaces.ports import BOX, DISC, POLYGON, SPHERE


@dataclass(frozen=True, slots=True)
class Sampling:
    """How a fluid asks for surfaces to be sampled."""

    spacing: float  # m
    depth: float  # m, below the outermost samples: deeper ones act on nothing
    inset: float  # m, of the outermost ones below the surface
    planar: bool  # whether the fluid has two dimensions

    @property
    def least(self) -> float:
        """Width [m] that a body must have."""
        return max(self.spacing, 2.0 * self.inset)


@dataclass(frozen=True, slots=True)
class RigidSamples:
    """Samples of all bodies, one body after another."""

    arm: Array  # (n, 3) m from the body's centre, in its frame
    normal: Array  # (n, 3) outward
    volume: Array  # (n,) m3
    body: Array  # (n,) number of the body
    image: Array | None  # (n, 3) m, the arms mirrored in the surface; None if not asked for


def asked_sampling(stated: Fields) -> Sampling:
    """Read what a fluid states at its port `surface`."""
    spacing, depth = float(stated["surface.spacing"][0]), float(stated["surface.depth"][0])
    inset = float(stated.get("surface.inset", [0.5 * spacing])[0])
    return Sampling(spacing, depth, inset, stated.get("surface.dimensions", [3.0])[0] == 2.0)


def unsampled(name: str, bodies: Fields, planar: bool) -> list[str]:
    """Say that a body has a shape that cannot be sampled."""
    known = {DISC: "disc", POLYGON: "polygon"} if planar else {SPHERE: "sphere", BOX: "box"}
    wrong = [k for k, shape in enumerate(bodies["motion.shape"]) if int(shape) not in known]
    names = " or ".join(f"{code} ({text})" for code, text in known.items())
    return [
        f"a body's shape must be {names} to be sampled; found {int(bodies['motion.shape'][k])} of "
        f"body {k} of {name}. Give it one of these shapes, or leave it out of the link."
        for k in wrong[:1]
    ]


def body_widths(bodies: Fields, planar: bool) -> Array:
    """Least width (bodies,) m of each body."""
    if not planar:
        return np.asarray(bodies["motion.size"].min(axis=1))
    each = zip(bodies["motion.shape"], bodies["motion.size"], corners_of(bodies), strict=True)
    return np.array([planar_samples.width(int(shape), *rest) for shape, *rest in each])


def sample_bodies(bodies: Fields, asked: Sampling, mirrored: bool) -> RigidSamples:
    """Sample every body; with the images of all samples if they are asked for."""
    lattice = asked.spacing, asked.depth, asked.inset
    parts, images = [], []
    each = zip(bodies["motion.shape"], bodies["motion.size"], corners_of(bodies), strict=True)
    for code, size, corner in each:
        shape = int(code)
        if asked.planar:
            part = planar_samples.fill(shape, size, corner, *lattice)
        else:
            part = body_samples.fill(shape, size, *lattice)
        parts.append(part)
        if mirrored and asked.planar:
            images.append(planar_samples.mirrors(shape, size, corner, *part[:2]))
        elif mirrored:
            images.append(body_samples.mirrors(shape, size, *part[:2]))
    arm, normal, volume = (np.concatenate(columns) for columns in zip(*parts, strict=True))
    body = np.repeat(np.arange(len(parts)), [len(part[0]) for part in parts])
    return RigidSamples(arm, normal, volume, body, np.concatenate(images) if images else None)


def corners_of(bodies: Fields) -> list[Array]:
    """Corners (k, 3) m of each body, none of bodies that say none."""
    count = len(bodies["motion.shape"])
    counts = np.asarray(bodies.get("motion.corners", np.zeros(count)), np.int64)
    return np.split(bodies.get("motion.corner", np.zeros((0, 3))), np.cumsum(counts)[:-1])
