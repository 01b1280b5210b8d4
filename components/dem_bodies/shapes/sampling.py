"""How the surfaces of bodies are sampled for a partner."""

from functools import partial

import numpy as np

from quintet.components.dem_bodies.shapes import planar
from quintet.components.dem_bodies.shapes.copies import Bodies
from quintet.components.dem_bodies.shapes.rigid_body import RigidBody
from quintet.components.dem_bodies.shapes.sphere_union import measure_union
from quintet.components.shared.geometry import surface_samples as surfaces
from quintet.interfaces.component import Array, Fields


def sample(bodies: Bodies, request: Fields) -> dict[str, Array]:
    """Samples of all bodies; equal ones are sampled once."""
    known: dict[object, surfaces.Sampler] = {}
    of_kinds = [known.setdefault(_form(kind), _sampler(kind)) for kind in bodies.kinds]
    samplers = [of_kinds[kind] for kind in bodies.kind_of_each().tolist()]
    return surfaces.rigid_answer("motion", request, samplers)


def _form(body: RigidBody) -> object:
    """What two bodies have in common whose samples are equal."""
    return (
        body.shape, body.size, body.radius, body.corners, body.centres, body.radii,
        body.file, body.scale,
    )  # fmt: skip


def _sampler(body: RigidBody) -> surfaces.Sampler:
    if body.corners is not None:
        return partial(surfaces.polygon, planar.corners(body))
    if body.geometry is not None:
        return surfaces.sampler_of(body.geometry)
    assert body.centres is not None and body.radii is not None
    volume, centre, _ = measure_union((body.centres, body.radii))
    return partial(surfaces.spheres, np.array(body.centres) - centre, np.array(body.radii), volume)
