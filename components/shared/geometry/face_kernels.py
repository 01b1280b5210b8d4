"""Points and faces of a mesh: the nearest face, by cells, and what lies behind one; compiled.

Faces are bilinear, x(ξ, η) = Σ N_c x_c; of a triangle the last corner stands twice, of an edge
both, so that it is a face without area. Imported only where a mesh is joined, since numba is.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from quintet.components.shared.numba_options import EXACT

Array = NDArray[np.float64]
Whole = NDArray[np.int64]

STEPS = 20  # of the iteration for the foot of a perpendicular, at most
SETTLED = 1e-15  # change of ξ and η at which it ends
THIN = 1e-24  # of its other side squared: an edge, which has no width


class Cells(NamedTuple):
    """Cubes that hold faces: those of cell k are face[begin[k] : begin[k + 1]], by their boxes."""

    corner: Array  # (m, 4, 3) m, of the faces
    low: Array  # (3,) m
    size: float  # m, of a cube
    grid: Whole  # (3,) cells along x, y and z
    begin: Whole  # (cells + 1,)
    face: Whole


@njit(**EXACT)
def cell_range(corner, low, size, count, face, out):  # type: ignore[no-untyped-def]
    """Write the first and last cell (2, 3) of the box around a face."""
    for d in range(3):
        least, most = corner[face, 0, d], corner[face, 0, d]
        for c in range(1, 4):
            least, most = min(least, corner[face, c, d]), max(most, corner[face, c, d])
        out[0, d] = min(max(int((least - low[d]) / size), 0), count[d] - 1)
        out[1, d] = min(max(int((most - low[d]) / size), 0), count[d] - 1)


@njit(**EXACT)
def fill_cells(corner: Array, low: Array, size: float, count: Whole) -> tuple[Whole, Whole]:
    """Beginnings (cells + 1,) and faces of all cells."""
    cells, span = count[0] * count[1] * count[2], np.empty((2, 3), np.int64)
    begin = np.zeros(cells + 1, np.int64)
    faces = np.zeros(0, np.int64)
    for writes in (False, True):
        for f in range(corner.shape[0]):
            cell_range(corner, low, size, count, f, span)
            for i in range(span[0, 0], span[1, 0] + 1):
                for j in range(span[0, 1], span[1, 1] + 1):
                    for k in range(span[0, 2], span[1, 2] + 1):
                        cell = (i * count[1] + j) * count[2] + k
                        if writes:
                            faces[begin[cell]] = f
                            begin[cell] += 1
                        else:
                            begin[cell + 1] += 1
        if not writes:
            for cell in range(cells):
                begin[cell + 1] += begin[cell]
            faces = np.empty(begin[cells], np.int64)
    for cell in range(cells, 0, -1):  # each beginning has gone on to the next
        begin[cell] = begin[cell - 1]
    begin[0] = 0
    return begin, faces


@njit(forceinline=True, **EXACT)
def place_on(x, xi, eta, out):  # type: ignore[no-untyped-def]
    """Write the place (3,) m on a face (4, 3), and its derivatives (2, 3) there, into (3, 3)."""
    for d in range(3):
        a, b, c, e = x[0, d], x[1, d], x[2, d], x[3, d]
        out[1, d] = 0.25 * ((1.0 - eta) * (b - a) + (1.0 + eta) * (c - e))
        out[2, d] = 0.25 * ((1.0 - xi) * (e - a) + (1.0 + xi) * (c - b))
        low, high = (1.0 - xi) * a + (1.0 + xi) * b, (1.0 - xi) * e + (1.0 + xi) * c
        out[0, d] = 0.25 * ((1.0 - eta) * low + (1.0 + eta) * high)


@njit(**EXACT)
def foot(p, x, room):  # type: ignore[no-untyped-def]
    """Local coordinates of the point of a face that is nearest to p, and their distance squared."""
    return foot_within(p, x, SETTLED, room)


@njit(forceinline=True, **EXACT)
def foot_within(p, x, settled, room):  # type: ignore[no-untyped-def]
    """As `foot`, with the change of ξ and η at which the iteration ends.

    Gauss and Newton's iteration, kept on the face; `room` (3, 3) gets the point and the derivatives
    there, as by `place_on`.
    """
    xi, eta = 0.0, 0.0
    for _ in range(STEPS):
        place_on(x, xi, eta, room)
        tt, ss, ts, gt, gs = 0.0, 0.0, 0.0, 0.0, 0.0
        for d in range(3):
            gap, t, s = p[d] - room[0, d], room[1, d], room[2, d]
            tt, ss, ts = tt + t * t, ss + s * s, ts + t * s
            gt, gs = gt + gap * t, gs + gap * s
        det, before, at = tt * ss - ts * ts, xi, eta
        if det <= THIN * max(tt, ss) ** 2:
            if tt >= ss:
                xi = min(max(xi + gt / tt, -1.0), 1.0)
            else:
                eta = min(max(eta + gs / ss, -1.0), 1.0)
        else:
            xi = min(max(before + (gt * ss - gs * ts) / det, -1.0), 1.0)
            eta = min(max(at + (gs - ts * (xi - before)) / ss, -1.0), 1.0)
            if abs(eta) == 1.0:
                xi = min(max(before + (gt - ts * (eta - at)) / tt, -1.0), 1.0)
        if abs(xi - before) <= settled and abs(eta - at) <= settled:
            break
    place_on(x, xi, eta, room)
    d2 = 0.0
    for d in range(3):
        d2 += (p[d] - room[0, d]) ** 2
    return xi, eta, d2


class Rivals(NamedTuple):
    """Which faces count: those that look another way than a point's own, and are near."""

    facing: Array  # (n, 3) normals of the points' own faces, or zero: all faces count
    normal: Array  # (m, 3) of all faces
    most: float  # cosine of the angle between the two below which a face counts
    reach: float  # m, further than which none is looked for


