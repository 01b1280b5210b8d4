"""Who steps when: serial and parallel staggered windows, and windows iterated to agreement.

Literature: Farhat and Lesoinne (2000) for the staggered schemes; Küttler and Wall (2008),
Comput. Mech. 43, 61, equation 44, for Aitken's relaxation of a repeated window.
"""

from collections.abc import Callable, Collection
from dataclasses import dataclass, field

import numpy as np

from quintet.coupler.exchange import Carried, Exchange
from quintet.coupler.ledger import Ledger
from quintet.coupler.part import Part
from quintet.interfaces.component import Array, Fields
from quintet.interfaces.errors import StepError
from quintet.interfaces.message import Message


@dataclass(slots=True)
class Iteration:
    """How a window is repeated until what crosses the links agrees."""

    tolerance: float = 1e-6  # of the change of every field, relative to its size
    limit: int = 50
    relaxation: float = 0.5  # of the first repetition; later ones as Aitken's method finds
    aitken: bool = True


@dataclass(slots=True)
class Coupling:
    """All that a scheme works on."""

    parts: dict[str, Part]  # in the order in which they step
    exchange: Exchange
    ledger: Ledger
    dt: float  # s, one window
    iteration: Iteration = field(default_factory=Iteration)
    outputs: dict[str, Fields] = field(default_factory=dict)  # the latest of every component
    sent: dict[str, dict[str, list[float]]] = field(default_factory=dict)  # sums as given
    owed: dict[tuple[str, str], Array] = field(default_factory=dict)  # impulses not yet applied
    repetitions: int = 0

    def gather(self, name: str, fresh: Collection[str]) -> Carried:
        """Carry to one component what the others gave last."""
        carried = self.exchange.inputs(name, self.outputs, fresh)
        carried.outputs, carried.sent = dict(self.outputs), dict(self.sent)
        return carried

    def start(self, name: str, window: int, carried: Carried, totals: bool) -> None:
        """Order one component's window."""
        self.parts[name].start(window, self.dt, carried.fields, carried.ends, totals)

    def book(self, name: str, carried: Carried, answer: Message) -> None:
        """Put an answer into the ledger and among the outputs."""
        ledger, header = self.ledger, answer.header
        ledger.mapped(carried)
        ledger.given(name, header, answer.fields)
        ledger.applied(name, carried.fields, header)
        ledger.worked(name, carried.fields, carried.outputs[name], answer.fields, self.dt)
        self.keep(name, answer)
        if header.get("totals"):
            ledger.totals[name] = header["totals"]

    def keep(self, name: str, answer: Message) -> None:
        """Make an answer the latest of its component."""
        self.outputs[name], self.sent[name] = answer.fields, answer.header["sent"]


Scheme = Callable[[Coupling, int, bool], None]  # coupling, window, whether totals are wanted


def serial(coupling: Coupling, window: int, totals: bool) -> None:
    """One after the other: each sees the window's end of those before it."""
    fresh: set[str] = set()
    for name, part in coupling.parts.items():
        carried = coupling.gather(name, fresh)
        coupling.start(name, window, carried, totals)
        coupling.book(name, carried, part.finish())
        fresh.add(name)


def parallel(coupling: Coupling, window: int, totals: bool) -> None:
    """All at once: each sees the others as they were at the window's beginning."""
    inputs = {name: coupling.gather(name, ()) for name in coupling.parts}
    for name, carried in inputs.items():
        coupling.start(name, window, carried, totals)
    for name, part in coupling.parts.items():
        coupling.book(name, inputs[name], part.finish())


def iterated(coupling: Coupling, window: int, totals: bool) -> None:
    """Repeat the serial window until what goes back to the first components agrees.

    What the last repetition still lacked of an impulse is added in the next window, so that
    momentum closes to rounding although the iteration stops at its tolerance.
    """
    everyone = set(coupling.parts)
    stale = {name: _stale(coupling, name, number) for number, name in enumerate(coupling.parts)}
    guess = {(n, k): v for n, fields in stale.items() for k, v in fields.items()}
    aitken = Aitken(coupling.iteration)
    memory, before = coupling.exchange.memory(), dict(coupling.outputs)
    _all(coupling, "keep")
    for repetition in range(coupling.iteration.limit):
        if repetition:
            _all(coupling, "rewind")
            coupling.exchange.recall(memory)
            coupling.outputs = dict(before)
            coupling.repetitions += 1
        booked = _sweep(coupling, window, totals, guess)
        found = {
            (name, key): coupling.gather(name, everyone).fields[key]
            for name, fields in stale.items()
            for key in fields
        }
        gap = {key: found[key] - guess[key] for key in guess}
        if all(_small(gap[key], found[key], coupling.iteration.tolerance) for key in gap):
            break
        guess = aitken.next(guess, gap)
    else:
        raise StepError(
            f"window {window}: {coupling.iteration.limit} repetitions must bring the components "
            "to agreement; they did not. Shorten the window, lower iteration.relaxation, or "
            "raise iteration.limit."
        )
    for name, carried, answer in booked:
        coupling.book(name, carried, answer)
    coupling.owed = {k: v for k, v in gap.items() if coupling.exchange.is_impulse(*k)}


def _sweep(
    coupling: Coupling, window: int, totals: bool, guess: dict[tuple[str, str], Array]
) -> list[tuple[str, Carried, Message]]:
    """Step all components once with guessed inputs where the true ones come later."""
    fresh: set[str] = set()
    booked = []
    for name, part in coupling.parts.items():
        carried = coupling.gather(name, fresh)
        for (taker, key), value in guess.items():
            if taker == name:
                carried.fields[key] = value + coupling.owed.get((taker, key), 0.0)
                carried.guessed.append(key)
                carried.ends.append(key)
        coupling.start(name, window, carried, totals)
        answer = part.finish()
        booked.append((name, carried, answer))
        coupling.keep(name, answer)
        fresh.add(name)
    return booked


def _stale(coupling: Coupling, name: str, number: int) -> dict[str, Array]:
    """Inputs of a component that come from those which step after it."""
    carried = coupling.gather(name, list(coupling.parts)[:number])
    return {key: value for key, value in carried.fields.items() if key not in carried.ends}


def _all(coupling: Coupling, order: str) -> None:
    for part in coupling.parts.values():
        part.tell(order)
    for part in coupling.parts.values():
        part.hear()


def _small(gap: Array, found: Array, tolerance: float) -> bool:
    return bool(np.linalg.norm(gap) <= tolerance * np.linalg.norm(found))


class Aitken:
    """Relaxation of a fixed-point iteration, its factor found from the last two residuals."""

    def __init__(self, settings: Iteration) -> None:
        self.settings = settings
        self.factor = settings.relaxation
        self._last: Array | None = None

    def next(
        self, guess: dict[tuple[str, str], Array], gap: dict[tuple[str, str], Array]
    ) -> dict[tuple[str, str], Array]:
        """Next guess, from this one and what it lacked."""
        residual = np.concatenate([gap[key].ravel() for key in gap])
        if self.settings.aitken and self._last is not None:
            change = residual - self._last
            square = float(change @ change)
            if square > 0.0:
                self.factor *= -float(self._last @ change) / square
        self._last = residual
        return {key: guess[key] + self.factor * gap[key] for key in guess}


SCHEMES: dict[str, Scheme] = {"serial": serial, "parallel": parallel, "iterated": iterated}
