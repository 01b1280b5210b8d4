"""Readings of bodies, gauges and levels, as their ports give them."""

import numpy as np

from quintet.components.sph_solid.params import SphSolidParams
from quintet.components.sph_solid.ranks.method import Ranks
from quintet.components.sph_solid.state import Array, State
from quintet.components.sph_solid.view import von_mises
from quintet.interfaces.component import Fields


def bodies(state: State, mass: Array, params: SphSolidParams, ranks: Ranks) -> Fields:
    """Motion, energies and extent of each body of all ranks, in the fields of the port `bodies`."""
    sums, extents = [], []
    for number in range(len(params.bodies)):
        rows = np.flatnonzero(state.body == number)
        masses, velocity = mass[rows], state.velocity[rows]
        position = state.position[rows]
        squares = velocity * velocity
        columns = [masses, *(masses * column for column in (*position.T, *velocity.T))]
        columns += [masses * (squares[:, 0] + squares[:, 1] + squares[:, 2])]
        columns += [masses * state.energy[rows], masses * state.failed[rows]]
        sums.append(ranks.sums(state, columns))
        low = position.min(axis=0, initial=np.inf)
        high = position.max(axis=0, initial=-np.inf)
        extents.append(ranks.greatest(np.concatenate([-low, high])))
    of_bodies, extent = np.array(sums), np.array(extents)
    whole, half = of_bodies[:, 0], 0.5 * params.spacing
    return {
        "bodies.position": of_bodies[:, 1:4] / whole[:, None],
        "bodies.velocity": of_bodies[:, 4:7] / whole[:, None],
        "bodies.kinetic": 0.5 * of_bodies[:, 7],
        "bodies.internal": of_bodies[:, 8].copy(),
        "bodies.failed": of_bodies[:, 9] / whole,
        "bodies.lowest": -extent[:, :3] - half,
        "bodies.highest": extent[:, 3:] + half,
    }


def gauges(state: State, density: Array) -> Fields:
    """Motion and stress of some particles, in the fields of the port `gauges`."""
    deviator, pressure = state.deviator, state.pressure
    return {
        "gauges.position": state.position,
        "gauges.velocity": state.velocity,
        "gauges.stress": deviator[:, :3] - pressure[:, None],
        "gauges.pressure": pressure,
        "gauges.von_mises": von_mises(deviator),
        "gauges.density": density[state.material] * state.density_ratio,
        "gauges.plastic_strain": state.strain,
        "gauges.failed": state.failed,
        "gauges.temperature": state.temperature,
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
