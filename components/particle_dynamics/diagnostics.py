"""Energies of a lattice and their audit, hotness, and what indicates that the lattice breaks up."""

from typing import NamedTuple

import numpy as np

from quintet.components.particle_dynamics.build import CLOSE, place_at_start
from quintet.components.particle_dynamics.params import Drive, Lattice
from quintet.components.particle_dynamics.state import Whole
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


class Balance(NamedTuple):
    """What was put into a lattice since the start."""

    work: float  # J, of the drive
    heat: Array  # (b,) J, from the bath to each bathed point
    dissipated: float  # J


def energies(mass: float, velocity: Array, pairs: Array, tethers: Array) -> Energies:
    """Sum the energies of points, of the pairs of each, and of tethers (twice their energies)."""
    kinetic = 0.5 * mass * float((velocity**2).sum())
    return Energies(kinetic, float(pairs.sum() + 0.5 * tethers.sum()))


def heat_of_baths(heat: Array, bath: Whole, count: int) -> Array:
    """Heat (count,) J from each bath, of heat (b,) J to points and the baths (b,) of these."""
    return np.bincount(bath, heat, count).astype(np.float64)[:count]


def audit(now: Energies, initial: float, balance: Balance, baths: Array, least: float) -> float:
    """Energy missing in the balance, over what was put in since the start.

    Parameters
    ----------
    now : Energies
    initial : float, J
        Their sum at the start.
    balance : Balance
    baths : (any,) float array, J
        Heat of each bath.
    least : float, J
        Energy that is small for the lattice.
    """
    put_in = float(balance.work + balance.heat.sum())
    gained = now.kinetic + now.potential - initial + balance.dissipated
    size = abs(balance.work) + float(np.abs(baths).sum())
    return (gained - put_in) / max(size, now.kinetic, least)


def outer_work(balance: Balance, wall: Whole) -> float:
    """Energy [J] of drive, damping and baths so far, except a wall that a partner heats."""
    heat = float(balance.heat.sum() - balance.heat[wall].sum())
    return balance.work - balance.dissipated + heat


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

    def check(self, time: float, near: int, point: int, intact: float) -> None:
        """Note the times [s] of the first lost point and of broken bonds.

        Parameters
        ----------
        time : float, s
        near, point : int
            Fewest points that a point has within the cut-off, and that point.
        intact : float
            Share of the bonds that are neither short nor long.
        """
        self.unchecked = 0
        if self.times[0] < 0.0 and near == 0:
            self.times[0], self.times[3] = time, point
        if self.times[1] < 0.0 and intact < INTACT:
            self.times[1] = time

    def check_energy(self, missing: float, time: float) -> None:
        """Note the first time [s] of a share of energy that is missing."""
        if self.times[2] < 0.0 and abs(missing) > MISSING:
            self.times[2] = time

    @property
    def broken(self) -> bool:
        """Whether a point was lost or bonds were broken."""
        return bool((self.times[:2] >= 0.0).any())

    def warnings(self, lattice: Lattice) -> dict[str, str]:
        """Warn of each; points are named by their positions at the start."""
        lost, broken, missing, point = self.times.tolist()
        sentences = {}
        if lost >= 0.0:
            sentences["lost point"] = (
                f"{_named(int(point), lattice)}, has left all others behind, at {lost:g} s: drive "
                "or heat less, or damp more."
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


def _named(point: int, lattice: Lattice) -> str:
    return f"point {point}, at {place_at_start(lattice, point)} m at the start"


def failure(point: int, lattice: Lattice, time: float, skin: float, dt: float) -> StepError:
    """Name the point that moved furthest in a step dt [s] that neighbour lists do not allow."""
    return StepError(
        f"{_named(point, lattice)}: it must move by less than {0.2 * skin:.3g} m in a step of "
        f"{dt:.3g} s, and did not, at {time:g} s. Take a smaller courant, or drive and heat less."
    )
