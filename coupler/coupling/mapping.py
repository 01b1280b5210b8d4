"""Operators between the items of two components, each with its transpose.

Motion is mapped consistently (a constant stays constant), forces conservatively, with the
transposed operator (sums, and power, stay the same to rounding).
"""

from dataclasses import dataclass

import numpy as np

from quintet.interfaces.component import Array
from quintet.interfaces.rotation import matrix


def sum_by(values: Array, owner: Array, owners: int) -> Array:
    """Sum rows (n, k) into their owners (owners, k), in order, so that bits never change."""
    columns = [np.bincount(owner, column, owners) for column in values.T]
    return np.stack(columns, axis=1) if len(columns) else np.zeros((owners, 0))


@dataclass(slots=True)
class RigidMap:
    """Samples fixed to rigid bodies.

    Attributes
    ----------
    arm : (n, 3) float array, m
        Each sample from its body's centre, in the body's frame.
    body : (n,) int array
        Which body a sample belongs to.
    """

    arm: Array
    body: Array
    bodies: int

    def arms(self, orientation: Array) -> Array:
        """Arms in the world frame (n, 3) m, for orientations (bodies, 4)."""
        return np.einsum("nij,nj->ni", matrix(orientation)[self.body], self.arm)

    def map_consistent(
        self, position: Array, velocity: Array, orientation: Array, angular_velocity: Array
    ) -> tuple[Array, Array]:
        """Position (n, 3) m and velocity (n, 3) m/s of the samples of moving bodies."""
        arms = self.arms(orientation)
        turning = np.cross(angular_velocity[self.body], arms)
        return position[self.body] + arms, velocity[self.body] + turning

    def map_conservative(self, force: Array, arms: Array) -> tuple[Array, Array]:
        """Force and torque about the centre (bodies, 3) of forces (n, 3) at arms (n, 3)."""
        return (
            sum_by(force, self.body, self.bodies),
            sum_by(np.cross(arms, force), self.body, self.bodies),
        )


@dataclass(slots=True)
class ShapeMap:
    """Points on the faces of a mesh, by the faces' shape functions.

    Attributes
    ----------
    node : (n, 4) int array
        Corners of the face on which each point lies.
    weight : (n, 4) float array, 1
        Shape functions there; each row sums to one.
    face : (n,) int array
        Number of that face.
    """

    node: Array
    weight: Array
    nodes: int
    face: Array

    def map_consistent(self, values: Array) -> Array:
        """Values (nodes, k) at the points: (n, k)."""
        return np.einsum("nc,nck->nk", self.weight, values[self.node])

    def map_conservative(self, values: Array) -> Array:
        """Amounts (n, k) at the points, given to the nodes: (nodes, k)."""
        parts = self.weight[:, :, None] * values[:, None, :]
        return sum_by(parts.reshape(-1, values.shape[1]), self.node.reshape(-1), self.nodes)


def bilinear(xi: Array, eta: Array) -> Array:
    """Shape functions (n, 4) of a quadrilateral at local coordinates (n,) from -1 to 1."""
    return 0.25 * np.stack(
        [(1 - xi) * (1 - eta), (1 + xi) * (1 - eta), (1 + xi) * (1 + eta), (1 - xi) * (1 + eta)],
        axis=1,
    )


def tangents(xi: Array, eta: Array, x: Array) -> tuple[Array, Array]:
    """Derivatives (n, 3) of the position on faces with corners (n, 4, 3), along xi and eta."""
    a, b, c, d = np.moveaxis(x, 1, 0)
    along = 0.25 * ((1 - eta)[:, None] * (b - a) + (1 + eta)[:, None] * (c - d))
    across = 0.25 * ((1 - xi)[:, None] * (d - a) + (1 + xi)[:, None] * (c - b))
    return along, across


def corners(face: Array) -> Array:
    """Corners (m, 4) with triangles closed: a triangle's last corner stands twice."""
    face = np.asarray(face, dtype=np.int64)
    return np.where(face < 0, face[:, 2:3], face)


