"""Links that must come to rest from window to window, as heat between two bars.

What is handed on, u, follows the answer y to what was handed on a window before:
u ← u + ω (y - u), with the relaxation ω. Near its rest u changes from window to window by a factor
a = 1 - ω (1 + g), where g is the gain of the answer, so that it swings where a < 0 and never rests
where a < -1. With noise in every answer, changes of u that follow each other have a correlation of
(a - 1)/2; a swing that persists has one near -1. At the end of a run y - u must be noise: its mean
over the last windows shows how far u still is from its rest.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from quintet.coupler.coupling.saved_values import attributes_like
from quintet.coupler.coupling.schedule import Coupling
from quintet.interfaces.component import Array
from quintet.interfaces.sums import dot, norm

SPAN = 8  # windows that count most: each older one by 1 - 1/SPAN less
FEWEST = 6  # changes before a link is judged
SWINGS = -0.8  # correlation of changes that follow each other, below which a link swings
LOUD = 0.2  # of the range so far: smaller swings do not matter
# Mean of y - u at the end, of the range of y. A bar begun 30 % off, in 2, 4, 8, 16 windows: 0.46,
# 0.23, 0.11 and 0.03, where the mean temperature of its second half is 16, 4, 4 and 1 % off.
UNSETTLED = 0.2
Key = tuple[str, str, str]  # link, component and field


class Settling:
    """One field from window to window: the answers, and what is handed on of them."""

    def __init__(self, value: Array) -> None:
        self.handed, self.low, self.high = value, value, value
        self.change = np.zeros_like(value)  # of what is handed on
        self.products = self.squares = 0.0
        self.count = 0
        self.residual = np.zeros_like(value)  # mean of y - u over the last windows
        self.weight = 0.0  # of all windows in that mean
        self.lowest, self.highest = value, value  # of the answers

    def add(self, answer: Array, relaxation: float = 1.0) -> None:
        """Add a window by the answer to what was handed on, and hand on a share of the change."""
        residual, fade = answer - self.handed, 1.0 - 1.0 / SPAN
        change = relaxation * residual
        self.products = fade * self.products + dot(change, self.change)
        self.squares = fade * self.squares + norm(change) * norm(self.change)
        self.count += 1
        self.weight = fade * self.weight + 1.0
        self.residual = self.residual + (residual - self.residual) / self.weight
        self.handed, self.change = self.handed + change, change
        self.low, self.high = np.minimum(self.low, self.handed), np.maximum(self.high, self.handed)
        self.lowest = np.minimum(self.lowest, answer)
        self.highest = np.maximum(self.highest, answer)

    @property
    def ratio(self) -> float:
        """Correlation of changes that follow each other."""
        return self.products / self.squares if self.squares > 0.0 else 0.0

    @property
    def persists(self) -> bool:
        """Whether it swings back and forth, and not by little."""
        loud = norm(self.change) > LOUD * norm(self.high - self.low)
        return self.count >= FEWEST and loud and self.ratio < SWINGS

    @property
    def distance(self) -> float:
        """Mean of y - u over the last windows, relative to the range of y."""
        extent = norm(self.highest - self.lowest)
        return norm(self.residual) / extent if extent > 0.0 else 0.0


class SettlingWatch:
    """Looks at the instants of all links that must settle."""

    def __init__(self) -> None:
        self._settling: dict[Key, Settling] = {}
        self._watched: dict[Key, tuple[float, ...]] | None = None  # known once the run has begun

    def check(self, coupling: Coupling) -> dict[str, dict[str, str]]:
        """Add a window's end of the run, and warn of swings."""
        if self._watched is None:
            self._watched = _watched(coupling)
        texts = {}
        for place, factors in self._watched.items():
            link, name, key = place
            if place not in self._settling:
                self._settling[place] = Settling(coupling.previous[name][key])
            settling = self._settling[place]
            settling.add(coupling.outputs[name][key], _factor(factors, coupling.windows.done))
            if settling.persists:
                texts[link] = {"settling": _swings(place, settling, factors[-1])}
        return texts

    def final_warnings(self, coupling: Coupling) -> dict[str, dict[str, str]]:
        """Warn of links that are still far from their rest."""
        return {
            link: {"settling": _unsettled((link, name, key), settling, coupling.windows.done)}
            for (link, name, key), settling in self._settling.items()
            if settling.distance > UNSETTLED and not settling.persists
        }

    def save(self) -> dict[str, Any]:
        """All of it, for a snapshot."""
        return {"/".join(key): dict(vars(settling)) for key, settling in self._settling.items()}

    def load(self, state: Mapping[str, Any]) -> None:
        """Come back to what was saved."""
        self._settling = {}
        for place, values in state.items():
            link, name, key = place.split("/")
            settling = self._settling[link, name, key] = Settling(values["handed"])
            vars(settling).update(attributes_like(settling, values))


def _watched(coupling: Coupling) -> dict[Key, tuple[float, ...]]:
    """Relaxation of every instant that crosses a link which must settle, by window."""
    exchange = coupling.exchange
    return {
        (link.name, transfer.giver, key): link.demands().relaxation or (1.0,)
        for number, link in enumerate(exchange.links)
        if link.demands().settles
        for at, transfer in enumerate(exchange.transfers)
        if exchange.link_of[at] == number
        for key in transfer.reads
        if exchange.output(transfer.giver, key).centring == "instant"
    }


def _factor(factors: tuple[float, ...], window: int) -> float:
    return factors[min(window, len(factors) - 1)]


def _swings(place: Key, settling: Settling, relaxation: float) -> str:
    _, name, key = place
    # With a = 1 - ω (1 + g) the best relaxation is 1/(1 + g) = ω / (1 - a).
    best = relaxation / (1.0 - settling.ratio)
    return (
        f"{name}.{key} swings from window to window and does not settle: changes that follow each "
        f"other are opposite (correlation {settling.ratio:.2f}), the last one of "
        f"{norm(settling.change) / max(1.0, settling.change.size**0.5):.3g}. Set relaxation of the "
        f"link from {relaxation:g} to {best:.1g} or less."
    )


def _unsettled(place: Key, settling: Settling, windows: int) -> str:
    _, name, key = place
    return (
        f"{name}.{key} has not settled after {windows} windows: what its partner has got is still "
        f"{100.0 * settling.distance:.0f} % of its range away from it. Run more windows, "
        "shorter ones or for longer, or raise relaxation of the link."
    )
