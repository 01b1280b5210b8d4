"""How the surfaces of prescribed bodies are sampled for a partner."""

from collections.abc import Sequence
from functools import partial

from quintet.components.shared.geometry import surface_samples as surfaces
from quintet.components.shared.geometry.planar_shapes import Disc, Polygon
from quintet.components.shared.geometry.shapes import Box, Shape, Sphere
from quintet.interfaces.component import Array, Fields


def sample(shapes: Sequence[Shape], request: Fields) -> dict[str, Array]:
    """Samples of all bodies."""
    return surfaces.rigid_answer("motion", request, [_sampler(shape) for shape in shapes])


def _sampler(shape: Shape) -> surfaces.Sampler:
    if isinstance(shape, Polygon):
        return partial(surfaces.polygon, shape.outline)
    if isinstance(shape, Box):
        return partial(surfaces.box, shape.size)
    assert isinstance(shape, Sphere | Disc)
    fill = surfaces.disc if isinstance(shape, Disc) else surfaces.sphere
    return partial(fill, 2.0 * shape.radius)
