"""Rows of fluid that are added to a state, or taken out of it."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from quintet.components.sph_fluid.state import Array, State, Whole


class NewRows(NamedTuple):
    """Particles that the fluid did not have."""

    position_density: Array  # (k, 4) m, m, m, kg/m3
    velocity: Array  # (k, 3) m/s
    role: Whole  # (k,) as of the state


def add_rows(state: State, rows: NewRows) -> None:
    """Add particles behind the others of the fluid, numbered on from the last that was born.

    All arrays are made anew when neighbour lists are made, so that this costs nothing more.
    """
    count, split, end = len(rows.role), state.fluid, state.particles
    motion = np.column_stack([rows.velocity, np.zeros(count)])
    state.position_density = _between(state.position_density, rows.position_density, split, end)
    state.velocity_pressure = _between(state.velocity_pressure, motion, split, end)
    none = np.zeros(count)
    state.previous_density_rate = _between(state.previous_density_rate, none, split, end)
    if len(state.minus_rho_div_u):
        state.minus_rho_div_u = _between(state.minus_rho_div_u, none, split, end)
    if len(state.acceleration):
        state.acceleration = np.concatenate([state.acceleration, np.zeros((count, 3))])
    state.identity = np.concatenate([state.identity, state.born + np.arange(count)])
    state.exit_face = np.concatenate([state.exit_face, np.zeros(count, np.int64)])
    state.role = np.concatenate([state.role, rows.role])
    state.born += count


def _between(array: Array, more: Array, split: int, end: int) -> Array:
    """Rows of the fluid, more of them, and rows of the boundary; images are left out."""
    return np.concatenate([array[:split], more, array[split:end]])


def take_out(state: State, is_out: NDArray[np.bool_]) -> None:
    """Take particles (fluid,) out of the fluid."""
    if is_out.any():
        state.keep(np.flatnonzero(~is_out), np.arange(len(state.sample)))
