"""Readings of bodies, gauges and levels, as their ports give them."""

import numpy as np

from quintet.components.sph_solid.params import SphSolidParams
from quintet.components.sph_solid.state import Array, State, Whole
from quintet.components.sph_solid.view import von_mises
from quintet.interfaces.component import Fields


def bodies(state: State, mass: Array, params: SphSolidParams) -> Fields:
    """Motion, energies and extent of each body, in the fields of the port `bodies`."""
    count = len(params.bodies)

    def total(values: Array) -> Array:
        """Sums (bodies,) of values (n,) times masses."""
        return np.bincount(state.body, mass * values, count).astype(np.float64)

    whole = total(np.ones(len(mass)))

    def mean(values: Array) -> Array:
        """Means (bodies, k) of values (n, k)."""
        return np.stack([total(column) / whole for column in values.T], axis=1)

    low, high = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
    np.minimum.at(low, state.body, state.position)
    np.maximum.at(high, state.body, state.position)
    half = 0.5 * params.spacing
    return {
        "bodies.position": mean(state.position),
        "bodies.velocity": mean(state.velocity),
        "bodies.kinetic": 0.5 * total((state.velocity**2).sum(axis=1)),
        "bodies.internal": total(state.energy),
        "bodies.failed": total(state.failed) / whole,
        "bodies.lowest": low - half,
        "bodies.highest": high + half,
    }


def gauges(state: State, rows: Whole, density: Array) -> Fields:
    """Motion and stress of the particles in some rows, in the fields of the port `gauges`."""
    deviator, pressure = state.deviator[rows], state.pressure[rows]
    return {
        "gauges.position": state.position[rows],
        "gauges.velocity": state.velocity[rows],
        "gauges.stress": deviator[:, :3] - pressure[:, None],
        "gauges.pressure": pressure,
        "gauges.von_mises": von_mises(deviator),
        "gauges.density": density[state.material[rows]] * state.density_ratio[rows],
        "gauges.plastic_strain": state.strain[rows],
        "gauges.failed": state.failed[rows],
        "gauges.temperature": state.temperature[rows],
    }


def levels(state: State, params: SphSolidParams) -> Fields:
    """Ends of whole material along lines through bodies, in the fields of the port `levels`.

    Of particles within a smoothing length of the line, or if there are none of the nearest one.
    """
    ends = []
    for level in params.levels:
        rows = np.flatnonzero((state.body == level.body) & (state.failed == 0.0))
        if not len(rows):
            rows = np.flatnonzero(state.body == level.body)
        away = np.hypot(*(state.position[rows, :2] - np.array(level.place)).T)
        heights = state.position[rows, 2][away <= max(params.length, float(away.min()))]
        ends.append((heights.max(), heights.min()))
    highest, lowest = np.array(ends).T
    return {"levels.highest": highest, "levels.lowest": lowest}
