"""The ledger: what crossed each link, as sent, received, mapped and applied.

Four sums must agree in every window: of the impulses as the giver made them, as they arrived,
after the mapping, and as the taker applied them in its steps. Over the whole run all that was
given is applied once, but for what is on its way. Motion is handed out in each step as it was
sent. Work is counted on both sides from what each did itself; it agrees as well as the
staggering in time lets it.
"""

import csv
import os
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from quintet.coupler.coupling.exchange import Brought, Carried, Exchange
from quintet.coupler.coupling.motion_audit import Motion
from quintet.coupler.coupling.run_balance import Balance
from quintet.interfaces.component import Array, Fields
from quintet.interfaces.sums import column_sums, product, size

# The residual into which an impulse is booked, by the unit of its rate.
RESIDUALS = {
    "N": "momentum_residual",
    "N m": "angular_residual",
    "W": "heat_residual",
    "m/s": "kinematic_residual",
}

COLUMNS = (
    "time name momentum_residual angular_residual impulse_x impulse_y impulse_z work_given "
    "work_taken mass momentum_x momentum_y momentum_z kinetic potential internal"
).split()


@dataclass(slots=True)
class Account:
    """What one link did so far."""

    link: str
    momentum_residual: float = 0.0  # worst window, relative to the sum of its forces' sizes
    angular_residual: float = 0.0  # worst window, relative likewise (with the lever arm)
    heat_residual: float = 0.0  # worst window, relative likewise
    kinematic_residual: float = 0.0  # worst window, of motion handed out, relative to its size
    impulse: Array = field(default_factory=lambda: np.zeros(3))  # N s, on the taker
    work_given: float = 0.0  # J, as the side that gives the force counts it
    work_taken: float = 0.0  # J, as the side that moves counts it
    turnover: float = 0.0  # J, sum of the magnitudes of the work of every window

    @property
    def energy_residual(self) -> float:
        """Difference of the two sides' work, relative to the work that went through."""
        return abs(self.work_given - self.work_taken) / self.turnover if self.turnover else 0.0

    def note(self, unit: str, gap: Any, scale: float) -> None:
        """Book the difference of two sums that should be the same."""
        worst = float(np.abs(gap).max()) if np.size(gap) else 0.0
        if worst:
            name = RESIDUALS[unit]
            relative = worst / scale if scale else float("inf")
            setattr(self, name, max(getattr(self, name), relative))


