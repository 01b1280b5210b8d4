"""Polygons of prisms: whether they cross themselves, and what is inside."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def require_simple(corners: Sequence[tuple[float, float]]) -> None:
    """Refuse corners (k, 2) m of a polygon whose edges meet elsewhere than at corners."""
    start = np.array(corners)
    along = np.roll(start, -1, axis=0) - start
    count = len(start)
    if not (np.linalg.norm(along, axis=1) > 0.0).all():
        raise ValueError("shapes: corners of a prism must differ from the next. Remove one of two.")
    one, other = np.triu_indices(count, 2)
    keep = ~((one == 0) & (other == count - 1))  # neighbours
    one, other = one[keep], other[keep]
    across = _cross(along[one], along[other])
    between = start[other] - start[one]
    safe = np.where(across == 0.0, 1.0, across)
    t, u = _cross(between, along[other]) / safe, _cross(between, along[one]) / safe
    met = (across != 0.0) & (t >= 0.0) & (t <= 1.0) & (u >= 0.0) & (u <= 1.0)
    if met.any():
        k = int(np.argmax(met))
        raise ValueError(
            "shapes: corners of a prism must go once round a polygon that does not cross itself; "
            f"the edges after corners {one[k]} and {other[k]} meet. Put them in order."
        )


def _cross(a: Array, b: Array) -> Array:
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])


def inside_polygon(first: Array, second: Array, corners: Array) -> NDArray[np.bool_]:
    """Whether places (n,), (n,) m are inside a polygon (k, 2) m: by the edges that a ray meets."""
    found = np.zeros(np.broadcast(first, second).shape, bool)
    for (a, b), (c, d) in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        passes = (b > second) != (d > second)
        if b != d:
            found ^= passes & (first < a + (second - b) * (c - a) / (d - b))
    return found
