"""The ledger: what crossed each link, as sent, received, mapped and applied.

Four sums must agree in every window: of the impulses as the giver made them, as they arrived,
after the mapping, and as the taker applied them in its steps. Work is counted on both sides
from what each did itself; it agrees as well as the staggering in time lets it.
"""

import csv
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from quintet.coupler.exchange import Carried, Exchange, Leg
from quintet.interfaces.component import Array, Fields
from quintet.interfaces.outputs import column_sums, size


@dataclass(slots=True)
class Account:
    """What one link did so far."""

    link: str
    momentum_residual: float = 0.0  # worst window, relative to the sum of its forces' sizes
    angular_residual: float = 0.0  # worst window, relative likewise (with the lever arm)
    impulse: Array = field(default_factory=lambda: np.zeros(1))  # N s, on the taker
    work_given: float = 0.0  # J, as the side that gives the force counts it
    work_taken: float = 0.0  # J, as the side that moves counts it
    turnover: float = 0.0  # J, sum of the magnitudes of the work of every window

    @property
    def energy_residual(self) -> float:
        """Difference of the two sides' work, relative to the work that went through."""
        return abs(self.work_given - self.work_taken) / self.turnover if self.turnover else 0.0


class Ledger:
    """Keeps an account for every link; a window is booked when all its components answered."""

    def __init__(self, exchange: Exchange, path: Path | None = None) -> None:
        self.exchange = exchange
        self.accounts = {link.name: Account(link.name) for link in exchange.links}
        self.totals: dict[str, dict[str, Any]] = {}
        self.energy: list[float] = []  # J, sum over the components, at every note
        self._file = open(path, "w", newline="") if path else None
        self._rows = csv.writer(self._file) if self._file else None
        if self._rows:
            self._rows.writerow(
                ["time", "name", "momentum_residual", "angular_residual", "impulse_x", "impulse_y"]
                + ["impulse_z", "work_given", "work_taken", "mass", "momentum_x", "momentum_y"]
                + ["momentum_z", "kinetic", "potential", "internal"]
            )

    @property
    def worst(self) -> float:
        """Largest momentum residual of any link so far."""
        return max((account.momentum_residual for account in self.accounts.values()), default=0.0)

    def given(self, name: str, header: Mapping[str, Any], fields: Fields) -> None:
        """Book what a component gave: its own sums against those of what arrived."""
        sent = header["sent"]
        for link in self.exchange.links:
            account = self.accounts[link.name]
            for leg in link.legs:
                for key, _ in leg.forces if leg.giver == name else ():
                    scale = sent.get(f"{key}/size", [0.0])[0]
                    gap = np.subtract(column_sums(fields[key]), sent.get(key, 0.0))
                    self._note(account, gap, scale)
            for key, *_ in link.works.get(name, []):
                work = sent.get(f"{key}/work", [0.0])[0]
                account.work_given += work
                account.turnover += abs(work)

    def mapped(self, carried: Carried) -> None:
        """Book a mapping: sums of forces and of moments before against after."""
        for leg, brought in carried.legs:
            account = self._account(leg)
            for before, after in leg.forces:
                array = carried.outputs[leg.giver][before]
                total = np.asarray(column_sums(brought[after]))
                account.impulse = account.impulse + total
                if self._alone(leg):
                    self._note(account, total - column_sums(array), size(array))
                    moment = carried.sent.get(leg.giver, {}).get(f"{before}/moment")
                    self._turned(account, leg, brought, moment)

    def _turned(self, account: Account, leg: Leg, brought: Fields, moment: Any) -> None:
        if leg.moment is None or moment is None:
            return
        turned = leg.moment(brought)
        reach = max(float(np.abs(moment).max()), float(np.abs(turned).max()))
        if reach:
            gap = float(np.abs(turned - moment).max()) / reach
            account.angular_residual = max(account.angular_residual, gap)

    def applied(self, name: str, fields: Fields, header: Mapping[str, Any]) -> None:
        """Book what a component was sent against what it received and applied."""
        for link in self.exchange.links:
            for leg in link.legs:
                for _, key in leg.forces if leg.taker == name else ():
                    scale, total = size(fields[key]), column_sums(fields[key])
                    for seen in (header["received"].get(key, 0.0), header["applied"].get(key, 0.0)):
                        self._note(self.accounts[link.name], np.subtract(total, seen), scale)

    def worked(self, name: str, fields: Fields, before: Fields, after: Fields, dt: float) -> None:
        """Book the work of the impulses that a component took, by its own motion."""
        for link in self.exchange.links:
            for leg in link.legs:
                for key, rate, place in leg.works_on if leg.taker == name else ():
                    mean = mean_rate(before, after, rate, place, dt)
                    work = float(np.vdot(fields[key], mean))
                    self.accounts[link.name].work_taken += work

    def _alone(self, leg: Leg) -> bool:
        """Whether a leg brings all that its giver gave; shared ports are split by rows."""
        legs = [one for link in self.exchange.links for one in link.legs if one.forces]
        return sum(one.giver == leg.giver for one in legs) == 1

    def _account(self, leg: Leg) -> Account:
        owner = next(link for link in self.exchange.links if leg in link.legs)
        return self.accounts[owner.name]

    def _note(self, account: Account, gap: Any, scale: float) -> None:
        worst = float(np.abs(gap).max()) if np.size(gap) else 0.0
        if worst:
            relative = worst / scale if scale else float("inf")
            account.momentum_residual = max(account.momentum_residual, relative)

    def note(self, time: float, totals: Mapping[str, dict[str, Any]]) -> None:
        """Write a row for every link and component, at a time [s]."""
        self.totals.update(totals)
        kinds = ("kinetic", "potential", "internal")
        self.energy.append(sum(one[kind] for one in self.totals.values() for kind in kinds))
        if not self._rows or not self._file:
            return
        for account in self.accounts.values():
            self._rows.writerow(
                [time, account.link, account.momentum_residual, account.angular_residual]
                + [*account.impulse, account.work_given, account.work_taken]
            )
        for name, one in totals.items():
            held = [one["mass"], *one["momentum"], *(one[kind] for kind in kinds)]
            self._rows.writerow([time, name, *[""] * 7, *held])
        self._file.flush()

    def summary(self) -> dict[str, Any]:
        """What ``results.json`` says of it."""
        links = []
        for account in self.accounts.values():
            row = {**asdict(account), "energy_residual": account.energy_residual}
            row["impulse"] = [float(p) for p in account.impulse]
            links.append(row)
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


def mean_rate(before: Fields, after: Fields, rate: str, place: str, dt: float) -> Array:
    """Mean of a rate over a window: from the displacement where it is known, else of the ends."""
    if place == "integral":
        return after[rate] / dt
    if place:
        return (after[place] - before[place]) / dt
    return 0.5 * (before[rate] + after[rate])
