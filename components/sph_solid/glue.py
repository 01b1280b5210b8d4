"""Particles glued to a partner's mesh: they move with it, and it carries their mass.

Their rows in ports keep the order of the start. All functions do nothing without such particles.
"""

import numpy as np

from quintet.components.sph_solid.ranks.method import Ranks
from quintet.components.sph_solid.state import Array, State, Whole
from quintet.interfaces.params import Vector


def glued_rows(state: State, attached: bool = False) -> Whole:
    """Rows of particles that were glued at the start, or of those still attached; in port order.

    Which of all they are is in `state.glue`: one rank has all, of several each has its own.
    """
    rows = np.flatnonzero(state.glue >= 0)
    rows = rows[np.argsort(state.glue[rows])]
    return rows[state.active[state.glue[rows]] > 0.0] if attached else rows


def release(state: State, active: Array, mass: Array, gravity: Vector, ranks: Ranks) -> None:
    """Set which are attached (glued,), with masses (n,) kg.

    Released ones bring the energy of their motion, and of their place in gravity [m/s2].
    """
    if (active < state.active).any():
        rows = glued_rows(state)
        rows = rows[(active < state.active)[state.glue[rows]]]
        squares = (state.velocity[rows] ** 2).sum(axis=1)
        fallen = (state.position[rows] * gravity).sum(axis=1)
        columns = np.column_stack([mass[rows], squares, fallen])
        masses, squares, fallen = np.ascontiguousarray(ranks.all_rows(state.glue[rows], columns).T)
        state.work += 0.5 * float(masses @ squares) - float(masses @ fallen)
    state.active[:] = active


def pull(state: State) -> None:
    """Give attached particles the velocities of this step."""
    if len(state.active):
        rows = glued_rows(state, attached=True)
        state.velocity[rows], state.acceleration[rows] = state.pulled[state.glue[rows]], 0.0


def add_work(state: State, dt: float) -> None:
    """Add the work that the mesh does on attached particles in half a step of dt [s]."""
    if len(state.active):
        state.work -= 0.5 * dt * float((state.force * state.pulled).sum())


def write_forces(state: State, mass: Array, ranks: Ranks) -> None:
    """Write the forces [N] of attached particles, without gravity, of masses (n,) kg."""
    if len(state.active):
        rows = glued_rows(state)
        force = ranks.all_rows(state.glue[rows], mass[rows, None] * state.acceleration[rows])
        state.force[:] = force * state.active[:, None]
