"""Totals over all particles, and the report of a failed step."""

import numpy as np

from quintet.components.sph_solid.params import SphSolidParams
from quintet.components.sph_solid.state import Array, State, Whole
from quintet.interfaces.component import Totals
from quintet.interfaces.params import Vector


def totals(state: State, mass: Array, carried: Whole, gravity: Vector) -> Totals:
    """Mass, momentum and energies; a mesh carries mass and motion of glued particles.

    Parameters
    ----------
    state
    mass : (n,) float array, kg
    carried : (k,) int array
        Rows of glued particles.
    gravity : Vector, m/s2
    """
    free = mass.copy()
    free[carried] = 0.0
    momentum = free[:, None] * state.velocity
    return Totals(
        mass=float(free.sum()),
        momentum=momentum.sum(axis=0),
        angular_momentum=np.cross(state.position, momentum).sum(axis=0),
        kinetic=0.5 * float((momentum * state.velocity).sum()),
        potential=-float(free @ (state.position @ np.array(gravity))),
        internal=float((mass * state.energy).sum()),
    )


def failure(state: State, params: SphSolidParams, dt: float) -> str:
    """Say which particle a step [s] failed on, and what to do."""
    finite = np.isfinite(state.position).all(axis=1) & np.isfinite(state.velocity).all(axis=1)
    finite &= np.isfinite(state.acceleration).all(axis=1)
    speed = np.where(finite, np.abs(state.velocity).max(axis=1), np.inf)  # squares may overflow
    row = int(np.argmax(speed))
    x, y, z = state.position[row]
    return (
        f"step of {dt:.3g} s at {state.time:.4g} s: in a step particles must stay finite and move "
        f"by little more than a smoothing length, {params.length:.3g} m; particle "
        f"{state.identity[row]} of body {state.body[row]}, at ({x:.4g}, {y:.4g}, {z:.4g}) m, has "
        f"{speed[row]:.4g} m/s, a density of {state.density_ratio[row]:.4g} of that at rest and "
        f"{state.pressure[row]:.3g} Pa. Lower courant (now {params.courant}), raise the "
        "viscosities, or look for bodies that overlap at the start."
    )
