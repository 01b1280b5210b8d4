"""Energy of a small lattice of all pairs, its gradient and its stiffness."""

import numpy as np
from numpy.polynomial import polynomial

from quintet.components.particle_dynamics.build import build
from quintet.components.particle_dynamics.coefficients import MIDDLE, SevenRoots
from quintet.components.particle_dynamics.kernels.forces import count_intact
from quintet.components.particle_dynamics.params import ParticleLatticeParams
from quintet.components.shared.search.nearest import nearest_rows
from quintet.interfaces.component import Array
from quintet.interfaces.errors import SceneError


class LatticeEnergy:
    """Energy of a lattice of seven-root pairs with tethers, its gradient and its stiffness.

    Parameters
    ----------
    params : ParticleLatticeParams
        Without periodic sides.

    Raises
    ------
    SceneError
        The force of pairs comes from a table.
    """

    def __init__(self, params: ParticleLatticeParams) -> None:
        built = build(params)
        if not isinstance(built.law, SevenRoots):
            raise SceneError(
                "lattice: the force of pairs must be seven_roots; found force_table. Use another "
                "scene."
            )
        self.law, self.start, self.bonds = built.law, built.start, built.bonds
        self.mass, self.spacing = params.lattice.mass, params.lattice.spacing
        self.boltzmann = params.boltzmann
        count = len(self.start)
        self.i, self.j = np.triu_indices(count, 1)
        nearest = np.zeros((count, count))
        nearest[tuple(built.bonds.T)] = nearest[tuple(built.bonds.T[::-1])] = 1.0
        friction = 0.5 * params.collision_rate * (np.diag(nearest.sum(axis=1)) - nearest)
        self.tether = np.zeros(count)  # N/m
        for bath in params.baths:
            rows = nearest_rows(self.start, [bath.lowest])
            self.tether[rows] = bath.tether
            friction[rows, rows] += bath.rate
        self.friction = np.kron(friction, np.eye(3))  # 1/s

    def energy(self, position: Array) -> float:
        """Energy [J] of points (n, 3) m."""
        length = np.linalg.norm(position[self.i] - position[self.j], axis=1)
        pairs = self._of_pairs(length, 0) * self.law.strength / self.law.per_metre
        moved = ((position - self.start) ** 2).sum(axis=1)
        return float(pairs.sum() + 0.5 * self.tether @ moved)

    def gradient(self, position: Array) -> Array:
        """Derivative (n, 3) N of the energy."""
        arm = position[self.i] - position[self.j]
        length = np.linalg.norm(arm, axis=1)
        force = (self._of_pairs(length, 1) * self.law.strength / length)[:, None] * arm
        gradient = self.tether[:, None] * (position - self.start)
        np.add.at(gradient, self.i, force)
        np.add.at(gradient, self.j, -force)
        return np.asarray(gradient)

    def stiffness(self, position: Array) -> Array:
        """Second derivative (3 n, 3 n) N/m of the energy."""
        arm = position[self.i] - position[self.j]
        length = np.linalg.norm(arm, axis=1)
        along = self._of_pairs(length, 2) * self.law.strength * self.law.per_metre
        across = self._of_pairs(length, 1) * self.law.strength / length
        arm = arm / length[:, None]
        springs = (along - across)[:, None, None] * arm[:, :, None] * arm[:, None, :]
        springs += across[:, None, None] * np.eye(3)
        matrix = np.zeros((len(position), 3, len(position), 3))
        for i, j, spring in zip(self.i, self.j, springs, strict=True):
            matrix[i, :, i] += spring
            matrix[j, :, j] += spring
            matrix[i, :, j] -= spring
            matrix[j, :, i] -= spring
        tethers = np.diag(np.repeat(self.tether, 3))
        return np.asarray(matrix.reshape(position.size, position.size) + tethers)

    def intact(self, position: Array) -> int:
        """Number of bonds between nearest points that are 0.8 to 1.2 spacings long."""
        return int(count_intact(position, self.bonds, self.spacing, None))

    def _of_pairs(self, length: Array, order: int) -> Array:
        """Derivative of the pairs' energy, over the strength and in spacings."""
        x = length * self.law.per_metre
        inner, outer = (
            polynomial.polyval(x - MIDDLE, polynomial.polyder(series, order))
            for series in (self.law.inner, self.law.outer)
        )
        return np.where(x <= self.law.begin, inner, np.where(x < 2.0, outer, 0.0))
