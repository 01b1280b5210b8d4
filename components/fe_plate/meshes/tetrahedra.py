"""Tetrahedra with ten nodes: their shape, their faces, and how four nodes are raised to ten.

Nodes 0 to 3 are the corners, 0, 1 and 2 anticlockwise as seen from 3; 4 to 9 stand in the middles
of the edges 01, 12, 20, 03, 13 and 23, as in VTK, Abaqus, Nastran and LS-DYNA.
"""

import numpy as np

from quintet.components.fe_plate.meshes.arrays import Array, Whole
from quintet.components.fe_plate.meshes.four_points import OWN, REST
from quintet.interfaces.errors import SceneError

NODES = 10
EDGES = np.array([(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)])
# Corners of each face, seen from outside, and its midside nodes behind the first, second and third.
FACES = np.array([(0, 2, 1, 6, 5, 4), (0, 1, 3, 4, 8, 7), (1, 2, 3, 5, 9, 8), (2, 0, 3, 6, 7, 9)])
PIECES = np.array([(0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)])  # triangles of a face's six nodes
POINTS = np.full((4, 4), REST) + (OWN - REST) * np.eye(4)  # λ of the quadrature points
# Shape functions (3, 6) and slopes (3, 6, 2) of a face's nodes at three points of equal weight.
FACE_POINTS = np.array([(2.0, 0.5, 0.5), (0.5, 2.0, 0.5), (0.5, 0.5, 2.0)]) / 3.0
FACE_ENDS = np.array([(0, 1), (1, 2), (2, 0)])
FACE_WEIGHTS = np.concatenate(
    [FACE_POINTS * (2.0 * FACE_POINTS - 1.0), 4.0 * FACE_POINTS[:, FACE_ENDS].prod(axis=2)], axis=1
)
# Corners of tetrahedra in those of a brick: the same diagonal of a side on both bricks there.
OF_BRICK = np.array(
    [(0, 1, 2, 6), (0, 5, 1, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 4, 5, 6), (0, 7, 4, 6)]
)
MIDDLE = 0.25  # of an edge: a midside node must be so near to the middle of its own edge
POOR = 0.1  # radius ratio below which an element is badly shaped (1 of a regular one)


def _face_slopes(barycentric: Array) -> Array:
    """Slopes (6, 2) of the shape functions of a face by λ₁ and λ₂ at λ (3,)."""
    slopes = np.array([(-1.0, -1.0), (1.0, 0.0), (0.0, 1.0)])
    i, j = FACE_ENDS.T
    middles = 4.0 * (barycentric[i, None] * slopes[j] + barycentric[j, None] * slopes[i])
    return np.concatenate([(4.0 * barycentric - 1.0)[:, None] * slopes, middles])


FACE_SLOPES = [_face_slopes(place) for place in FACE_POINTS]


def gradients(barycentric: Array) -> Array:
    """∂N/∂λ (10, 3) by λ₁, λ₂ and λ₃, of the shape functions at λ (4,)."""
    slopes = np.array([(-1.0, -1.0, -1.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)])
    corners = (4.0 * barycentric - 1.0)[:, None] * slopes
    i, j = EDGES.T
    middles = 4.0 * (barycentric[i, None] * slopes[j] + barycentric[j, None] * slopes[i])
    return np.concatenate([corners, middles])


def jacobians(node: Array, corner: Whole, places: Array) -> Array:
    """Jacobians (e, k) m3 of elements (e, 10) at places (k, 4) in barycentric coordinates."""
    x = node[corner]
    tangents = [np.einsum("ead,ai->eid", x, gradients(place)) for place in places]
    return np.stack([(np.cross(t[:, 0], t[:, 1]) * t[:, 2]).sum(axis=1) for t in tangents], axis=1)


def point_volumes(node: Array, corner: Whole) -> Array:
    """Volumes (e, 4) m3 of the quadrature points of elements (e, 10)."""
    return jacobians(node, corner, POINTS) / 24.0


def least_spacing(node: Array, corner: Whole) -> float:
    """Shortest distance of a midside node from the ends of its edge."""
    x = node[corner]
    return float(
        min(np.linalg.norm(x[:, 4:] - x[:, EDGES[:, end]], axis=2).min() for end in (0, 1))
    )


def raised(points: Array, corner: Whole) -> tuple[Array, Whole, Whole]:
    """Tetrahedra of ten nodes from those of four, with nodes in the middles of their edges.

    Returns
    -------
    (p + m, 3) : points, new ones behind the others
    (e, 10) : nodes of the elements
    (m, 2) : points at the ends of the edge of each new one
    """
    pairs = np.sort(corner[:, EDGES].reshape(-1, 2), axis=1)
    ends, number = np.unique(pairs, axis=0, return_inverse=True)
    middles = len(points) + number.reshape(-1, len(EDGES))
    everything = np.concatenate([points, points[ends].mean(axis=1)])
    return everything, np.concatenate([corner, middles], axis=1), ends


def split(node: Array, corner: Whole) -> tuple[Array, Whole]:
    """Six tetrahedra with ten nodes from each brick (e, 8) of a box, around its diagonal 06."""
    points, nodes, _ = raised(node, corner[:, OF_BRICK].reshape(-1, 4))
    return points, nodes


def outer_triangles(corner: Whole) -> tuple[Whole, Whole]:
    """Outer faces as triangles (4f, 4), -1 behind their corners, and the element (4f,) of each.

    The four of a face with six nodes stand one after another: at its corners, then in its middle.
    """
    face = corner[:, FACES].reshape(-1, 6)
    owner = np.repeat(np.arange(len(corner)), len(FACES))
    _, first, count = np.unique(
        np.sort(face[:, :3], axis=1), axis=0, return_index=True, return_counts=True
    )
    outer = np.sort(first[count == 1])
    triangles = face[outer][:, PIECES].reshape(-1, 3)
    side = np.pad(triangles, ((0, 0), (0, 1)), constant_values=-1)
    return side, np.repeat(owner[outer], len(PIECES))