@njit(**EXACT)
def nearest_faces(
    points: Array, cells: Cells, rivals: Rivals, face: Whole, local: Array, gap: Array
) -> None:
    """Find the nearest face of each point; of equally near ones the first.

    Parameters
    ----------
    points : (n, 3) float array, m
    cells : Cells
    rivals : Rivals
    face : (n,) int array
        Written; left as it is where there is none.
    local : (n, 2) float array, 1
        ξ and η of the nearest point on it; written.
    gap : (n,) float array, m
        Distance to that point, ∞ where there is none; written.
    """
    count, size, corner = cells.grid, cells.size, cells.corner
    room, middle = np.empty((3, 3)), np.empty(3, np.int64)
    most = count[0] + count[1] + count[2]
    for n in range(points.shape[0]):
        p = points[n]
        out = 0.0  # m, how far the point is outside all cells
        for d in range(3):
            place = (p[d] - cells.low[d]) / size
            middle[d] = min(max(math.floor(place), 0), count[d] - 1)
            out = max(out, -place * size, (place - count[d]) * size)
        best = math.inf
        for ring in range(most):
            # Whatever lies beyond this ring is at least so far away.
            beyond = max(out, (ring - 1) * size)
            if best <= beyond * beyond or beyond > rivals.reach:
                break
            for i in range(max(middle[0] - ring, 0), min(middle[0] + ring, count[0] - 1) + 1):
                for j in range(max(middle[1] - ring, 0), min(middle[1] + ring, count[1] - 1) + 1):
                    across = max(abs(i - middle[0]), abs(j - middle[1]))
                    step = 1 if across == ring else max(2 * ring, 1)
                    for k in range(middle[2] - ring, middle[2] + ring + 1, step):
                        if k < 0 or k >= count[2]:
                            continue
                        cell = (i * count[1] + j) * count[2] + k
                        for at in range(cells.begin[cell], cells.begin[cell + 1]):
                            f = cells.face[at]
                            alike = 0.0
                            for d in range(3):
                                alike += rivals.facing[n, d] * rivals.normal[f, d]
                            if alike >= rivals.most or box_distance(p, corner[f]) > best:
                                continue
                            xi, eta, d2 = foot(p, corner[f], room)
                            if d2 < best or (d2 == best and f < face[n]):
                                best, face[n] = d2, f
                                local[n, 0], local[n, 1] = xi, eta
        gap[n] = math.sqrt(best)


