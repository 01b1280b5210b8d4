"""What a picture shows: particles with their stress, strain and damage."""

import numpy as np

from quintet.components.sph_solid.state import Array, State
from quintet.interfaces.component import Fields


def von_mises(deviator: Array) -> Array:
    """Equivalent stress (n,) Pa of deviators (n, 6) Pa."""
    xx, yy, zz, xy, yz, zx = deviator.T
    squares = 1.5 * (xx * xx + yy * yy + zz * zz) + 3.0 * (xy * xy + yz * yz + zx * zx)
    return np.asarray(np.sqrt(squares))


def view(state: State) -> Fields:
    """Copy particles in the order of their birth."""
    rows = np.argsort(state.identity)
    return {
        "points": state.position[rows],
        "von_mises": von_mises(state.deviator[rows]),
        "velocity": state.velocity[rows],
        "pressure": state.pressure[rows],
        "plastic_strain": state.strain[rows],
        "damage": np.minimum(state.damage[rows], 1.0),
        "temperature": state.temperature[rows],
        "body": state.body[rows].astype(np.float64),
    }
