"""Mass that partners add to the nodes of the surface."""

import numpy as np

from quintet.components.fe_plate.ranks.method import Ranks, Rows
from quintet.components.fe_plate.state import Array, Model, State


class AddedMass:
    """Mass that moves with the nodes of the surface, beside their own.

    Parameters
    ----------
    surface : Rows
        Its nodes.
    mass : (n,) float array, kg
        Of this rank's nodes, without it.
    """

    def __init__(self, surface: Rows, mass: Array) -> None:
        self.surface, self.mass = surface, mass
        self.added = np.zeros(surface.size)  # kg, on all ranks

    def total(self) -> Array:
        """Mass (n,) kg of this rank's nodes with it."""
        total = self.mass.copy()
        total[self.surface.rows] += self.added[self.surface.ids]
        return total

    def replace(self, added: Array, model: Model, state: State, ranks: Ranks) -> float:
        """Replace the added mass (k,) kg; return the kinetic energy [J] that it brings.

        Released mass keeps the nodes' mean velocity of the last step.
        """
        rows, ids = self.surface.rows, self.surface.ids
        before = self.mass[rows] + self.added[ids]
        after = self.mass[rows] + added[ids]
        mean, old = state.mean_velocity[rows], state.velocity[rows]
        rest = (before / after)[:, None] * (old - mean)
        new = np.where((after != before)[:, None], mean + rest, old)
        state.velocity[rows] = new
        model.inverse_mass[rows] = 1.0 / after
        self.added = np.array(added)
        brought = 0.5 * (after * (new * new).sum(axis=1) - before * (old * old).sum(axis=1))
        return float(ranks.sums([brought])[0])

    def restore(self, added: Array, model: Model) -> None:
        """Restore a saved added mass (k,) kg."""
        self.added = np.array(added)
        rows, ids = self.surface.rows, self.surface.ids
        model.inverse_mass[rows] = 1.0 / (self.mass[rows] + self.added[ids])
