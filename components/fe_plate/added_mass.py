"""Mass that partners add to the nodes of the surface."""

import numpy as np

from quintet.components.fe_plate.kernels.nodes import kinetic_energy
from quintet.components.fe_plate.state import Array, Model, State, Whole


class AddedMass:
    """Mass that moves with the nodes of the surface, beside their own.

    Parameters
    ----------
    nodes : (k,) int array
        Of the surface.
    mass : (n,) float array, kg
        Of all nodes, without it.
    """

    def __init__(self, nodes: Whole, mass: Array) -> None:
        self.nodes, self.mass = nodes, mass
        self.added = np.zeros(len(nodes))  # kg

    def total(self) -> Array:
        """Mass (n,) kg of all nodes with it."""
        total = self.mass.copy()
        total[self.nodes] += self.added
        return total

    def replace(self, added: Array, model: Model, state: State) -> float:
        """Replace the added mass (k,) kg; return the kinetic energy [J] that it brings.

        Released mass keeps the nodes' mean velocity of the last step.
        """
        rows, before = self.nodes, self.mass[self.nodes] + self.added
        after = self.mass[rows] + added
        mean = state.mean_velocity[rows]
        rest = (before / after)[:, None] * (state.velocity[rows] - mean)
        changed = after != before
        energy = kinetic_energy(model, state)
        state.velocity[rows[changed]] = (mean + rest)[changed]
        model.inverse_mass[rows] = 1.0 / after
        self.added = np.array(added)
        return kinetic_energy(model, state) - energy

    def restore(self, added: Array, model: Model) -> None:
        """Restore a saved added mass (k,) kg."""
        self.added = np.array(added)
        model.inverse_mass[self.nodes] = 1.0 / (self.mass[self.nodes] + self.added)
