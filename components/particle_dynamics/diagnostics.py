"""Energies of a lattice and their audit, hotness, and what indicates that the lattice breaks up."""

import math
from typing import NamedTuple

import numpy as np

from quintet.components.particle_dynamics.build import CLOSE, Built
from quintet.components.particle_dynamics.kernels.forces import (
    Pairs,
    count_intact,
    count_near,
    sum_energies,
)
from quintet.components.particle_dynamics.params import Drive, Lattice
from quintet.components.particle_dynamics.state import DISSIPATED, TIME, WORK, Model, State, Whole
from quintet.interfaces.component import Array
from quintet.interfaces.errors import StepError

CHECKED = 20  # steps between two checks for lost points
INTACT = 0.95  # share of the bonds below which the lattice is broken
MISSING = 0.01  # of the energy put in, above which the audit warns
# Of m a² ω², for each point: energies that are rounding, and the least that is audited.
ROUNDING, AUDITED = 1e-20, 1e-9


class Energies(NamedTuple):
    """Energies of a lattice."""

    kinetic: float  # J
    potential: float  # J, of pairs and tethers


def energies(state: State, pairs: Pairs, built: Built, model: Model) -> Energies:
    """Sum the energies of points, pairs and tethers."""
    bathed = model.bathed
    kinetic = 0.5 * model.mass * float((state.velocity**2).sum())
    away = ((state.position[bathed.point] - bathed.rest) ** 2).sum(axis=1)
    potential = sum_energies(state.position, pairs, built.law, built.period)
    return Energies(kinetic, float(potential + 0.5 * (bathed.tether * away).sum()))


def heat_of_baths(state: State, bath: Whole, count: int) -> Array:
    """Heat (count,) J from each bath, of the baths (b,) of points."""
    return np.bincount(bath, state.heat, count).astype(np.float64)[:count]


def audit(now: Energies, initial: float, state: State, baths: Array, unit: float) -> float:
    """Energy missing in the balance, over what was put in since the start.

    Parameters
    ----------
    now : Energies
    initial : float, J
        Their sum at the start.
    state : State
    baths : (any,) float array, J
        Heat of each bath.
    unit : float, J
        m a² ω².
    """
    work = float(state.energies[WORK])
    put_in = float(state.energies[WORK] + state.heat.sum())
    gained = now.kinetic + now.potential - initial + float(state.energies[DISSIPATED])
    size = abs(work) + float(np.abs(baths).sum())
    return (gained - put_in) / max(size, now.kinetic, AUDITED * len(state.position) * unit)


def outer_work(state: State, wall: Whole) -> float:
    """Energy [J] of drive, damping and baths so far, except a wall that a partner heats."""
    heat = float(state.heat.sum() - state.heat[wall].sum())
    return float(state.energies[WORK] - state.energies[DISSIPATED]) + heat


def intact(position: Array, bonds: Whole, spacing: float, period: Array | None) -> float:
    """Share of the bonds between nearest points that have 0.8 to 1.2 spacings [m]."""
    return float(count_intact(position, bonds, spacing, period) / max(len(bonds), 1))


def hotness(kinetic: Array, since: float, least: float) -> tuple[Array, Array]:
    """Mean kinetic energy (n,) J, and its ratio to that of the hottest point.

    The ratio is 0 if the hottest point has at most a least energy [J], which is rounding.

    Parameters
    ----------
    kinetic : (n,) float array, J s
        Integrals over time.
    since : float, s
        Their duration.
    least : float, J
    """
    mean = kinetic / since if since > 0.0 else np.zeros(len(kinetic))
    highest = mean.max()
    return mean, mean / highest if highest > least else np.zeros(len(mean))


class Losses:
    """Points that left all others, broken bonds and missing energy, each with its first time."""

    def __init__(self) -> None:
        self.unchecked = 0  # steps since the last check
        # Times [s] of a lost point, of broken bonds, of missing energy; the point. -1: none.
        self.times = np.full(4, -1.0)

    def check(self, state: State, pairs: Pairs, built: Built, spacing: float) -> None:
        """Note the times of the first lost point and of broken bonds."""
        self.unchecked = 0
        time, near = float(state.energies[TIME]), np.empty(len(state.position), np.int64)
        count_near(state.position, pairs, built.law.cutoff2, built.period, near)
        if self.times[0] < 0.0 and (near == 0).any():
            self.times[0], self.times[3] = time, int(np.argmin(near))
        if self.times[1] < 0.0 and (
            intact(state.position, built.bonds, spacing, built.period) < INTACT
        ):
            self.times[1] = time

    def check_energy(self, missing: float, time: float) -> None:
        """Note the first time [s] of a share of energy that is missing."""
        if self.times[2] < 0.0 and abs(missing) > MISSING:
            self.times[2] = time

    @property
    def broken(self) -> bool:
        """Whether a point was lost or bonds were broken."""
        return bool((self.times[:2] >= 0.0).any())

    def warnings(self, start: Array) -> dict[str, str]:
        """Warn of each; points are named by their positions (n, 3) m at the start."""
        lost, broken, missing, point = self.times.tolist()
        sentences = {}
        if lost >= 0.0:
            sentences["lost point"] = (
                f"point {int(point)}, at {start[int(point)]} m at the start, has left all others "
                f"behind, at {lost:g} s: drive or heat less, or damp more."
            )
        if broken >= 0.0:
            sentences["broken bonds"] = (
                f"less than {INTACT:.0%} of the bonds between nearest points are intact, at "
                f"{broken:g} s: the lattice has broken up. Drive or heat less, or damp more."
            )
        if missing >= 0.0:
            sentences["energy"] = (
                f"the energy audit lacks more than {MISSING:.0%} of what was put in, at "
                f"{missing:g} s: take a smaller courant."
            )
        return sentences


def drive_notes(drive: Drive | None, lattice: Lattice) -> tuple[str, ...]:
    """Note a drive that is strong enough to break most lattices up."""
    if drive is None or drive.amplitude < 0.1 * lattice.spacing * CLOSE:
        return ()
    return (
        f"drive: an amplitude of {drive.amplitude / lattice.spacing:.2g} spacings breaks most "
        "lattices up; 0.05 to 0.08 do not.",
    )


def failure(state: State, start: Array, skin: float, dt: float) -> StepError:
    """Name the point that moved furthest in a step dt [s] that neighbour lists do not allow."""
    moved = ((state.position - state.listed) ** 2).sum(axis=1)
    point = int(np.argmax(np.where(np.isfinite(moved), moved, math.inf)))
    return StepError(
        f"point {point}, at {start[point]} m at the start: it must move by less "
        f"than {0.2 * skin:.3g} m in a step of {dt:.3g} s, and did not, at "
        f"{state.energies[TIME]:g} s. Take a smaller courant, or drive and heat less."
    )
