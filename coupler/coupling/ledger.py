"""The ledger: what crossed each link, as sent, received, mapped and applied.

Four sums must agree in every window: of the impulses as the giver made them, as they arrived,
after the mapping, and as the taker applied them in its steps. Over the whole run all that was
given is applied once, but for what is on its way. Motion is interpolated in each step as it was
sent. Work is counted on both sides from what each did itself; it agrees as well as the
staggering in time lets it.
"""

from collections.abc import Collection, Iterable, Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from quintet.coupler.coupling.answers import MASS_BALANCE
from quintet.coupler.coupling.energy_balance import KINDS, EnergyBalance
from quintet.coupler.coupling.exchange import Delivery, Exchange, WindowInputs
from quintet.coupler.coupling.link import Transfer
from quintet.coupler.coupling.motion_audit import MotionAudit
from quintet.coupler.coupling.pairing import INTEGRAL
from quintet.coupler.coupling.run_balance import RunBalance
from quintet.coupler.coupling.run_warnings import RunWarnings
from quintet.coupler.coupling.saved_values import attributes_like, require_same_keys
from quintet.coupler.files.table_file import TableFile
from quintet.interfaces.component import Array, Fields
from quintet.interfaces.rotation import vector_between
from quintet.interfaces.sums import column_sums, product, size

# The residual into which an impulse is booked, by the unit of its rate.
RESIDUALS = {
    "N": "momentum_residual",
    "N m": "angular_residual",
    "W": "heat_residual",
    "m/s": "kinematic_residual",
}
OTHER = "other_residual"
WORK = "work"  # of totals: what is done from outside of the run

COLUMNS = (
    "time name momentum_residual angular_residual impulse_x impulse_y impulse_z work_given "
    "work_taken heat mass momentum_x momentum_y momentum_z kinetic potential internal work "
    "link_work dissipated"
).split()


@dataclass(slots=True)
class Account:
    """What one link did so far."""

    link: str
    momentum_residual: float = 0.0  # worst window, relative to the sum of its forces' sizes
    angular_residual: float = 0.0  # worst window, relative likewise (with the lever arm)
    heat_residual: float = 0.0  # worst window, relative likewise
    kinematic_residual: float = 0.0  # worst window, of motion interpolated, relative to its size
    other_residual: float = 0.0  # worst window, of rates in other units, relative likewise
    impulse: Array = field(default_factory=lambda: np.zeros(3))  # N s, on the taker
    work_given: float = 0.0  # J, as the side that gives the force counts it
    work_taken: float = 0.0  # J, as the side that moves counts it
    heat: float = 0.0  # J, handed to the taker
    turnover: float = 0.0  # J, sum of the magnitudes of the work of every window

    @property
    def energy_residual(self) -> float:
        """Difference of the two sides' work, relative to the work that went through."""
        return abs(self.work_given - self.work_taken) / self.turnover if self.turnover else 0.0

    def note(self, unit: str, gap: Any, scale: float) -> None:
        """Book the difference of two sums that should be the same."""
        worst = float(np.abs(gap).max()) if np.size(gap) else 0.0
        if worst:
            name = RESIDUALS.get(unit, OTHER)
            known = scale and worst == worst  # nan is no small difference
            relative = worst / scale if known else float("inf")
            setattr(self, name, max(getattr(self, name), relative))


