"""Samples of the bodies that links join in tests, as solvers give them."""

from functools import partial

import numpy as np

from quintet.components.shared.geometry.surface_samples import box, rigid_answer, sphere
from quintet.components.shared.geometry.surface_samples_mesh import mesh_answer


def bodies(*samplers):
    """Answer of rigid bodies, each a function of `surface_samples` with its dimensions bound."""
    return lambda request: rigid_answer("motion", request, samplers)


def cubes(edge, count=1):
    """Answer of equal cubes."""
    return bodies(*[partial(box, (edge,) * 3)] * count)


def balls(diameter, count=1):
    """Answer of equal spheres."""
    return bodies(*[partial(sphere, diameter)] * count)


def mesh(static):
    """Answer of a mesh that describes itself so."""
    return lambda request: mesh_answer(next(iter(request)).partition(".")[0], request, static)


def bound(link, described, **answers):
    """The binding of a link, from the descriptions and answers of components."""
    descriptions = dict(described)
    for name, request in link.requests(described).items():
        descriptions[name] = {**described[name], **answers[name](request)}
    return link.bind(descriptions)


def masses(count):
    """The description of rigid bodies."""
    return {"motion.mass": np.ones(count)}
