"""Operators between the items of two components, each with its transpose.

Motion is gathered (consistent: a constant stays constant), forces are spread with the
transposed operator (conservative: sums, and power, stay the same to rounding).
"""

from dataclasses import dataclass

import numpy as np

from quintet.interfaces.component import Array


def rotation(quaternion: Array) -> Array:
    """Rotation matrices (n, 3, 3) of unit quaternions (n, 4) w, x, y, z; body to world."""
    w, x, y, z = quaternion.T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), 2, 0)


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
        return np.einsum("nij,nj->ni", rotation(orientation)[self.body], self.arm)

    def gather(
        self, position: Array, velocity: Array, orientation: Array, spin: Array
    ) -> tuple[Array, Array]:
        """Position (n, 3) m and velocity (n, 3) m/s of the samples of moving bodies."""
        arms = self.arms(orientation)
        return position[self.body] + arms, velocity[self.body] + np.cross(spin[self.body], arms)

    def spread(self, force: Array, arms: Array) -> tuple[Array, Array]:
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
    """

    node: Array
    weight: Array
    nodes: int

    def gather(self, values: Array) -> Array:
        """Values (nodes, k) at the points: (n, k)."""
        return np.einsum("nc,nck->nk", self.weight, values[self.node])

    def spread(self, values: Array) -> Array:
        """Amounts (n, k) at the points, given to the nodes: (nodes, k)."""
        parts = self.weight[:, :, None] * values[:, None, :]
        return sum_by(parts.reshape(-1, values.shape[1]), self.node.reshape(-1), self.nodes)


def bilinear(xi: Array, eta: Array) -> Array:
    """Shape functions (n, 4) of a quadrilateral at local coordinates (n,) from -1 to 1."""
    return 0.25 * np.stack(
        [(1 - xi) * (1 - eta), (1 + xi) * (1 - eta), (1 + xi) * (1 + eta), (1 - xi) * (1 + eta)],
        axis=1,
    )


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
    nodes, weights, areas, normals = [], [], [], []
    for corner in corners(face):
        a, b, c, d = position[corner]
        along = max(np.linalg.norm(b - a), np.linalg.norm(c - d))
        across = max(np.linalg.norm(d - a), np.linalg.norm(c - b))
        n, m = max(1, round(along / spacing)), max(1, round(across / spacing))
        xi, eta = np.meshgrid((np.arange(n) + 0.5) * 2 / n - 1, (np.arange(m) + 0.5) * 2 / m - 1)
        xi, eta = xi.ravel(), eta.ravel()
        tangent = 0.25 * (np.outer(1 - eta, b - a) + np.outer(1 + eta, c - d))
        cotangent = 0.25 * (np.outer(1 - xi, d - a) + np.outer(1 + xi, c - b))
        normal = np.cross(tangent, cotangent)
        length = np.linalg.norm(normal, axis=1)
        nodes.append(np.tile(corner, (n * m, 1)))
        weights.append(bilinear(xi, eta))
        areas.append(length * 4 / (n * m))
        normals.append(normal / length[:, None])
    shape = ShapeMap(np.concatenate(nodes), np.concatenate(weights), len(position))
    return shape, np.concatenate(areas), np.concatenate(normals)


def project(points: Array, position: Array, face: Array) -> ShapeMap:
    """Hang points (n, 3) on the faces they lie nearest to, by bilinear shape functions."""
    corner = corners(face)
    centre = position[corner].mean(axis=1)
    # One face per point, found point by point so that memory stays small for large meshes.
    chosen = np.array([np.argmin(((centre - p) ** 2).sum(axis=1)) for p in points], dtype=np.int64)
    node = corner[chosen]
    x = position[node]
    xi, eta = np.zeros(len(points)), np.zeros(len(points))
    for _ in range(20):  # Gauss-Newton for the foot of the perpendicular on each face
        gap = points - np.einsum("nc,nck->nk", bilinear(xi, eta), x)
        t = 0.25 * ((1 - eta)[:, None] * (x[:, 1] - x[:, 0]) + (1 + eta)[:, None] * (x[:, 2] - x[:, 3]))
        s = 0.25 * ((1 - xi)[:, None] * (x[:, 3] - x[:, 0]) + (1 + xi)[:, None] * (x[:, 2] - x[:, 1]))
        tt, ss, ts = (t * t).sum(1), (s * s).sum(1), (t * s).sum(1)
        gt, gs = (gap * t).sum(1), (gap * s).sum(1)
        det = tt * ss - ts * ts
        xi = np.clip(xi + (gt * ss - gs * ts) / det, -1.0, 1.0)
        eta = np.clip(eta + (gs * tt - gt * ts) / det, -1.0, 1.0)
    return ShapeMap(node, bilinear(xi, eta), len(position))