def sample_faces(position: Array, face: Array, spacing: float) -> tuple[ShapeMap, Array, Array]:
    """Sample faces (m, 4) at a spacing [m].

    Returns
    -------
    ShapeMap, area of each sample (n,) m2, normal (n, 3)
    """
    nodes, weights, areas, normals, faces = [], [], [], [], []
    for number, corner in enumerate(corners(face)):
        a, b, c, d = position[corner]
        along = max(np.linalg.norm(b - a), np.linalg.norm(c - d))
        across = max(np.linalg.norm(d - a), np.linalg.norm(c - b))
        n, m = max(1, round(along / spacing)), max(1, round(across / spacing))
        grid = np.meshgrid((np.arange(n) + 0.5) * 2 / n - 1, (np.arange(m) + 0.5) * 2 / m - 1)
        xi, eta = (axis.ravel() for axis in grid)
        normal = np.cross(*tangents(xi, eta, position[corner][None]))
        length = np.linalg.norm(normal, axis=1)
        nodes.append(np.tile(corner, (n * m, 1)))
        faces.append(np.full(n * m, number))
        weights.append(bilinear(xi, eta))
        areas.append(length * 4 / (n * m))
        normals.append(normal / length[:, None])
    owner = np.concatenate(faces)
    shape = ShapeMap(np.concatenate(nodes), np.concatenate(weights), len(position), owner)
    return shape, np.concatenate(areas), np.concatenate(normals)


def project(points: Array, position: Array, face: Array) -> ShapeMap:
    """Hang points (n, 3) on the faces they lie nearest to, by bilinear shape functions."""
    corner = corners(face)
    point, candidate = _candidates(points, position[corner])
    target, x = points[point], position[corner[candidate]]
    xi, eta = _foot(target, x)
    distance = np.linalg.norm(target - np.einsum("nc,nck->nk", bilinear(xi, eta), x), axis=1)
    order = np.lexsort((distance, point))  # stable: of equally near faces the first
    _, first = np.unique(point[order], return_index=True)
    best = order[first]
    weight, owner = bilinear(xi[best], eta[best]), candidate[best]
    return ShapeMap(corner[owner], weight, len(position), owner)


def _candidates(points: Array, x: Array) -> tuple[Array, Array]:
    """Pairs of point and face, of all faces (m, 4, 3) that may be the nearest to the point."""
    centre = x.mean(axis=1)
    reach = np.linalg.norm(x - centre[:, None], axis=2).max(axis=1)
    found = []
    for p in points:  # one by one, so that memory stays small for large meshes
        away = np.linalg.norm(centre - p, axis=1)
        found.append(np.flatnonzero(away - reach <= away.min()))
    counts = [len(faces) for faces in found]
    return np.repeat(np.arange(len(points)), counts), np.concatenate([np.zeros(0, int), *found])


def _foot(points: Array, x: Array) -> tuple[Array, Array]:
    """Local coordinates of the foot of the perpendicular from points (n, 3) on faces (n, 4, 3)."""
    xi, eta = np.zeros(len(points)), np.zeros(len(points))
    for _ in range(20):  # Gauss-Newton, kept on the face
        gap = points - np.einsum("nc,nck->nk", bilinear(xi, eta), x)
        t, s = tangents(xi, eta, x)
        tt, ss, ts = (t * t).sum(1), (s * s).sum(1), (t * s).sum(1)
        gt, gs = (gap * t).sum(1), (gap * s).sum(1)
        det = np.maximum(tt * ss - ts * ts, 1e-12 * tt.max(initial=0.0) ** 2 + 1e-300)
        xi = np.clip(xi + (gt * ss - gs * ts) / det, -1.0, 1.0)
        eta = np.clip(eta + (gs * tt - gt * ts) / det, -1.0, 1.0)
    return xi, eta
