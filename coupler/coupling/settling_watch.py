"""Links that must come to rest from window to window, as heat between two bars: swings are seen.

What is handed on, u, follows from what was handed on a window before. Near its rest u changes from
window to window by a factor a = 1 - ω (1 + g), where ω is the relaxation and g the gain, so that it
swings where a < 0 and never rests where a < -1. With noise in every answer, and a = 0, changes that
follow each other have a correlation of -1/2; a swing that persists has one near -1.
"""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from quintet.interfaces.component import Array
from quintet.interfaces.sums import dot, norm

if TYPE_CHECKING:
    from quintet.coupler.coupling.schedule import Coupling

SPAN = 8  # windows that count most: each older one by 1 - 1/SPAN less
FEWEST = 6  # changes before a link is judged
SWINGS = -0.8  # correlation of changes that follow each other, below which a link swings
LOUD = 0.2  # of the range so far: smaller swings do not matter
Key = tuple[str, str, str]  # link, component and field


class Swings:
    """Changes of one field from window to window."""

    def __init__(self, value: Array) -> None:
        self.last, self.low, self.high = value, value, value
        self.change = np.zeros_like(value)
        self.products = self.squares = 0.0
        self.count = 0

    def add(self, value: Array) -> None:
        """Add a window."""
        change, fade = value - self.last, 1.0 - 1.0 / SPAN
        self.products = fade * self.products + dot(change, self.change)
        self.squares = fade * self.squares + norm(change) * norm(self.change)
        self.count += 1
        self.last, self.change = value, change
        self.low, self.high = np.minimum(self.low, value), np.maximum(self.high, value)

    @property
    def ratio(self) -> float:
        """Correlation of changes that follow each other."""
        return self.products / self.squares if self.squares > 0.0 else 0.0

    @property
    def persists(self) -> bool:
        """Whether it swings back and forth, and not by little."""
        loud = norm(self.change) > LOUD * norm(self.high - self.low)
        return self.count >= FEWEST and loud and self.ratio < SWINGS


class SettlingWatch:
    """Looks at the instants of all links that must settle."""

    def __init__(self) -> None:
        self._swings: dict[Key, Swings] = {}
        self._watched: list[Key] | None = None  # known once the run has begun

    def look(self, coupling: "Coupling") -> None:
        """Add a window's end of the run, and warn of what swings."""
        if self._watched is None:
            self._watched = _watched(coupling)
        for link, name, key in self._watched:
            place, value = (link, name, key), coupling.outputs[name][key]
            if place not in self._swings:
                self._swings[place] = Swings(value)
                continue
            swings = self._swings[place]
            swings.add(value)
            if swings.persists:
                text = _text(coupling, place, swings)
                coupling.ledger.warnings.note(f"link {link}", {"settling": text})

    def save(self) -> dict[str, Any]:
        """All of it, for a snapshot."""
        return {"/".join(key): dict(vars(one)) for key, one in self._swings.items()}

    def load(self, state: Mapping[str, Any]) -> None:
        """Come back to what was saved."""
        self._swings = {}
        for place, values in state.items():
            link, name, key = place.split("/")
            one = self._swings[link, name, key] = Swings(values["last"])
            for item, value in values.items():
                setattr(one, item, value)


def _watched(coupling: "Coupling") -> list[Key]:
    """Instants that cross links which must settle: link, giver, field."""
    exchange = coupling.exchange
    return [
        (link.name, one.giver, key)
        for number, link in enumerate(exchange.links)
        if link.demands().settles
        for at, one in enumerate(exchange.transfers)
        if exchange.link_of[at] == number
        for key in one.reads
        if exchange.output(one.giver, key).centring == "instant"
    ]


def _text(coupling: "Coupling", place: Key, swings: Swings) -> str:
    link, name, key = place
    number = next(n for n, one in enumerate(coupling.exchange.links) if one.name == link)
    factors = coupling.exchange.links[number].demands().relaxation or (1.0,)
    # With a = 1 - ω (1 + g) the best relaxation is 1/(1 + g) = ω / (1 - a).
    best = factors[-1] / (1.0 - swings.ratio)
    return (
        f"{name}.{key} swings from window to window and does not settle: changes that follow each "
        f"other are opposite (correlation {swings.ratio:.2f}), the last one of "
        f"{norm(swings.change) / max(1.0, swings.change.size**0.5):.3g}. Set relaxation of the "
        f"link from {factors[-1]:g} to {best:.1g} or less."
    )