def incomplete_faces(corner: Whole, members: Whole) -> tuple[int, int]:
    """Count outer faces of which a set has all corners but not all midside nodes, and the latter.

    Parameters
    ----------
    corner : (e, 10) int array
    members : (k,) int array
        Nodes of the set.
    """
    face = corner[:, FACES].reshape(-1, 6)
    is_member = np.zeros(int(corner.max()) + 1, bool)
    is_member[members] = True
    _, first, count = np.unique(
        np.sort(face[:, :3], axis=1), axis=0, return_index=True, return_counts=True
    )
    held = face[first[count == 1]]
    held = held[is_member[held[:, :3]].all(axis=1)][:, 3:]
    lacks = ~is_member[held]
    return int(lacks.any(axis=1).sum()), len(np.unique(held[lacks]))


def require_sound(where: str, node: Array, corner: Whole) -> list[str]:
    """Refuse elements that are collapsed, inside out or misnumbered; note badly shaped ones."""
    ordered = np.sort(corner, axis=1)
    collapsed = np.flatnonzero((ordered[:, 1:] == ordered[:, :-1]).any(axis=1))
    if len(collapsed):
        raise SceneError(
            f"{where}: a tetrahedron must have 10 different nodes; {len(collapsed)} of "
            f"{len(corner)} have not, first element {collapsed[0]} (from 0) at "
            f"{_middle(node, corner, collapsed[0])} m. Mesh it again."
        )
    x = node[corner]
    straight = np.linalg.det(x[:, 1:4] - x[:, :1])  # m3, six volumes
    _require_positive(where, node, corner, straight, "at its corners")
    ends = x[:, EDGES]  # (e, 6, 2, 3)
    away = np.linalg.norm(x[:, 4:] - ends.mean(axis=2), axis=2)
    far = away > MIDDLE * np.linalg.norm(ends[:, :, 1] - ends[:, :, 0], axis=2)
    if far.any():
        share = away / np.linalg.norm(ends[:, :, 1] - ends[:, :, 0], axis=2)
        element, edge = np.unravel_index(np.argmax(np.where(far, share, 0.0)), far.shape)
        raise SceneError(
            f"{where}: each midside node must lie within a quarter of an edge of the middle of its "
            f"own edge; found node {4 + edge} of element {element} (from 0) at "
            f"{_middle(node, corner, int(element))} m {share[element, edge]:.2g} of the edge away, "
            f"the farthest, and such nodes in {int(far.any(axis=1).sum())} of {len(corner)} "
            "elements: they are out of order, or faces are too curved. Number each element's last "
            "six nodes as the file's format does, or refine the mesh where it is curved."
        )
    least = jacobians(node, corner, np.concatenate([np.eye(4), POINTS])).min(axis=1)
    _require_positive(where, node, corner, least, "at its corners and points, so curved it is")
    ratio = radius_ratio(x[:, :4], straight)
    poor = np.flatnonzero(~(ratio >= POOR))
    if not len(poor):
        return []
    worst = poor[np.argmin(ratio[poor])]
    return [
        f"{where}: {len(poor)} of {len(corner)} elements are badly shaped (three times the radius "
        f"of the sphere within, over that around, below {POOR:g}), the worst with "
        f"{ratio[worst]:.2g}, element {worst} (from 0) at {_middle(node, corner, worst)} m: "
        "strains in them are inaccurate, and they make the step small."
    ]


def _require_positive(where: str, node: Array, corner: Whole, least: Array, at: str) -> None:
    bad = np.flatnonzero(~(least > 0.0))
    if len(bad):
        worst = bad[np.argmin(least[bad])]
        raise SceneError(
            f"{where}: element {worst} (from 0) at {_middle(node, corner, worst)} m must have a "
            f"Jacobian above 0 {at}; found {least[worst]:.3g} m3: it is inside out, and {len(bad)} "
            f"of {len(corner)} elements are. Reverse the order of their corners, or mesh it again."
        )


def radius_ratio(x: Array, six_volumes: Array) -> Array:
    """3 r/R (e,) of the spheres within and around tetrahedra with corners x (e, 4, 3)."""
    areas = sum(
        0.5 * np.linalg.norm(np.cross(x[:, j] - x[:, i], x[:, k] - x[:, i]), axis=1)
        for i, j, k in FACES[:, :3]
    )
    inner = 0.5 * six_volumes / areas
    products = [
        np.linalg.norm(x[:, j] - x[:, i], axis=1) * np.linalg.norm(x[:, m] - x[:, k], axis=1)
        for (i, j), (k, m) in (((0, 1), (2, 3)), ((0, 2), (1, 3)), ((0, 3), (1, 2)))
    ]
    a, b, c = products
    factors = [np.maximum(side, 0.0) for side in (a + b - c, a - b + c, b + c - a)]
    outer = np.sqrt((a + b + c) * factors[0] * factors[1] * factors[2]) / (4.0 * six_volumes)
    # Of flat elements the factors are lost in rounding; half an edge is never above the radius.
    longest = np.linalg.norm(x[:, EDGES[:, 1]] - x[:, EDGES[:, 0]], axis=2).max(axis=1)
    outer = np.maximum(outer, 0.5 * longest)
    return np.asarray(3.0 * inner / outer)


def _middle(node: Array, corner: Whole, element: int) -> str:
    return np.array2string(node[corner[element, :4]].mean(axis=0), precision=4)