class Ledger:
    """Keeps an account for every link; a window is booked when all its components answered."""

    def __init__(self, exchange: Exchange, path: Path | None = None, size: int = 0) -> None:
        """Begin the file, or go on with the first `size` bytes of it."""
        self.exchange = exchange
        self.accounts = {link.name: Account(link.name) for link in exchange.links}
        self.totals: dict[str, dict[str, Any]] = {}
        self.energy = EnergyBalance()
        self.warnings = RunWarnings()
        self._balance = RunBalance(exchange)
        self._motion = MotionAudit(exchange)
        self._table = TableFile(path, size)
        if not size:
            self._table.write(COLUMNS)

    @property
    def worst(self) -> float:
        """Largest momentum residual of any link so far."""
        return max((account.momentum_residual for account in self.accounts.values()), default=0.0)

    def primed(self, name: str, fields: Fields) -> None:
        """Book the motion that a component was told before the first window."""
        self._motion.arrive(name, fields, (), 0.0)

    def book_given(self, name: str, header: Mapping[str, Any], fields: Fields) -> None:
        """Book what a component gave: its own sums against those of what arrived."""
        sent = header["sent"]
        for number, transfer in enumerate(self.exchange.transfers):
            for key, after in self.exchange.sums[number] if transfer.giver == name else ():
                scale = sent.get(f"{key}/size", [0.0])[0]
                gap = np.subtract(column_sums(fields[key]), sent.get(key, 0.0))
                self._account(number).note(self.exchange.unit(transfer.taker, after), gap, scale)
        for number, link in enumerate(self.exchange.links):
            account = self.accounts[link.name]
            for key, velocity, _ in self.exchange.works_of[number].get(name, []):
                share = self.exchange.share_of(number, name, velocity.partition(".")[0])
                work = sent[f"{key}/work"][share] if f"{key}/work" in sent else 0.0
                account.work_given += work
                self.energy.add_work(link.name, name, -work)
                if self.exchange.both_count_work(number):
                    account.turnover += abs(work)
                else:
                    self.energy.add_work(link.name, self._partner(number, name), work)

    def given_for(self, number: int, outputs: Fields) -> None:
        """Book what a component gave for one transfer in a window of its coupling."""
        self._balance.book_given(number, outputs)
        transfer = self.exchange.transfers[number]
        heats = [pair for pair in self.exchange.sums[number] if self._is_heat(transfer, pair[1])]
        for key, _ in heats:
            heat = float(np.sum(column_sums(self.exchange.rows(number, outputs)[key])))
            self.energy.add_heat(self._account(number).link, transfer.giver, -heat)

    def _is_heat(self, transfer: Transfer, key: str) -> bool:
        return self.exchange.unit(transfer.taker, key) == "W"

    def _partner(self, number: int, name: str) -> str:
        """The other side of a link."""
        transfers = self.exchange.links[number].transfers
        return next(side for t in transfers for side in (t.giver, t.taker) if side != name)

    def mapped(self, delivery: Delivery, sent: Mapping[str, Mapping[str, list[float]]]) -> None:
        """Book a mapping: sums of forces and of moments before against after.

        `sent` has the sums that each giver made of what it gave.
        """
        transfer, account = delivery.transfer, self._account(delivery.number)
        for before, after in self.exchange.sums[delivery.number]:
            array, unit = delivery.before[before], self.exchange.unit(transfer.taker, after)
            total = np.asarray(column_sums(delivery.after[after]))
            if unit == "N":
                account.impulse[: len(total)] += total
            if unit == "W":
                account.heat += float(total.sum())
                self.energy.add_heat(account.link, transfer.taker, float(total.sum()))
            account.note(unit, total - column_sums(array), size(array))
            if delivery.moment is not None and self._alone(delivery):
                moment = sent.get(transfer.giver, {}).get(f"{before}/moment")
                if moment is not None:
                    reach = max(np.abs(moment).max(), np.abs(delivery.moment).max())
                    account.note("N m", delivery.moment - moment, float(reach))

    def applied(self, name: str, fields: Fields, header: Mapping[str, Any]) -> None:
        """Book the impulses that a component was sent against what it received and applied."""
        self._balance.applied(name, header["applied"])
        takes = self.exchange.takes[name]
        for account in self._feeding(name):
            for key in fields:
                if takes[key].centring != "impulse":
                    continue
                scale, total = size(fields[key]), column_sums(fields[key])
                for seen in (header["received"].get(key, 0.0), header["applied"].get(key, 0.0)):
                    account.note(takes[key].unit, np.subtract(total, seen), scale)

    def _feeding(self, name: str) -> Iterable[Account]:
        """Accounts of the links that bring something to a component."""
        numbers = [
            n for n, transfer in enumerate(self.exchange.transfers) if transfer.taker == name
        ]
        return {id(account): account for account in map(self._account, numbers)}.values()

    def moved(self, name: str, inputs: WindowInputs, answer: Mapping[str, Any], dt: float) -> None:
        """Book the motion that a component was given in its steps against what it was sent."""
        self._motion.arrive(name, inputs.fields, inputs.ends, dt)
        worst = self._motion.residual(name, answer)
        for account in self._feeding(name):
            account.note("m/s", worst, 1.0)

    def close_window(
        self, late: Collection[int], in_transit: Mapping[tuple[str, str], Array]
    ) -> None:
        """Book, at a window's end, all that was ever given against all that was ever applied.

        The last impulses of `late` transfers, and what is in transit, will be applied later.
        """
        for taker, key, numbers, gap, scale in self._balance.gaps(late, in_transit):
            for number in numbers:
                self._account(number).note(self.exchange.unit(taker, key), gap, scale)

    def worked(
        self, delivery: Delivery, fields: Fields, before: Fields, after: Fields, dt: float
    ) -> None:
        """Book the work of the impulses that a component took, by its own motion."""
        takes = self.exchange.transfers
        for key, rate, place in self.exchange.works_on[delivery.number]:
            # What an iteration guessed is what was applied; of shared items each link has its own.
            others = [transfer for transfer in takes if transfer.taker == delivery.transfer.taker]
            alone = sum(key in transfer.fills for transfer in others) == 1
            pushed = fields[key] if alone else delivery.after[key]
            taker, account = delivery.transfer.taker, self._account(delivery.number)
            work = product(pushed, self._mean_rate(taker, before, after, (rate, place), dt))
            account.work_taken += work
            self.energy.add_work(account.link, taker, work)
            giver = delivery.transfer.giver
            if giver not in self.exchange.works_of[self.exchange.link_of[delivery.number]]:
                self.energy.add_work(account.link, giver, -work)

    def _mean_rate(
        self, name: str, before: Fields, after: Fields, keys: tuple[str, str], dt: float
    ) -> Array:
        """Mean of a rate over a window: from the displacement where it is known, else the ends'."""
        rate, place = keys
        if place == INTEGRAL:
            return after[rate] / dt
        ends = 0.5 * (before[rate] + after[rate])
        if not place:
            return np.asarray(ends)
        if self.exchange.output(name, place).kind == "rotation":
            return vector_between(before[place], after[place], dt * ends) / dt
        return (after[place] - before[place]) / dt

    def _alone(self, delivery: Delivery) -> bool:
        """Whether a transfer brings all that its giver gave; shared ports are split by rows."""
        pairs = zip(self.exchange.transfers, self.exchange.sums, strict=True)
        givers = [transfer.giver for transfer, sums in pairs if sums]
        return givers.count(delivery.transfer.giver) == 1

    def _account(self, number: int) -> Account:
        return self.accounts[self.exchange.links[self.exchange.link_of[number]].name]

    def note(self, time: float, totals: Mapping[str, dict[str, Any]]) -> None:
        """Write a row for every link and component, at a time [s]."""
        self.totals.update(totals)
        self.energy.note(self.totals)
        for account in self.accounts.values():
            residuals = [account.momentum_residual, account.angular_residual]
            work = [account.work_given, account.work_taken, account.heat]
            row = [time, account.link, *residuals, *account.impulse, *work]
            self._table.write([*row, *[""] * (len(COLUMNS) - len(row))])
        for name, sums in totals.items():
            link_work, heat = self.energy.brought(name)
            totals_row = [sums["mass"], *sums["momentum"], *(sums[kind] for kind in (*KINDS, WORK))]
            row = [time, name, *[""] * 7, heat, *totals_row, link_work, sums.get("dissipated")]
            self._table.write(row)
        self._table.flush()

    def save(self) -> dict[str, Any]:
        """All that is in the books, for a snapshot, and the length of the file [bytes]."""
        return {
            "accounts": [_as_row(account) for account in self.accounts.values()],
            "totals": self.totals,
            "energy": self.energy.save(),
            "warnings": self.warnings.save(),
            "balance": self._balance.save(),
            "motion": self._motion.save(),
            "size": self._table.flush(),
        }

    def load(self, state: Mapping[str, Any]) -> None:
        """Come back to saved books."""
        require_same_keys(self.accounts, {row["link"]: row for row in state["accounts"]})
        for row in state["accounts"]:
            values = {**row, "impulse": np.array(row["impulse"])}
            self.accounts[row["link"]] = Account(**attributes_like(Account(""), values))
        self.totals = dict(state["totals"])
        for sums in self.totals.values():
            masses = sums.get(MASS_BALANCE, {})
            numbers = [value for key, value in sums.items() if key != MASS_BALANCE]
            np.hstack([np.asarray(value, dtype=float) for value in (*numbers, *masses.values())])
        self.energy.load(state["energy"])
        self.warnings.load(state["warnings"])
        self._balance.load(state["balance"])
        self._motion.load(state["motion"])

    def go_on(self, state: Mapping[str, Any]) -> None:
        """Take over from another run's books what was on its way, and no sums or residuals."""
        self._balance.load(state["balance"])
        self._motion.load(state["motion"])

    def summary(self) -> dict[str, Any]:
        """What ``results.json`` says of it."""
        links = [
            {**_as_row(account), "energy_residual": account.energy_residual}
            for account in self.accounts.values()
        ]
        return {
            "links": links,
            "energy_balance": self.energy.summary(),
            "mass_drift": self.energy.mass_drift(),
            "mass_balance": {
                name: _mass_balance(sums)
                for name, sums in self.totals.items()
                if sums.get(MASS_BALANCE)
            },
        }

    def sync(self) -> None:
        """Bring all that was written to the disk."""
        self._table.sync()

    def close(self) -> None:
        """Close the file."""
        self._table.close()


def _mass_balance(totals: Mapping[str, Any]) -> dict[str, Any]:
    """Masses by reason [kg], the mass that there is [kg], and by how much they disagree [1]."""
    masses, mass = totals[MASS_BALANCE], totals["mass"]
    turnover = sum(map(abs, masses.values())) or 1.0
    return {"kg": masses, "now": mass, "residual": abs(sum(masses.values()) - mass) / turnover}


def _as_row(account: Account) -> dict[str, Any]:
    return {**asdict(account), "impulse": [float(p) for p in account.impulse]}
