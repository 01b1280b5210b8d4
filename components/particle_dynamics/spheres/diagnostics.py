"""Totals of spheres, and the warning of those pressed into each other."""

import numpy as np

from quintet.components.particle_dynamics.spheres.state import (
    DEEPEST,
    HEATED,
    LOST,
    Spheres,
    State,
)
from quintet.interfaces.component import Array, Totals

OVERLAPPING = 0.01  # of the smaller diameter: spheres that overlap by more are wrong


def totals(spheres: Spheres, state: State, gravity: Array) -> Totals:
    """Mass, momentum and energies; internal is heat, that of impacts included."""
    momentum = spheres.mass[:, None] * state.velocity
    turning = spheres.inertia[:, None] * state.spin
    moment = np.cross(state.position, momentum) + turning
    kinetic = 0.5 * float((momentum * state.velocity).sum() + (turning * state.spin).sum())
    stretched = ((state.position - spheres.start) ** 2).sum(axis=1)  # m2
    fallen = float(spheres.mass @ (state.position @ gravity))
    return Totals(
        mass=float(spheres.mass.sum()),
        momentum=momentum.sum(axis=0),
        angular_momentum=moment.sum(axis=0),
        kinetic=kinetic,
        potential=0.5 * float(spheres.tether @ stretched) - fallen,
        internal=float(state.sums[LOST] + state.sums[HEATED]),
    )


def warnings(state: State) -> dict[str, str]:
    """Warn of spheres that were pressed into each other, or into walls."""
    deepest = float(state.sums[DEEPEST])
    if deepest <= OVERLAPPING:
        return {}
    sentence = (
        f"spheres overlapped by up to {100.0 * deepest:.2g} % of a diameter; impacts must "
        f"keep them apart within {100.0 * OVERLAPPING:g} %. Hard spheres can neither rest on "
        "one another nor be packed densely. Take dem_bodies for piles and packings."
    )
    return {"overlap": sentence}
