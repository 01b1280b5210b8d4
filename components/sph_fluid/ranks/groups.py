"""The rows of a state as two groups of columns: the fluid's, and those of walls and samples."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from quintet.components.sph_fluid.state import State, Whole

Columns = dict[str, NDArray[Any]]


def fluid_columns(state: State) -> Columns:
    """What the state has of each fluid particle, by the names of its arrays."""
    rows = slice(state.fluid)
    columns: Columns = {
        "position_density": state.position_density[rows],
        "velocity_pressure": state.velocity_pressure[rows],
        "previous_density_rate": state.previous_density_rate[rows],
        "identity": state.identity,
    }
    if len(state.acceleration):
        columns["acceleration"] = state.acceleration
    if len(state.exit_face):
        columns["exit_face"] = state.exit_face
    if len(state.minus_rho_div_u):
        columns["minus_rho_div_u"] = state.minus_rho_div_u[rows]
    return columns


def boundary_columns(state: State, are_mirrored: bool) -> Columns:
    """What the state has of each wall or sample particle, by the names of its arrays."""
    rows = slice(state.fluid, state.particles)
    columns: Columns = {
        "position_density": state.position_density[rows],
        "velocity_pressure": state.velocity_pressure[rows],
        "previous_density_rate": state.previous_density_rate[rows],
        "sample": state.sample,
    }
    if are_mirrored:
        columns["mirror_point"] = state.mirror_point
    if len(state.minus_rho_div_u):
        columns["minus_rho_div_u"] = state.minus_rho_div_u[rows]
    return columns


def taken(columns: Columns, rows: Whole) -> Columns:
    """Some rows of all columns, in this order."""
    return {name: column.take(rows, axis=0) for name, column in columns.items()}


def put(state: State, fluid: Columns, boundary: Columns) -> None:
    """Put other rows in place of those that a state has."""
    alone = {name: fluid for name in ("identity", "exit_face", "acceleration")}
    alone |= {name: boundary for name in ("sample", "mirror_point")}
    for name, columns in alone.items():
        if name in columns:
            setattr(state, name, columns[name])
    for name in fluid.keys() & boundary.keys():
        setattr(state, name, np.concatenate([fluid[name], boundary[name]]))
