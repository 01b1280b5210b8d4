"""Answers to whoever asks how the surface of a body or a mesh is sampled.

A solver that moves bodies answers `Component.sample` by `rigid_answer`, one that moves a mesh by
`mesh_answer`. Samples fill a body to a depth below its surface, in the body's own frame.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from quintet.components.shared.geometry import surface_samples_closed as closed
from quintet.components.shared.geometry import surface_samples_planar as plane
from quintet.components.shared.geometry import surface_samples_solid as solid
from quintet.components.shared.geometry.planar_shapes import Disc, Polygon
from quintet.components.shared.geometry.polygons import is_convex
from quintet.components.shared.geometry.shapes import Box, Mesh, Shape, Sphere
from quintet.interfaces.component import Array, Fields
from quintet.interfaces.errors import SceneError


@dataclass(frozen=True, slots=True)
class Sampling:
    """How a partner asks for surfaces to be sampled."""

    spacing: float  # m
    depth: float  # m, below the outermost samples: deeper ones act on nothing
    inset: float  # m, of the outermost ones below the surface
    planar: bool = False  # whether the partner has two dimensions
    mirrored: bool = False  # whether it asks for the image of each sample in the surface

    @property
    def least(self) -> float:
        """Width [m] that a body must have."""
        return max(self.spacing, 2.0 * self.inset)


@dataclass(frozen=True, slots=True)
class BodySamples:
    """Samples of one body."""

    arm: Array  # (n, 3) m from the body's centre, in its frame
    normal: Array  # (n, 3) outward
    volume: Array  # (n,) m3
    image: Array  # (n, 3) m, the arms mirrored in the surface


Sampler = Callable[[Sampling], BodySamples]


def sampling_of(port: str, request: Fields) -> Sampling:
    """Read a request for samples of a port."""
    names = "spacing", "depth", "inset", "dimensions", "mirror"
    spacing, depth, inset, dimensions, mirror = (float(request[f"{port}.{k}"][0]) for k in names)
    return Sampling(spacing, depth, inset, dimensions == 2.0, mirror == 1.0)


def rigid_answer(port: str, request: Fields, bodies: Sequence[Sampler]) -> dict[str, Array]:
    """Samples of all bodies, one after another.

    Parameters
    ----------
    port : str
        Through which the bodies' motion is given.
    request : mapping of arrays
        As `Component.sample` gets it.
    bodies : sequence of functions
        Of each body one such as `sphere` or `box` with its dimensions bound.
    """
    sampling, parts = sampling_of(port, request), []
    known: dict[Sampler, BodySamples] = {}  # equal bodies share one function
    for number, body in enumerate(bodies):
        if body not in known:
            known[body] = _sampled(number, body, sampling)
        parts.append(known[body])
    count = [len(part.arm) for part in parts]
    answer = {
        "arm": np.concatenate([part.arm for part in parts]),
        "normal": np.concatenate([part.normal for part in parts]),
        "volume": np.concatenate([part.volume for part in parts]),
        "body": np.repeat(np.arange(len(parts)), count).astype(np.float64),
    }
    if sampling.mirrored:
        answer["image"] = np.concatenate([part.image for part in parts])
    return {f"{port}.{name}": array for name, array in answer.items()}


def _sampled(number: int, body: Sampler, sampling: Sampling) -> BodySamples:
    try:
        return body(sampling)
    except ThinError as error:
        raise SceneError(
            f"a body must be at least {sampling.least:g} m across to be sampled: a spacing of its "
            "partner, and twice the depth of the outermost samples that it asks for; body "
            f"{number} is {error} m. Refine the partner's spacing, or leave the body out."
        ) from error


class ThinError(ValueError):
    """A body is thinner than its partner can sample: how thick it is."""


def require_width(width: float, sampling: Sampling) -> None:
    """Refuse a body of a width [m] that is less than samples need."""
    if width < sampling.least:
        raise ThinError(f"{width:g}")


def sampler_of(shape: Shape) -> Sampler:
    """How a shape is sampled about its centre; a polygon is about the origin of its corners."""
    if isinstance(shape, Polygon):
        return partial(polygon, shape.outline)
    if isinstance(shape, Mesh):
        return partial(mesh, shape.solid.triangles - shape.solid.centre, shape.volume)
    if isinstance(shape, Box):
        return partial(box, shape.size)
    assert isinstance(shape, Sphere | Disc)
    return partial(disc if isinstance(shape, Disc) else sphere, 2.0 * shape.radius)


def sphere(diameter: float, sampling: Sampling) -> BodySamples:
    """Sample a sphere."""
    _require_space(sampling)
    require_width(diameter, sampling)
    arm, normal, volume = solid.fill_sphere(
        diameter, sampling.spacing, sampling.depth, sampling.inset
    )
    return BodySamples(arm, normal, volume, solid.sphere_images(diameter, arm, normal))


def box(size: Sequence[float], sampling: Sampling) -> BodySamples:
    """Sample a box with edges (3,) m."""
    _require_space(sampling)
    edges = np.array(size)
    require_width(float(edges.min()), sampling)
    arm, normal, volume = solid.fill_box(edges, sampling.spacing, sampling.depth, sampling.inset)
    return BodySamples(arm, normal, volume, solid.box_images(edges, arm, normal))


def spheres(centres: Array, radii: Array, volume: float, sampling: Sampling) -> BodySamples:
    """Sample a union of spheres (k, 3) m, (k,) m about its centre of mass, of a volume [m3]."""
    _require_space(sampling)
    require_width(2.0 * float(radii.max()), sampling)
    low, high = (centres - radii[:, None]).min(axis=0), (centres + radii[:, None]).max(axis=0)
    return _closed(
        closed.Body(closed.depths_in_spheres(centres, radii), low, high, volume), sampling
    )


def mesh(triangles: Array, volume: float, sampling: Sampling) -> BodySamples:
    """Sample a closed surface of triangles (t, 3, 3) m about its centre of mass [m3]."""
    _require_space(sampling)
    low, high = triangles.min(axis=(0, 1)), triangles.max(axis=(0, 1))
    require_width(float((high - low).min()), sampling)
    return _closed(closed.Body(closed.depths_in_mesh(triangles), low, high, volume), sampling)


def _closed(body: closed.Body, sampling: Sampling) -> BodySamples:
    less = sampling.inset - 0.5 * sampling.spacing
    samples, deepest = closed.fill_closed(body, sampling.spacing, sampling.depth, less)
    # The deepest place of the lattice may miss the middle by half a cell.
    require_width(2.0 * deepest + sampling.spacing, sampling)
    return BodySamples(*samples)


def disc(diameter: float, sampling: Sampling) -> BodySamples:
    """Sample a disc of two dimensions."""
    _require_plane(sampling)
    require_width(diameter, sampling)
    arm, normal, volume = plane.fill_disc(
        diameter, sampling.spacing, sampling.depth, sampling.inset
    )
    return BodySamples(arm, normal, volume, solid.sphere_images(diameter, arm, normal))


def polygon(corner: Array, sampling: Sampling) -> BodySamples:
    """Sample a polygon with corners (k, 2) m about its centre, from x to z."""
    _require_plane(sampling)
    if not is_convex(corner):
        return _closed(plane.closed_polygon(corner), sampling)
    require_width(2.0 * plane.inradius(corner), sampling)
    arm, normal, volume = plane.fill_polygon(
        corner, sampling.spacing, sampling.depth, sampling.inset
    )
    return BodySamples(arm, normal, volume, plane.polygon_images(corner, arm, normal))


def _require_space(sampling: Sampling) -> None:
    if sampling.planar:
        raise SceneError(DIMENSIONS.format("three", "two", "disc or polygon"))


def _require_plane(sampling: Sampling) -> None:
    if not sampling.planar:
        raise SceneError(DIMENSIONS.format("two", "three", "sphere, box or mesh"))


DIMENSIONS = (
    "both sides must have two dimensions or both three; a body has {}, its partner {}. Make the "
    "body a {}, or give both sides the same dimensions."
)
