"""What is found by looking over all particles: totals, bodies, gauges, pictures, failures."""

import numpy as np

from quintet.components.sph_solid.params import SphSolidParams
from quintet.components.sph_solid.state import Array, State, Whole
from quintet.interfaces.component import Fields, Totals
from quintet.interfaces.params import Vector


def von_mises(deviator: Array) -> Array:
    """Equivalent stress (n,) Pa of deviators (n, 6) Pa."""
    xx, yy, zz, xy, yz, zx = deviator.T
    squares = 1.5 * (xx * xx + yy * yy + zz * zz) + 3.0 * (xy * xy + yz * yz + zx * zx)
    return np.asarray(np.sqrt(squares))


def totals(state: State, mass: Array, carried: Whole, gravity: Vector) -> Totals:
    """Mass, momentum and energies; not of motion of glued particles, which a mesh carries.

    Parameters
    ----------
    state
    mass : (n,) float array, kg
    carried : (k,) int array
        Rows of glued particles.
    gravity : Vector, m/s2
    """
    own = mass.copy()
    own[carried] = 0.0
    momentum = own[:, None] * state.velocity
    return Totals(
        mass=float(own.sum()),
        momentum=momentum.sum(axis=0),
        angular_momentum=np.cross(state.position, momentum).sum(axis=0),
        kinetic=0.5 * float((momentum * state.velocity).sum()),
        potential=-float(own @ (state.position @ np.array(gravity))),
        internal=float((mass * state.energy).sum()),
    )


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
        mine = np.flatnonzero((state.body == level.body) & (state.failed == 0.0))
        if not len(mine):
            mine = np.flatnonzero(state.body == level.body)
        away = np.hypot(*(state.position[mine, :2] - np.array(level.place)).T)
        heights = state.position[mine, 2][away <= max(params.length, float(away.min()))]
        ends.append((heights.max(), heights.min()))
    highest, lowest = np.array(ends).T
    return {"levels.highest": highest, "levels.lowest": lowest}


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
