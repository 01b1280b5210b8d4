"""Contact of a grid of points on the coupled faces with the faces of a partner's mesh."""

import numpy as np
from scipy.sparse import csr_array

from quintet.components.fe_plate.contact_surface import DEPTH
from quintet.components.fe_plate.state import Array, Whole
from quintet.components.shared.contact.kernels import Points
from quintet.components.shared.contact.moduli import longitudinal_modulus
from quintet.components.shared.contact.penalty import HEAD, PenaltyContact
from quintet.components.shared.geometry.face_projection import (
    at_points,
    bilinear,
    corners,
    derivatives,
)
from quintet.interfaces.component import Fields

ACROSS = 4  # points across a face of the partner, where a link says nothing
NARROW = 0.1  # of the partner's faces may be narrower than what points are placed for
FEWEST, MOST = 2, 16  # points along a side of a face: one alone would let the face turn
OPEN = f"{HEAD}open"  # key in saved states
NONE = np.zeros(0)  # of what only spheres have
NO_SPIN = np.zeros((0, 3)), NONE  # rad/s, and 1/(kg m2)
NONE_FIXED = np.zeros(0, np.int64)  # the supports of nodes hold them


class PartnerFaces:
    """Contact of a grid of points on this mesh's coupled faces with the partner's faces.

    Equal cells in ξ and η divide each face; the points are their midpoints. Each point bears the
    penalty force of its cell; its force is distributed to the nodes by the shape functions. So a
    flat surface presses evenly on its own nodes, and on those of the partner to the error of the
    midpoint rule, which falls with the square of the distance of points over the width of the
    partner's faces (a "Gauss-point-to-surface" contact: De Lorenzis, Wriggers & Zavarise,
    GAMM-Mitt. 37 (2014) 85).

    Parameters
    ----------
    static : mapping of arrays
        Static fields of port `contact_faces`.
    surface : mapping of arrays
        ``start`` (k, 3) m and ``mass`` (k,) kg of nodes; ``corner`` (f, 4), ``bulk`` and ``shear``
        (f,) Pa and ``thickness`` (f,) m of the own faces.
    velocity : (k, 3) float array, m/s
        Of the nodes at the start.
    """

    def __init__(self, static: Fields, surface: Fields, velocity: Array) -> None:
        across = int(static["contact_faces.points"].max()) or ACROSS
        narrow = np.quantile(static["contact_faces.width"], NARROW, method="lower")
        distance = float(narrow) / across  # m
        start, corner = surface["start"], corners(surface["corner"])
        several = points_along(start, corner, distance)
        most = int(several.max(initial=0))
        self.note = ""
        if most > MOST:
            self.note = (
                f"contact: the partner's faces are so fine that {most} points per side would be "
                f"needed; {MOST} are used and the pressure may be uneven. Set contact_with_faces "
                "in the finer mesh, or take faces that are less elongated."
            )
        self.face, weight, self.area = surface_points(start, corner, np.minimum(several, MOST))
        count = len(self.face)
        begin, nodes = np.arange(0, 4 * count + 1, 4), corner[self.face].ravel()
        self.shares = csr_array((weight.ravel(), nodes, begin), shape=(count, len(start)))
        self.radius = 0.5 * surface["thickness"][self.face]
        self.modulus = longitudinal_modulus(surface["bulk"], surface["shear"])[self.face]
        self.node_mass = surface["mass"]
        self.penalty = PenaltyContact(static, count, self.radius, on_surface=True)
        self.penalty.start(self.shares @ velocity)
        self._open(np.ones(len(corner)))

    def _open(self, open_faces: Array) -> None:
        """Take the points of the faces (f,) that are part of the surface."""
        self.open_faces = open_faces
        self.rows = np.flatnonzero(open_faces[self.face] > 0.0)
        self.open_shares = self.shares[self.rows]
        area = self.area[self.rows]
        # kg, effective mass of a point under uniform pressure: 1/m_q = Σ N_c A_c/m_c / A_q.
        yielding = self.open_shares @ ((self.open_shares.T @ area) / self.node_mass)
        self.mass = area / yielding

    def push(self, position: Array, velocity: Array, open_faces: Array | None, dt: float) -> Array:
        """Forces (k, 3) N on the nodes in a step of dt [s], as they are at its begin.

        Parameters
        ----------
        position : (k, 3) float array, m
            Of the nodes.
        velocity : (k, 3) float array, m/s
            Mean of the last step.
        open_faces : (f,) float array, 1, or None
            Which of the own faces are part of the surface; None: all.
        dt : float, s
        """
        points = self._points(position, velocity)
        if open_faces is not None and not np.array_equal(open_faces, self.open_faces):
            self._open(open_faces)
            before, points = points, self._points(position, velocity)
            self.penalty.replace_points(before, points)
        self.penalty.kick(points, dt)
        kicked = self.penalty.kicked[self.rows]  # m/s, half of the step's change by contact
        return np.asarray(self.open_shares.T @ ((2.0 / dt * self.mass)[:, None] * kicked))

    def save(self) -> Fields:
        """Copy out all state; faces that eroded since the last push still count as open."""
        return {**self.penalty.save(), OPEN: self.open_faces.copy()}

    def load(self, state: Fields) -> None:
        """Restore a saved state, bit for bit."""
        self._open(np.array(state[OPEN]))
        self.penalty.load(state)

    def beginning(self, state: Fields) -> Fields:
        """Return what `load` needs of the state of another run: its history, where it suits."""
        former = state.get(OPEN, self.open_faces)
        is_same = former.shape == self.open_faces.shape
        return {**self.penalty.beginning(state), OPEN: former if is_same else self.open_faces}

    def warnings(self) -> dict[str, str]:
        """Warn of faces that were nearly passed, and of fewer points than are needed."""
        texts = self.penalty.warnings()
        return texts | {"contact_points": self.note} if self.note else texts

    def _points(self, position: Array, velocity: Array) -> Points:
        rows, shares = self.rows, self.open_shares
        return Points(
            shares @ position, shares @ velocity, rows, self.mass, self.area[rows],
            self.modulus[rows], NONE, self.radius[rows], *NO_SPIN, NONE_FIXED,
        )  # fmt: skip


