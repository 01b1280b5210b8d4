"""Who steps when: serial and parallel staggered windows, and windows iterated to agreement.

Literature: Farhat and Lesoinne (2000) for the staggered schemes; Küttler and Wall (2008),
Comput. Mech. 43, 61, equation 44, for Aitken's relaxation of a repeated window.
"""

import contextlib
import time
from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass, field

import numpy as np

from quintet.coupler.coupling.exchange import Carried, Exchange
from quintet.coupler.coupling.ledger import Ledger
from quintet.coupler.coupling.participant import Part
from quintet.interfaces.component import Array, Fields
from quintet.interfaces.errors import LinkError, StepError
from quintet.interfaces.lines.message import Message

# What components take from those that step after them: by the taker's name and the field's.
Guess = dict[tuple[str, str], Array]
FLOOR = 1e-3  # of the largest value so far: below it agreement is not asked for
# Of the largest of all fields, in SI: below it there is only rounding, as in the torque on a body
# that water pushes evenly.
ROUNDING = 1e-12


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
    owed: Guess = field(default_factory=dict)  # impulses not yet applied
    sizes: dict[tuple[str, str], float] = field(default_factory=dict)  # largest norms so far
    repetitions: int = 0
    mapping: float = 0.0  # s spent on carrying and bookkeeping so far

    def gather(self, name: str, fresh: Collection[str]) -> Carried:
        """Carry to one component what the others gave last."""
        with self._timed():
            carried = self.exchange.inputs(name, self.outputs, fresh)
            carried.outputs, carried.sent = dict(self.outputs), dict(self.sent)
            return carried

    def settle(self, is_late: Callable[[str, str], bool]) -> None:
        """End a window's books; `is_late` tells which giver's impulses wait for the next."""
        with self._timed():
            self.ledger.settle(is_late, self.owed)

    @contextlib.contextmanager
    def _timed(self) -> Iterator[None]:
        began = time.perf_counter()
        yield
        self.mapping += time.perf_counter() - began

    def agree(self, gap: Guess, found: Guess) -> bool:
        """Whether what was guessed is what was found, to the iteration's tolerance."""
        norms = {key: float(np.linalg.norm(array)) for key, array in found.items()}
        for key, norm in norms.items():
            self.sizes[key] = max(self.sizes.get(key, 0.0), norm)
        least = {key: max(norm, FLOOR * self.sizes[key]) for key, norm in norms.items()}
        tolerance, rounding = self.iteration.tolerance, ROUNDING * max(norms.values(), default=0.0)
        return all(np.linalg.norm(gap[key]) <= max(tolerance * least[key], rounding) for key in gap)

    def start(self, name: str, window: int, carried: Carried, totals: bool) -> None:
        """Order one component's window."""
        self.parts[name].start(window, self.dt, carried.fields, carried.ends, totals)

    def book(self, name: str, carried: Carried, answer: Message) -> None:
        """Put an answer into the ledger and among the outputs."""
        ledger, header = self.ledger, answer.header
        with self._timed():
            ledger.mapped(carried)
            ledger.given(name, header, answer.fields, self.outputs)
            ledger.applied(name, carried.fields, header)
            ledger.moved(name, carried, header["handed"], self.dt)
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
    done: list[str] = []
    for name, part in coupling.parts.items():
        carried = coupling.gather(name, done)
        if any(not coupling.exchange.is_impulse(name, key) for key in carried.mixed):
            raise LinkError(
                f"{name}: what it takes in {carried.mixed[0].partition('.')[0]} must all come from "
                "components that step before it, or all from ones after it; it comes from both. "
                "Change scene.order, or use scheme parallel or iterated."
            )
        coupling.start(name, window, carried, totals)
        coupling.book(name, carried, part.finish())
        done.append(name)
    coupling.settle(lambda giver, taker: done.index(taker) <= done.index(giver))


def parallel(coupling: Coupling, window: int, totals: bool) -> None:
    """All at once: each sees the others as they were at the window's beginning."""
    # Those that follow a partner's motion first: their last loads were made along that way.
    first = sorted(coupling.parts, key=lambda name: not coupling.exchange.follows(name))
    inputs = {name: coupling.gather(name, ()) for name in first}
    for name in coupling.parts:
        coupling.start(name, window, inputs[name], totals)
    for name, part in coupling.parts.items():
        coupling.book(name, inputs[name], part.finish())
    coupling.settle(lambda giver, taker: True)


def iterated(coupling: Coupling, window: int, totals: bool) -> None:
    """Repeat the serial window until what goes back to the first components agrees.

    What the last repetition still lacked of an impulse is added in the next window, so that
    momentum closes to rounding although the iteration stops at its tolerance.
    """
    memory, before = coupling.exchange.memory(), dict(coupling.outputs)
    guess = _stale(coupling)
    aitken = Aitken(coupling.iteration)
    _all(coupling, "keep")
    for repetition in range(coupling.iteration.limit):
        coupling.exchange.recall(memory)
        if repetition:
            _all(coupling, "rewind")
            coupling.outputs = dict(before)
            coupling.repetitions += 1
        booked = _sweep(coupling, window, totals, guess)
        taken = {name: coupling.gather(name, coupling.parts) for name, _ in guess}
        found = {(name, key): taken[name].fields[key] for name, key in guess}
        gap = {key: found[key] - guess[key] for key in guess}
        if coupling.agree(gap, found):
            break
        guess = aitken.next(guess, gap)
    else:
        raise StepError(
            f"window {window}: {coupling.iteration.limit} repetitions must bring the components "
            "to agreement; they did not. Shorten the window, lower iteration.relaxation, or "
            "raise iteration.limit."
        )
    for name, carried, answer in booked:
        if name in taken:  # the mapping that counts is that of the agreed outputs
            carried.legs, carried.sent = taken[name].legs, taken[name].sent
        coupling.book(name, carried, answer)
    coupling.owed = {k: v for k, v in gap.items() if coupling.exchange.is_impulse(*k)}
    coupling.settle(lambda giver, taker: False)


def _sweep(
    coupling: Coupling, window: int, totals: bool, guess: Guess
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


def _stale(coupling: Coupling) -> Guess:
    """Inputs that come, wholly or in part, from components which step after their taker."""
    names = list(coupling.parts)
    found: Guess = {}
    for number, name in enumerate(names):
        carried = coupling.gather(name, names[:number])
        found |= {(name, k): v for k, v in carried.fields.items() if k not in carried.ends}
    return found


def _all(coupling: Coupling, order: str) -> None:
    for part in coupling.parts.values():
        part.tell(order)
    for part in coupling.parts.values():
        part.hear()


class Aitken:
    """Relaxation of a fixed-point iteration, its factor found from the last two residuals."""

    def __init__(self, settings: Iteration) -> None:
        self.settings = settings
        self.factor = settings.relaxation
        self._last: Array | None = None

    def next(self, guess: Guess, gap: Guess) -> Guess:
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
