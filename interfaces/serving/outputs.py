"""What a component gave over a window, and the sums by which the ledger checks it.

An impulse is the sum of force times step over the steps, so what a link carries is exactly
what the component did, at every subcycling ratio.
"""

import reprlib
from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from quintet.interfaces.component import Array, Fields, Port, fields_of
from quintet.interfaces.errors import PortError
from quintet.interfaces.sums import column_sums, moment, product, size

Sums = dict[str, list[float]]
Rows = Sequence[tuple[int, int]]
NUMBERS = "fiub"  # kinds of types that hold real numbers


class Outputs:
    """The outputs of one component over a window.

    ``works`` pairs a given force with the taken velocity (and position) of the same items:
    their products are the work and the angular impulse done through the port. Only fields that
    are `wanted` are asked for. Where the component gives integrals over its last step, as a
    recording does, they are added as they are. Work through a port that several links share is
    told for each link's rows by themselves.
    """

    def __init__(self, gives: Iterable[Port], integrals: bool = False) -> None:
        self.fields = fields_of(tuple(gives))
        self.integrals = integrals
        self.want(self.fields)
        self.works: list[tuple[str, str, str]] = []  # force, velocity, position or ""
        self.total: dict[str, Array] = {}
        self.shares: Mapping[str, Rows] = {}  # port taken -> first and last row + 1 of each link
        self.work: dict[str, list[float]] = {}  # of each link
        self.moment: dict[str, Array] = {}
        # Type and shape of each field that passed the checks last.
        self.accepted: dict[str, tuple[np.dtype[Any], tuple[int, ...]]] = {}

    def want(self, keys: Iterable[str]) -> None:
        """Ask for these fields only."""
        self.wanted = frozenset(keys)
        unknown = self.wanted - self.fields.keys()
        if unknown:
            raise PortError(f"output {reprlib.repr(min(unknown))} is wanted; no port gives it.")
        keys_wanted = [key for key in self.fields if key in self.wanted]
        self.shapes = {key: self.fields[key].shape for key in keys_wanted}
        self.impulses = [key for key in keys_wanted if self.fields[key].centring == "impulse"]
        self.through = frozenset(self.impulses)  # asked for after every step

    def begin(self) -> None:
        """Forget the last window."""
        self.total, self.work, self.moment = {}, {}, {}

    def check(self, fields: Fields) -> Fields:
        """Return what give() returned, once every field is as its port and its first time say."""
        # First for a dictionary: the abstract class alone takes ten times as long.
        if not isinstance(fields, (dict, Mapping)):
            raise PortError(
                f"give() must return its fields by name; found {type(fields).__name__}. Correct it."
            )
        for key, array in fields.items():
            accepted = self.accepted.get(key)
            if type(array) is not np.ndarray or (array.dtype, array.shape) != accepted:
                self._check(key, array)
        return fields

    def _check(self, key: str, array: Any) -> None:
        if not isinstance(array, np.ndarray) or array.dtype.kind not in NUMBERS:
            kind = array.dtype if isinstance(array, np.ndarray) else type(array).__name__
            raise PortError(
                f"output {key} must be an array of real numbers; found {kind}. Correct give()."
            )
        field = self.fields.get(key)
        if field is None or not array.ndim or array.shape[1:] != field.shape:
            known = field.shape if field else None
            raise PortError(
                f"output {key} must have shape (n, *{known}) as its port says; found "
                f"{array.shape}. Correct give(), or the port."
            )
        if key in self.accepted and array.shape != self.accepted[key][1]:
            raise PortError(
                f"output {key} must keep its shape {self.accepted[key][1]}; found "
                f"{array.shape}. The number of items of a port must not change: let a field "
                "`active` say which of them exist."
            )
        self._check_rows(key, array)
        self.accepted[key] = array.dtype, array.shape

    def _check_rows(self, key: str, array: Array) -> None:
        """Check that all fields of a port have one row for each item, the first time too."""
        port = key.partition(".")[0]
        for other, (_, shape) in self.accepted.items():
            if other.partition(".")[0] == port and shape[0] != len(array):
                raise PortError(
                    f"output {key} must have as many rows as {other}, {shape[0]}: one for each "
                    f"item of the port; found shape {array.shape}. Correct give()."
                )

    def add(self, outputs: Fields, taken: Fields, dt: float) -> None:
        """Add one step."""
        for key in self.impulses:
            if key not in outputs:
                raise PortError(f"give() must give {key} after every step; it is missing.")
            part = outputs[key] if self.integrals else dt * outputs[key]
            self.total[key] = self.total[key] + part if key in self.total else part
        for force, velocity, position in self.works:
            for key in filter(None, (velocity, position)):
                if key not in taken or len(taken[key]) != len(outputs[force]):
                    raise PortError(
                        f"the work of {force} needs a row of {key} for each of its items; found "
                        f"{len(taken.get(key, ()))} for {len(outputs[force])}."
                    )
            pushed, moved = outputs[force], taken[velocity]
            whole = ((0, len(pushed)),)
            shares = self.shares.get(velocity.partition(".")[0], whole)
            done = self.work.setdefault(force, [0.0] * len(shares))
            span = 1.0 if self.integrals else dt
            for link, (first, stop) in enumerate(shares):
                done[link] += span * product(pushed[first:stop], moved[first:stop])
            if position:
                turned = span * moment(taken[position], outputs[force])
                self.moment[force] = self.moment.get(force, np.zeros(3)) + turned

    def collect(self, outputs: Fields) -> dict[str, Array]:
        """Return the fields to send: instants as they are now, impulses summed over the window."""
        fields: dict[str, Array] = {}
        for key in self.shapes:
            if key not in outputs:
                raise PortError(f"give() must give every field that is wanted; {key} is missing.")
            output = outputs[key]
            fields[key] = self._summed(key, output) if key in self.through else output
        return fields

    def _summed(self, key: str, like: Array) -> Array:
        """An impulse summed over the window; zeros before the first step."""
        return self.total[key] if key in self.total else np.zeros_like(like)

    def audit(self) -> Sums:
        """Sum every impulse over the items, with its work and moment where they are known."""
        sums: Sums = {}
        for key, array in self.total.items():
            sums[key], sums[f"{key}/size"] = column_sums(array), [size(array)]
        for key, work in self.work.items():
            sums[f"{key}/work"] = work
        for key, turn in self.moment.items():
            sums[f"{key}/moment"] = turn.tolist()
        return sums


class InputAudit:
    """The instants that a component was given in a window, as sums over their items.

    From what it was sent the coupler can tell what they should be: of the first step, and
    the displacements of a whole window.
    """

    def __init__(self, instants: Collection[str], rates: Mapping[str, str]) -> None:
        self.instants, self.rates = instants, rates  # keys; of a position, its velocity
        self.first: Sums = {}  # in the middle of the first step
        self.moved: dict[str, Array] = {}  # of each position, velocity times step, summed up
        self.span = 0.0  # s, the first step

    def begin(self) -> None:
        """Forget the last window."""
        self.first, self.moved, self.span = {}, {}, 0.0

    def add(self, taken: Fields, dt: float) -> None:
        """Add one step."""
        if not self.span:
            self.span = dt
            self.first = {key: column_sums(taken[key]) for key in self.instants if key in taken}
        for key, rate in self.rates.items():
            if key in taken and rate in taken:
                part = dt * np.asarray(column_sums(taken[rate]))
                self.moved[key] = self.moved.get(key, 0.0) + part

    def audit(self) -> dict[str, Any]:
        """Return all of it, for a message."""
        moved = {key: array.tolist() for key, array in self.moved.items()}
        return {"first": self.first, "moved": moved, "span": self.span}
