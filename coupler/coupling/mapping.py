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
    """

    node: Array
    weight: Array
    nodes: int

    def map_consistent(self, values: Array) -> Array:
        """Values (nodes, k) at the points: (n, k)."""
        return np.einsum("nc,nck->nk", self.weight, values[self.node])

    def map_conservative(self, values: Array) -> Array:
        """Amounts (n, k) at the points, given to the nodes: (nodes, k)."""
        parts = self.weight[:, :, None] * values[:, None, :]
        return sum_by(parts.reshape(-1, values.shape[1]), self.node.reshape(-1), self.nodes)


@dataclass(slots=True)
class OffsetMap:
    """Points below the faces of a mesh, along the normals of these as they move.

    A point lies at x(ξ, η) - d n, with n = t × s / |t × s| of the tangents t = ∂x/∂ξ, s = ∂x/∂η.
    Forces go back by the transpose of the velocity, which is linear in that of the nodes: so they
    do the same work, and keep their moments.

    Attributes
    ----------
    surface, along, across : ShapeMap
        Of x, t and s: shape functions at the feet of the points, and their derivatives.
    depth : (n,) float array, m
        Of the points below the faces.
    side : (n, 3) float array, m
        Added to s: half of the depth along y where faces are edges, else none.
    """

    surface: ShapeMap
    along: ShapeMap
    across: ShapeMap
    depth: Array
    side: Array

    def tangents(self, position: Array) -> tuple[Array, Array]:
        """Tangents t and s (n, 3) m of a mesh with its nodes at (nodes, 3) m."""
        t = self.along.map_consistent(position)
        return t, self.across.map_consistent(position) + self.side

    def normals(self, position: Array) -> Array:
        """Outward normals (n, 3)."""
        normal = np.cross(*self.tangents(position))
        return np.asarray(normal / np.linalg.norm(normal, axis=1)[:, None])

    def map_consistent(self, position: Array, velocity: Array) -> tuple[Array, Array, Array]:
        """Position and velocity of the points, and where they are mirrored in their faces."""
        t, s = self.tangents(position)
        normal, over = _unit(np.cross(t, s))
        turning = np.cross(self.along.map_consistent(velocity), s)
        turning += np.cross(t, self.across.map_consistent(velocity))
        turning -= (turning * normal).sum(axis=1)[:, None] * normal
        below, foot = self.depth[:, None] * normal, self.surface.map_consistent(position)
        moving = self.surface.map_consistent(velocity)
        return foot - below, moving - (self.depth * over)[:, None] * turning, foot + below

    def map_conservative(self, force: Array, position: Array) -> Array:
        """Forces (nodes, 3) of forces (n, 3) on the points, for nodes at (nodes, 3) m."""
        t, s = self.tangents(position)
        normal, over = _unit(np.cross(t, s))
        turn = force - (force * normal).sum(axis=1)[:, None] * normal
        turn *= -(self.depth * over)[:, None]
        on_nodes = self.surface.map_conservative(force)
        on_nodes += self.along.map_conservative(np.cross(s, turn))
        return np.asarray(on_nodes + self.across.map_conservative(np.cross(turn, t)))


def _unit(vector: Array) -> tuple[Array, Array]:
    """Unit vectors (n, 3), and one over the lengths (n,)."""
    over = 1.0 / np.linalg.norm(vector, axis=1)
    return vector * over[:, None], over