class Ledger:
    """Keeps an account for every link; a window is booked when all its components answered."""

    def __init__(self, exchange: Exchange, path: Path | None = None, size: int = 0) -> None:
        """Begin the file, or go on with the first `size` bytes of it."""
        self.exchange = exchange
        self.accounts = {link.name: Account(link.name) for link in exchange.links}
        self.totals: dict[str, dict[str, Any]] = {}
        self.energy: list[float] = []  # J, sum over the components, at every note
        self._balance = Balance(exchange)
        self._motion = Motion(exchange)
        self._file = open(path, "a" if size else "w", newline="") if path else None
        self._rows = csv.writer(self._file) if self._file else None
        if self._file and size:
            self._file.truncate(size)
            self._file.seek(0, os.SEEK_END)
        elif self._rows:
            self._rows.writerow(COLUMNS)

    @property
    def worst(self) -> float:
        """Largest momentum residual of any link so far."""
        return max((account.momentum_residual for account in self.accounts.values()), default=0.0)

    def primed(self, name: str, fields: Fields) -> None:
        """Book the motion that a component was told before the first window."""
        self._motion.arrive(name, fields, (), 0.0)

    def given(
        self, name: str, header: Mapping[str, Any], fields: Fields, outputs: Mapping[str, Fields]
    ) -> None:
        """Book what a component gave: its own sums against those of what arrived."""
        sent = header["sent"]
        for link in self.exchange.links:
            account = self.accounts[link.name]
            for leg in link.legs:
                for key, after in leg.sums if leg.giver == name else ():
                    scale = sent.get(f"{key}/size", [0.0])[0]
                    gap = np.subtract(column_sums(fields[key]), sent.get(key, 0.0))
                    account.note(self.exchange.unit(leg.taker, after), gap, scale)
            for key, *_ in link.works.get(name, []):
                work = sent.get(f"{key}/work", [0.0])[0]
                account.work_given += work
                if any(leg.works_on for leg in link.legs):  # else the other side counts none
                    account.turnover += abs(work)
        self._balance.given(name, {**outputs, name: fields})

    def mapped(self, carried: Carried) -> None:
        """Book a mapping: sums of forces and of moments before against after."""
        for brought in carried.legs:
            leg, account = brought.leg, self._account(brought)
            for before, after in leg.sums:
                array, unit = brought.before[before], self.exchange.unit(leg.taker, after)
                total = np.asarray(column_sums(brought.after[after]))
                if unit == "N":
                    account.impulse[: len(total)] += total
                account.note(unit, total - column_sums(array), size(array))
                if brought.moment is not None and self._alone(brought):
                    sent = carried.sent.get(leg.giver, {}).get(f"{before}/moment")
                    if sent is not None:
                        reach = max(np.abs(sent).max(), np.abs(brought.moment).max())
                        account.note("N m", brought.moment - sent, float(reach))

    def applied(self, name: str, fields: Fields, header: Mapping[str, Any]) -> None:
        """Book the impulses that a component was sent against what it received and applied."""
        self._balance.applied(name, header["applied"])
        for account, keys in self._impulses(name):
            for key in keys & fields.keys():
                scale, total = size(fields[key]), column_sums(fields[key])
                for seen in (header["received"].get(key, 0.0), header["applied"].get(key, 0.0)):
                    account.note(self.exchange.unit(name, key), np.subtract(total, seen), scale)

    def _impulses(self, name: str) -> list[tuple[Account, set[str]]]:
        """For each link, the impulses that it brings to a component's ports."""
        impulses = {
            f"{port.name}.{one.name}"
            for port in self.exchange.ports[name][0]
            for one in port.fields
            if one.centring == "impulse"
        }
        takers = [
            link for link in self.exchange.links if any(leg.taker == name for leg in link.legs)
        ]
        return [(self.accounts[link.name], impulses) for link in takers]

    def moved(self, name: str, carried: Carried, handed: Mapping[str, Any], dt: float) -> None:
        """Book the motion that a component was given in its steps against what it was sent."""
        self._motion.arrive(name, carried.fields, carried.ends, dt)
        worst = self._motion.residual(name, handed)
        for brought in carried.legs:
            self._account(brought).note("m/s", worst, 1.0)

    def settle(
        self, is_late: Callable[[str, str], bool], owed: Mapping[tuple[str, str], Array]
    ) -> None:
        """Book, at a window's end, all that was ever given against all that was ever applied."""
        for taker, key, links, gap, scale in self._balance.gaps(is_late, owed):
            for number in links:
                account = self.accounts[self.exchange.links[number].name]
                account.note(self.exchange.unit(taker, key), gap, scale)

    def worked(self, name: str, fields: Fields, before: Fields, after: Fields, dt: float) -> None:
        """Book the work of the impulses that a component took, by its own motion."""
        for link in self.exchange.links:
            for leg in link.legs:
                for key, rate, place in leg.works_on if leg.taker == name else ():
                    mean = mean_rate(before, after, rate, place, dt)
                    work = product(fields[key], mean)
                    self.accounts[link.name].work_taken += work

    def _alone(self, brought: Brought) -> bool:
        """Whether a leg brings all that its giver gave; shared ports are split by rows."""
        legs = [one for link in self.exchange.links for one in link.legs if one.sums]
        return sum(one.giver == brought.leg.giver for one in legs) == 1

    def _account(self, brought: Brought) -> Account:
        return self.accounts[self.exchange.links[brought.number].name]

    def note(self, time: float, totals: Mapping[str, dict[str, Any]]) -> None:
        """Write a row for every link and component, at a time [s]."""
        self.totals.update(totals)
        kinds = ("kinetic", "potential", "internal")
        self.energy.append(sum(one[kind] for one in self.totals.values() for kind in kinds))
        if not self._rows or not self._file:
            return
        for account in self.accounts.values():
            residuals = [account.momentum_residual, account.angular_residual]
            work = [account.work_given, account.work_taken]
            self._rows.writerow([time, account.link, *residuals, *account.impulse, *work])
        for name, one in totals.items():
            held = [one["mass"], *one["momentum"], *(one[kind] for kind in kinds)]
            self._rows.writerow([time, name, *[""] * 7, *held])
        self._file.flush()

    def save(self) -> dict[str, Any]:
        """All that is in the books, for a snapshot, and the length of the file [bytes]."""
        if self._file:
            self._file.flush()
        return {
            "accounts": [_as_row(account) for account in self.accounts.values()],
            "totals": self.totals,
            "energy": self.energy,
            "balance": self._balance.save(),
            "motion": self._motion.save(),
            "size": self._file.tell() if self._file else 0,
        }

    def load(self, state: Mapping[str, Any]) -> None:
        """Come back to saved books."""
        for row in state["accounts"]:
            self.accounts[row["link"]] = Account(**{**row, "impulse": np.array(row["impulse"])})
        self.totals, self.energy = dict(state["totals"]), list(state["energy"])
        self._balance.load(state["balance"])
        self._motion.load(state["motion"])

    def summary(self) -> dict[str, Any]:
        """What ``results.json`` says of it."""
        links = [
            {**_as_row(one), "energy_residual": one.energy_residual}
            for one in self.accounts.values()
        ]
        return {"links": links, "energy_drift": self._drift()}

    def _drift(self) -> float:
        """Largest rise of the energy above its start, relative to all that was ever released."""
        if len(self.energy) < 2:
            return 0.0
        energy = np.asarray(self.energy)
        released = float(energy.max() - energy.min())
        return float(energy.max() - energy[0]) / released if released else 0.0

    def close(self) -> None:
        """Close the file."""
        if self._file:
            self._file.close()


def _as_row(account: Account) -> dict[str, Any]:
    return {**asdict(account), "impulse": [float(p) for p in account.impulse]}


def mean_rate(before: Fields, after: Fields, rate: str, place: str, dt: float) -> Array:
    """Mean of a rate over a window: from the displacement where it is known, else of the ends."""
    if place == "integral":
        return after[rate] / dt
    if place:
        return (after[place] - before[place]) / dt
    return 0.5 * (before[rate] + after[rate])
