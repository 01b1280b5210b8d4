"""Totals of spheres, and the warning of those pressed into each other."""

import numpy as np

from quintet.components.particle_dynamics.spheres.ranks.method import Ranks
from quintet.components.particle_dynamics.spheres.state import DEEPEST, HEATED, LOST, State
from quintet.interfaces.component import Array, Totals

OVERLAPPING = 0.01  # of the smaller diameter: spheres that overlap by more are wrong


def totals(ranks: Ranks, gravity: Array) -> Totals:
    """Mass, momentum and energies of all ranks; internal is heat, that of impacts included.

    Work is what launches gave to spheres.
    """
    spheres, state = ranks.spheres, ranks.state
    mass, inertia = spheres.mass, spheres.inertia
    x, y, z = state.position.T
    u, v, w = (mass[:, None] * state.velocity).T
    p, q, r = (inertia[:, None] * state.spin).T
    moment = y * w - z * v + p, z * u - x * w + q, x * v - y * u + r
    moving = u * state.velocity[:, 0] + v * state.velocity[:, 1] + w * state.velocity[:, 2]
    turning = p * state.spin[:, 0] + q * state.spin[:, 1] + r * state.spin[:, 2]
    stretched = spheres.tether * ((state.position - spheres.start) ** 2).sum(axis=1)  # J
    fallen = mass * (x * gravity[0] + y * gravity[1] + z * gravity[2])  # J
    columns = [mass, u, v, w, *moment, moving + turning, stretched, fallen, _launched(ranks)]
    sums = ranks.sums(columns)
    return Totals(
        mass=float(sums[0]),
        momentum=sums[1:4],
        angular_momentum=sums[4:7],
        kinetic=0.5 * float(sums[7]),
        potential=0.5 * float(sums[8]) - float(sums[9]),
        internal=float(state.sums[LOST] + state.sums[HEATED]),
        work=0.5 * float(sums[10]),
        dissipated=0.0,  # impacts and drag heat the spheres
    )


def _launched(ranks: Ranks) -> Array:
    """Twice the kinetic energy (n,) J that each sphere was launched with after the start."""
    spheres = ranks.spheres
    moving = spheres.mass * (spheres.first_velocity**2).sum(axis=1)
    turning = spheres.inertia * (spheres.first_spin**2).sum(axis=1)
    later = ranks.state.launched & (spheres.launch > 0.0)
    return np.where(later, moving + turning, 0.0)


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