def points_along(start: Array, corner: Whole, distance: float) -> Whole:
    """Points (2, f) along ξ and η of faces, at most a distance [m] from each other; 1 across edges.

    Parameters
    ----------
    start : (k, 3) float array, m
        Nodes.
    corner : (f, 4) int array
        Of the faces, closed.
    distance : float, m
    """
    x = start[corner]
    side = np.linalg.norm(np.roll(x, -1, axis=1) - x, axis=2)  # m: a-b, b-c, c-d, d-a
    along, across = np.maximum(side[:, 0], side[:, 2]), np.maximum(side[:, 1], side[:, 3])
    several = np.ceil(np.stack([along, across]) / distance - 1e-9).astype(np.int64)
    several[1] = np.where(is_edge(corner), 1, several[1])
    return np.maximum(several, np.where(is_edge(corner), [[FEWEST], [1]], FEWEST))


def is_edge(corner: Whole) -> Array:
    """Whether faces (f, 4), closed, are edges, which go forth and back."""
    return np.asarray(corner[:, 0] == corner[:, 3])


def surface_points(start: Array, corner: Whole, several: Whole) -> tuple[Whole, Array, Array]:
    """Points of faces: midpoints of equal cells.

    Parameters
    ----------
    start : (k, 3) float array, m
        Nodes.
    corner : (f, 4) int array
        Of the faces, closed.
    several : (2, f) int array
        Points along ξ and η.

    Returns
    -------
    face : (p,) int array
    weight : (p, 4) float array, 1
        Shape functions of the face's corners.
    area : (p,) float array, m2
        Of its cell; of edges, 1 m deep.
    """
    count = several.prod(axis=0)
    face = np.repeat(np.arange(len(corner)), count)
    number = np.arange(len(face)) - np.repeat(np.cumsum(count) - count, count)
    local = number % several[0, face], number // several[0, face]
    xi, eta = ((2 * n + 1) / of - 1.0 for n, of in zip(local, several[:, face], strict=True))
    x, slopes = start[corner[face]], derivatives(xi, eta)
    along, across = (
        at_points(slope, x) * (2.0 / of)[:, None]
        for slope, of in zip(slopes, several[:, face], strict=True)
    )
    area = np.linalg.norm(np.cross(along, across), axis=1)
    edge = DEPTH * np.linalg.norm(along, axis=1)
    return face, bilinear(xi, eta), np.where(is_edge(corner)[face], edge, area)
