"""What motion a component should have been given in its steps, from what it was sent.

Computed here a second time, from sums over the items, and compared with the sums of what the
serving loop handed out: an input that is taken at the wrong time shows in the first step.
Rotations, whose interpolation is no sum, are computed from the items themselves.
"""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from quintet.coupler.coupling.exchange import Exchange
from quintet.interfaces.component import Array, Fields
from quintet.interfaces.errors import MessageError
from quintet.interfaces.serving.inputs import KnownEnds, value_at
from quintet.interfaces.sums import column_sums, size


@dataclass(slots=True)
class Instant:
    """Sums over the items of one instant field at the ends of a window."""

    start: Array
    size: float  # sum of the magnitudes at the start
    end: Array | None = None
    end_size: float = 0.0

    def pass_on(self) -> None:
        """Let what was the end be the next window's start."""
        if self.end is not None:
            self.start, self.size = self.end, self.end_size
            self.end, self.end_size = None, 0.0


@dataclass(slots=True)
class Turn:
    """A rotation or its angular velocity (n, 4) or (n, 3), at the ends of a window."""

    start: Array
    end: Array | None = None

    def pass_on(self) -> None:
        """Let what was the end be the next window's start."""
        if self.end is not None:
            self.start, self.end = self.end, None


class MotionAudit:
    """The instants that every component was sent last."""

    def __init__(self, exchange: Exchange) -> None:
        self._fields: dict[str, dict[str, str]] = {  # component -> instant -> its rate or ""
            name: {
                f"{port.name}.{field.name}": field.rate and f"{port.name}.{field.rate}"
                for port in takes
                for field in port.fields
                if field.centring == "instant"
            }
            for name, (takes, _) in exchange.ports.items()
        }
        self._kinds = {  # component -> instant -> what it is beyond numbers
            name: {key: field.kind for key, field in fields.items()}
            for name, fields in exchange.takes.items()
        }
        turning = {name: self._turning(name) for name in exchange.ports}
        self._turns: dict[str, dict[str, Turn]] = {name: {} for name in exchange.ports}
        self._turning_keys = turning
        self._sums: dict[str, dict[str, Instant]] = {name: {} for name in exchange.ports}
        self._window: dict[str, float] = {}  # s

    def _turning(self, name: str) -> set[str]:
        """Rotations that a component takes, and their angular velocities."""
        keys = {key for key, kind in self._kinds[name].items() if kind == "rotation"}
        return keys | {self._fields[name][key] for key in keys} - {""}

    def arrive(self, name: str, fields: Fields, ends: Collection[str], window: float) -> None:
        """Take note of what a component is sent for a window [s]."""
        sums = self._sums[name]
        self._window[name] = window
        for integral in sums.values():
            integral.pass_on()
        for turn in self._turns[name].values():
            turn.pass_on()
        for key in self._turning_keys[name] & fields.keys():
            if key in ends and key in self._turns[name]:
                self._turns[name][key].end = fields[key]
            else:
                self._turns[name][key] = Turn(fields[key])
        for key in self._fields[name]:
            if key not in fields:
                continue
            total, amount = np.asarray(column_sums(fields[key])), size(fields[key])
            if key in ends and key in sums:
                sums[key].end, sums[key].end_size = total, amount
            else:
                sums[key] = Instant(total, amount)

    def save(self) -> dict[str, Any]:
        """All that was sent last, for a snapshot."""
        sums = {
            name: {
                key: [
                    integral.start.tolist(),
                    integral.size,
                    None if integral.end is None else integral.end.tolist(),
                    integral.end_size,
                ]
                for key, integral in fields.items()
            }
            for name, fields in self._sums.items()
        }
        turns = {
            name: {key: [ends.start, ends.end] for key, ends in fields.items()}
            for name, fields in self._turns.items()
        }
        return {"sums": sums, "window": dict(self._window), "turns": turns}

    def load(self, state: Mapping[str, Any]) -> None:
        """Come back to what was saved."""
        self._window = dict(state["window"])
        for name, fields in state["turns"].items():
            self._turns[name] = {key: _turn(*ends) for key, ends in fields.items()}
        for name, fields in state["sums"].items():
            self._sums[name] = {
                key: Instant(
                    np.array(start), amount, None if end is None else np.array(end), end_amount
                )
                for key, (start, amount, end, end_amount) in fields.items()
            }

    def residual(self, name: str, answer: Mapping[str, Any]) -> float:
        """Worst difference between what was given out and what should have been, relative."""
        window, span = self._window[name], float(answer["span"])
        if unknown := {*answer["first"], *answer["moved"]} - self._sums[name].keys():
            raise MessageError(
                f"{name} reports how {min(unknown)} moved it, which it was never sent."
            )
        rates = set(self._fields[name].values())
        gaps = [0.0]
        for key, first in answer["first"].items():
            if key not in rates:
                gaps.append(
                    self._gap(name, key, np.subtract(first, self._at(name, key, 0.5 * span)))
                )
        for key, moved in answer["moved"].items():
            whole = self._at(name, key, window) - self._at(name, key, 0.0)
            gaps.append(self._gap(name, key, np.subtract(moved, whole)))
        return max(gaps)

    def _gap(self, name: str, key: str, gap: Array) -> float:
        sums, rate = self._sums[name], self._fields[name][key]
        scale = sums[key].size + sums[key].end_size
        if rate in sums:
            scale += self._window[name] * (sums[rate].size + sums[rate].end_size)
        worst = float(np.abs(gap).max()) if gap.size else 0.0
        return worst / scale if worst else 0.0

    def _at(self, name: str, key: str, time: float) -> Array:
        """Sum over the items of a field at a time [s] of the window."""
        ends, window = self._sums[name][key], self._window[name]
        if self._kinds[name][key] == "rotation":
            return np.asarray(column_sums(self._rotated(name, key, time)))
        if self._kinds[name][key] == "flag" and time < window:
            return ends.start
        rate = self._sums[name].get(self._fields[name][key])
        if ends.end is None:
            return ends.start + time * rate.start if rate else ends.start
        s = time / window
        if rate is None or rate.end is None:
            return (1.0 - s) * ends.start + s * ends.end
        return (
            (1.0 + 2.0 * s) * (1.0 - s) ** 2 * ends.start
            + s * (1.0 - s) ** 2 * window * rate.start
            + s * s * (3.0 - 2.0 * s) * ends.end
            - s * s * (1.0 - s) * window * rate.end
        )

    def _rotated(self, name: str, key: str, time: float) -> Array:
        """Quaternions (n, 4) of a rotation at a time [s] of the window."""
        turn, rate = self._turns[name][key], self._turns[name].get(self._fields[name][key])
        known = (rate.start, rate.end) if rate else (None, None)
        ends = KnownEnds(turn.start, known[0], turn.end, known[1])
        return value_at("rotation", ends, time, self._window[name])


def _turn(start: Array, end: Array | None) -> Turn:
    return Turn(np.array(start), None if end is None else np.array(end))
