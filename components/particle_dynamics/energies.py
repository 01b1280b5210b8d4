"""Energies of a lattice, heat of its baths, their means over time, and the audit of the energy."""

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from quintet.components.particle_dynamics.averages import BlockMeans
from quintet.components.particle_dynamics.params import ParticleLatticeParams
from quintet.components.particle_dynamics.ranks.one import OneRank
from quintet.components.particle_dynamics.state import TIME, WORK, Bathed, Whole
from quintet.interfaces.component import Array

if TYPE_CHECKING:
    from quintet.components.particle_dynamics.opencl.device_rows import DeviceRows
    from quintet.components.particle_dynamics.ranks.several import SeveralRanks

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


class EnergyBudget:
    """Energies of a lattice as it is stepped, what was put in, and their means over time.

    Parameters
    ----------
    params : ParticleLatticeParams
    rows : OneRank, SeveralRanks or DeviceRows
        The points, at the start.
    bathed : Bathed
        All points in baths.
    frequency : float, rad/s
        Of the fastest vibration.
    free : int
        Points that are not frozen.
    """

    def __init__(
        self,
        params: ParticleLatticeParams,
        rows: "OneRank | SeveralRanks | DeviceRows",
        bathed: Bathed,
        frequency: float,
        free: int,
    ) -> None:
        self._rows, self._bathed, self._baths = rows, bathed, len(params.baths)
        self._lattice, self._begin = params.lattice, params.averages.begin
        self._per_kelvin = 1.5 * params.boltzmann  # J/K
        self._free = max(free, 1)
        speed = params.lattice.spacing * frequency
        self._unit = params.lattice.mass * speed * speed  # J
        self.means = BlockMeans(1 + self._baths, self._begin, params.averages.block)
        self.initial = sum(self.energies())  # J
        self.means.add(0.0, self.integrals())

    def begin_averages(self, time: float) -> None:
        """Let all means begin again from a time [s] on."""
        self._begin = self.means.begin = time
        self.means.sums[:] = 0.0

    def _time(self) -> float:
        return float(self._rows.state.energies[TIME])

    def energies(self) -> Energies:
        """Energies of the present state."""
        velocity, rows = self._rows.all("velocity"), self._rows
        pairs, tethers = rows.pair_energies(), rows.tether_energies()  # the latter twice theirs
        kinetic = 0.5 * self._lattice.mass * float((velocity**2).sum())
        return Energies(kinetic, float(pairs.sum() + 0.5 * tethers.sum()))

    def balance(self) -> Balance:
        """What was put in since the start."""
        dissipated = float(self._rows.all("dissipated").sum())
        work = float(self._rows.all("energies")[WORK])
        return Balance(work, self._rows.all("heat"), dissipated)

    def outer_work(self, wall: Whole) -> float:
        """Energy [J] of drive, damping and baths so far, except a wall that a partner heats."""
        balance = self.balance()
        heat = float(balance.heat.sum() - balance.heat[wall].sum())
        return balance.work - balance.dissipated + heat

    def audit(self, now: Energies) -> float:
        """Energy missing in the balance, over what was put in since the start."""
        balance = self.balance()
        put_in = float(balance.work + balance.heat.sum())
        gained = now.kinetic + now.potential - self.initial + balance.dissipated
        size = abs(balance.work) + float(np.abs(self._heat_of_baths(balance.heat)).sum())
        least = AUDITED * self._lattice.count * self._unit
        return (gained - put_in) / max(size, now.kinetic, least)

    def _heat_of_baths(self, heat: Array) -> Array:
        """Heat [J] from each bath, of heat (b,) J to bathed points."""
        return np.bincount(self._bathed.bath, heat, self._baths).astype(np.float64)[: self._baths]

    def integrals(self) -> Array:
        """Temperature [K s] of points that are not frozen, and heat of each bath [J]."""
        kinetic = self._rows.all("kinetic").sum()
        temperature = kinetic / (self._per_kelvin * self._free)
        return np.concatenate([[temperature], self._heat_of_baths(self._rows.all("heat"))])

    def note(self) -> None:
        """Take the integrals, if a block of the means begins or ends now."""
        if self.means.needs(self._time()):
            self.means.add(self._time(), self.integrals())

    def hotness(self) -> tuple[Array, Array]:
        """Mean kinetic energy (n,) J, and its ratio to that of the hottest point.

        The ratio is 0 if the hottest point has only rounding.
        """
        kinetic, since = self._rows.all("kinetic"), self._time() - self._begin
        mean = kinetic / since if since > 0.0 else np.zeros(len(kinetic))
        highest = mean.max()
        return mean, mean / highest if highest > ROUNDING * self._unit else np.zeros(len(mean))

    def temperature(self, mean: Array) -> Array:
        """Temperature [K] of mean kinetic energies [J]."""
        return mean / self._per_kelvin

    def summary(self) -> dict[str, Array]:
        """Outputs of the port `energies`."""
        kinetic, potential = now = self.energies()
        balance = self.balance()
        numbers = {
            "kinetic": kinetic,
            "potential": potential,
            "dissipated": balance.dissipated,
            "work": balance.work,
            "heat": balance.heat.sum(),
            "audit": self.audit(now),
            "intact": self._rows.intact(),
            "temperature": self.means.means(self._time(), self.integrals())[0],
            "temperature_error": self.means.errors()[0],
        }
        return {f"energies.{name}": np.array([number]) for name, number in numbers.items()}

    def of_baths(self) -> dict[str, Array]:
        """Outputs of the port `baths`."""
        in_baths, mean = self._bathed, self.hotness()[0]
        energy = np.bincount(in_baths.bath, mean[in_baths.point], self._baths)
        return {
            "baths.temperature": energy / np.bincount(in_baths.bath) / self._per_kelvin,
            "baths.heat_flow": self.means.means(self._time(), self.integrals())[1:],
            "baths.heat_flow_error": self.means.errors()[1:],
        }
