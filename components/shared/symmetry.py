"""Planes of symmetry: what is near them acts from behind them too, mirrored.

Each particle nearer to such a plane than pairs act has an image behind it. A position r and a
vector u of its own become

    r' = r - 2 d n,   u' = u - 2 (u·n) n,   d = (r - r_plane)·n, with its sign,

and what has no direction is the particle's own. Which particles have images is found with the
neighbour lists; images stand behind all other rows of an array, and are written before each loop
over pairs. Near an edge between two planes the images in one have images in the other.

A particle that passes the plane meets its own image there. The two change their parts, which
changes nothing for any other, so that nothing is lost through the plane.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.search.cells import Whole, grid_around
from quintet.components.shared.search.neighbours import Around, NeighbourLists, neighbours_among
from quintet.components.shared.threads import Team
from quintet.interfaces.component import Array
from quintet.interfaces.errors import StepError

# Columns of a tensor that change their sign in a plane across x, y or z: those of it and another.
ODD_OF_SIX = (np.array([3, 5]), np.array([3, 4]), np.array([4, 5]))
ODD_OF_NINE = (np.array([1, 2, 3, 6]), np.array([1, 3, 5, 7]), np.array([2, 5, 6, 7]))

ODD_OF_TWICE_SIX = tuple(np.concatenate([odd, odd + 8]) for odd in ODD_OF_SIX)


class Plane(NamedTuple):
    """A plane of symmetry across an axis."""

    name: str  # of the face, as a scene has it: "x-"
    axis: int
    position: float  # m, along that axis
    inward: float  # 1 or -1, direction of the side that is computed

    @classmethod
    def of_face(cls, face: str, box: tuple[tuple[float, ...], tuple[float, ...]]) -> "Plane":
        """Make a face of a box (lowest and highest corner, m) such a plane: "x-", "y+"."""
        axis, upper = "xyz".index(face[0]), face[1] == "+"
        return cls(face, axis, box[upper][axis], -1.0 if upper else 1.0)


class SymmetryImages:
    """The images of a set of particles, from one neighbour list to the next."""

    def __init__(self, planes: list[Plane]) -> None:
        self.planes = planes
        self.origin: list[Whole] = []  # of each plane: rows whose images it adds

    def find(self, points: Array, reach: float) -> Array:
        """Find what has images: what is nearer to a plane than `reach` [m].

        Points (n, 3) m; returns them with their images, (n + images, 3) m.
        """
        self.origin = []
        for plane in self.planes:
            near = np.flatnonzero(plane.inward * (points[:, plane.axis] - plane.position) < reach)
            points = np.concatenate([points, mirrored(points[near], plane)])
            self.origin.append(near)
        return points

    def with_room(self, array: Array, rows: int) -> Array:
        """Return the first rows of an array (≥ rows, width) with buffer for their images."""
        count = sum(map(len, self.origin))
        return np.concatenate([array[:rows], np.zeros((count, *array.shape[1:]))])

    def write_positions(self, array: Array, rows: int) -> None:
        """Write the images of the first rows; columns 0 to 2 are a position [m], others copied."""
        for plane, origin, images in self._images(rows):
            array[images] = array[origin]
            array[images, plane.axis] = 2.0 * plane.position - array[images, plane.axis]

    def write_vectors(self, array: Array, rows: int) -> None:
        """Write the images of the first rows; columns 0 to 2 are a vector, others copied."""
        for plane, origin, images in self._images(rows):
            array[images] = array[origin]
            array[images, plane.axis] *= -1.0

    def write_tensors(self, array: Array, rows: int) -> None:
        """Write the images of the first rows, M T M with M = I - 2 n nᵀ; other columns copied.

        The tensor is in columns 0 to 5 of eight, xx yy zz xy yz zx, or 0 to 8 of twelve, by rows;
        of sixteen columns 8 to 13 are another of six.
        """
        odd = {8: ODD_OF_SIX, 12: ODD_OF_NINE, 16: ODD_OF_TWICE_SIX}[array.shape[1]]
        for plane, origin, images in self._images(rows):
            array[images] = array[origin]
            array[images, odd[plane.axis]] *= -1.0

    def write_all(self, rows: int, positions: Array, vectors: Array, *tensors: Array) -> None:
        """Write the images of the first rows in positions, vectors and tensors."""
        self.write_positions(positions, rows)
        self.write_vectors(vectors, rows)
        for tensor in tensors:
            self.write_tensors(tensor, rows)

    def write_values(self, array: NDArray[np.generic], rows: int) -> None:
        """Write the images of the first rows, equal to their origins; (n + images, ...)."""
        for _, origin, images in self._images(rows):
            array[images] = array[origin]

    def _images(self, rows: int) -> list[tuple[Plane, Whole, slice]]:
        """Each plane, the rows that have images in it, and where these stand."""
        images = []
        for plane, origin in zip(self.planes, self.origin, strict=True):
            images.append((plane, origin, slice(rows, rows + len(origin))))
            rows += len(origin)
        return images

    def reflect_crossed(self, positions: Array, *vectors: Array) -> None:
        """Let rows that passed a plane change places with their images, in their vectors too."""
        for plane in self.planes:
            depth = plane.inward * (positions[:, plane.axis] - plane.position)
            out = np.flatnonzero(depth < 0.0)
            positions[out, plane.axis] = 2.0 * plane.position - positions[out, plane.axis]
            for vector in vectors:
                vector[out, plane.axis] *= -1.0

    def all_images(self, points: Array) -> Array:
        """Points (m, 2 or 3) m, then their images in all planes and edges."""
        for plane in self.planes:
            if plane.axis < points.shape[1]:
                points = np.concatenate([points, mirrored(points, plane)])
        return points

    def require_before(self, points: Array, name: str) -> None:
        """Raise where points (n, 3) m are behind a plane."""
        for plane in self.planes:
            depth = plane.inward * (points[:, plane.axis] - plane.position)
            worst = int(np.argmin(depth))
            if depth[worst] < 0.0:
                raise StepError(
                    f"{name}s must stay before the plane of symmetry {plane.name}, "
                    f"{plane.name[0]} = {plane.position:g} m; {name.split()[-1]} {worst} is at "
                    f"{plane.name[0]} = {points[worst, plane.axis]:.4g} m. Move the body, cut it "
                    "there, or compute the whole."
                )


def mirrored(points: Array, plane: Plane) -> Array:
    """Images of points (n, 2 or 3) m in a plane."""
    image = points.copy()
    image[:, plane.axis] = 2.0 * plane.position - image[:, plane.axis]
    return image


def neighbours_and_images(
    points: Array, first_group: NDArray[np.bool_], split: int, rows: int, reach: float, team: Team,
    query_points: Array | None, buffer: NDArray[np.int32],
) -> NeighbourLists:  # fmt: skip
    """Lists as `neighbours_within` makes them, among points and their images.

    Parameters
    ----------
    points : (n + images, 3) float array, m
        As `SymmetryImages.find` returned them.
    first_group : (n + images,) bool array
        Which are of the first group.
    split, rows : int
        How many of the points that are no images are of the first group, and of both.
    reach : float, m
    team, query_points, buffer
        As there.

    Returns
    -------
    NeighbourLists
        Of the points that are no images; their neighbours may be images.
    """
    around = around_images(points, first_group, split, rows, reach, query_points)
    _, first, second, looking, grid = around
    return neighbours_among(reach, points, first, second, looking, split, team, buffer, grid)


def around_images(
    points: Array, first_group: NDArray[np.bool_], split: int, rows: int, reach: float,
    query_points: Array | None,
) -> Around:  # fmt: skip
    """All that rows may have as neighbours, of points and their images.

    Parameters are those of `neighbours_and_images`.
    """
    first, second = np.flatnonzero(first_group), np.flatnonzero(~first_group)
    others = points[split:rows] if query_points is None else query_points
    looking = np.concatenate([points[:split], others])
    return Around(points, first, second, looking, grid_around(points.take(first, 0), reach))