@njit(**EXACT)
def box_distance(p, x):  # type: ignore[no-untyped-def]
    """Squared distance [m2] of a point from the box around a face (4, 3)."""
    away = 0.0
    for d in range(3):
        least = min(min(x[0, d], x[1, d]), min(x[2, d], x[3, d]))
        most = max(max(x[0, d], x[1, d]), max(x[2, d], x[3, d]))
        away += max(max(least - p[d], p[d] - most), 0.0) ** 2
    return away


@njit(**EXACT)
def opposite_faces(
    start: Array, inward: Array, face: Whole, reach: float, cells: Cells, normal: Array, room: Array
) -> None:
    """Write how far behind points of faces the body ends: the first face turned the other way.

    Parameters
    ----------
    start, inward : (n, 3) float arrays, m and 1
        Points on faces, and unit vectors into the body.
    face : (n,) int array
        Faces that they lie on.
    reach : float, m
        Further than which nothing is looked for.
    cells : Cells
    normal : (m, 3) float array
        Outward, of the faces.
    room : (n,) float array, m
        Written; ∞ where nothing was found.
    """
    count, size, corner = cells.grid, cells.size, cells.corner
    steps, at = math.ceil(2.0 * reach / size) + 1, np.empty(3, np.int64)
    hit, space = np.empty(3), np.empty((3, 3))
    for n in range(start.shape[0]):
        nearest = math.inf
        for step in range(steps + 1):
            for d in range(3):
                place = start[n, d] + min(0.5 * size * step, reach) * inward[n, d]
                at[d] = math.floor((place - cells.low[d]) / size)
            for i in range(max(at[0] - 1, 0), min(at[0] + 1, count[0] - 1) + 1):
                for j in range(max(at[1] - 1, 0), min(at[1] + 1, count[1] - 1) + 1):
                    for k in range(max(at[2] - 1, 0), min(at[2] + 1, count[2] - 1) + 1):
                        cell = (i * count[1] + j) * count[2] + k
                        for place_in in range(cells.begin[cell], cells.begin[cell + 1]):
                            f = cells.face[place_in]
                            turned = 0.0
                            for d in range(3):
                                turned += normal[f, d] * inward[n, d]
                            if f != face[n] and turned > 0.0:
                                ray = start[n], inward[n]
                                way = along_ray(ray, corner[f], normal[f], turned, hit, space)
                                nearest = min(nearest, way)
            if nearest <= 0.5 * size * step:
                break
        room[n] = nearest if nearest <= reach else math.inf


@njit(**EXACT)
def along_ray(ray, x, normal, turned, hit, space):  # type: ignore[no-untyped-def]
    """How far [m] along a ray it meets a face, or the edge that a face without area is."""
    (p, u), way = ray, 0.0
    for d in range(3):
        way += normal[d] * (0.25 * (x[0, d] + x[1, d] + x[2, d] + x[3, d]) - p[d]) / turned
    if way <= 0.0:
        return math.inf
    for d in range(3):
        hit[d] = p[d] + way * u[d]
    _, _, d2 = foot(hit, x, space)
    size = 0.0
    for d in range(3):
        size += (x[2, d] - x[0, d]) ** 2 + (x[1, d] - x[3, d]) ** 2
    # A ray may pass between two faces that share an edge, by rounding, or where they are warped.
    return way if d2 <= 1e-4 * size else math.inf


@njit(**EXACT)
def write_columns(count: Whole, face: Whole, local: Array, share: Array) -> None:
    """Write face, ξ and η of the middles of equal cells of faces, and their share of its area.

    Parameters
    ----------
    count : (m, 2) int array
        Cells along ξ and η of each face.
    face, local, share : (n,), (n, 2) and (n,) arrays
        Written, one face after another.
    """
    row = 0
    for f in range(count.shape[0]):
        wide, high = count[f, 0], count[f, 1]
        for j in range(high):
            for i in range(wide):
                face[row], share[row] = f, 4.0 / (wide * high)
                local[row, 0] = (i + 0.5) * 2.0 / wide - 1.0
                local[row, 1] = (j + 0.5) * 2.0 / high - 1.0
                row += 1
