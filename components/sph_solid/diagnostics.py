"""Totals over all particles, and the report of a failed step."""

import numpy as np

from quintet.components.shared.finite_items import require_finite_items
from quintet.components.sph_solid.params import SphSolidParams
from quintet.components.sph_solid.ranks.method import Ranks
from quintet.components.sph_solid.state import Array, State, Whole
from quintet.interfaces.component import Totals
from quintet.interfaces.errors import StepError
from quintet.interfaces.params import Vector


def totals(state: State, mass: Array, carried: Whole, gravity: Vector, ranks: Ranks) -> Totals:
    """Mass, momentum and energies of all ranks; a mesh carries mass and motion of glued particles.

    Parameters
    ----------
    state
    mass : (n,) float array, kg
    carried : (k,) int array
        Rows of glued particles.
    gravity : Vector, m/s2
    ranks : Ranks
    """
    free = mass.copy()
    free[carried] = 0.0
    x, y, z = state.position.T
    u, v, w = (free[:, None] * state.velocity).T
    kinetic = u * state.velocity[:, 0] + v * state.velocity[:, 1] + w * state.velocity[:, 2]
    fallen = x * gravity[0] + y * gravity[1] + z * gravity[2]
    turning = (y * w - z * v, z * u - x * w, x * v - y * u)
    columns = [free, u, v, w, *turning, kinetic, free * fallen, mass * state.energy]
    sums = ranks.sums(state, columns)
    return Totals(
        mass=float(sums[0]),
        momentum=sums[1:4],
        angular_momentum=sums[4:7],
        kinetic=0.5 * float(sums[7]),
        potential=-float(sums[8]),
        internal=float(sums[9]),
        dissipated=0.0,  # viscosity and plastic work heat the particles
    )


def failure(state: State, params: SphSolidParams, dt: float, ranks: Ranks) -> StepError:
    """Say which particle of all ranks a step [s] failed on, and what to do; rank 0 alone knows."""
    whole = ranks.whole(state)
    row, speed = (0, 0.0) if ranks.rank else _worst(whole)
    owner = ranks.owner(state, 0 if ranks.rank else int(whole.identity[row]))
    if ranks.rank:
        return StepError("a particle failed; rank 0 names it.")
    x, y, z = whole.position[row]
    text = (
        f"step of {dt:.3g} s at {state.time:.4g} s: in a step particles must stay finite and move "
        f"by little more than a smoothing length, {params.length:.3g} m; particle "
        f"{whole.identity[row]}{owner} of body {whole.body[row]}, at ({x:.4g}, {y:.4g}, {z:.4g}) "
        f"m, has {speed:.4g} m/s, a density of {whole.density_ratio[row]:.4g} of that at rest and "
        f"{whole.pressure[row]:.3g} Pa. Lower courant (now {params.courant}), raise the "
        "viscosities, or look for bodies that overlap at the start."
    )
    return StepError(text, (x, y, z))


def check(state: State, params: SphSolidParams) -> None:
    """Refuse numbers that are not finite and that the next step need not notice."""
    fields = {
        "specific energy": state.energy,
        "plastic strain": state.strain,
        "temperature": state.temperature,
        "damage": state.damage,
    }
    advice = f"Lower courant (now {params.courant}), or check the constants of its material."
    require_finite_items("particle", fields, state.identity, state.position, advice)


def _worst(state: State) -> tuple[int, float]:
    """Row of the first particle at no place, or else of the fastest; its speed [m/s].

    In one step neighbours of a particle that is at no place get no velocity, but have a place.
    """
    placed = np.isfinite(state.position).all(axis=1)
    finite = placed & np.isfinite(state.velocity).all(axis=1)
    finite &= np.isfinite(state.acceleration).all(axis=1)
    speed = np.where(finite, np.abs(state.velocity).max(axis=1), np.inf)  # squares may overflow
    row = int(np.argmax(speed) if placed.all() else np.argmin(placed))
    return row, float(speed[row])
