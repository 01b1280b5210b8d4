"""What every solver must be: it takes fields in, steps, and gives fields out."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from quintet.interfaces.units import check_unit

Array = NDArray[Any]
Fields = Mapping[str, Array]  # "port.field" -> (n, *shape)


@dataclass(frozen=True, slots=True)
class Field:
    """One array of a port: ``Field("force", (3,), "N", "impulse")``.

    ``instant`` fields are values at a time. ``impulse`` fields are rates that act over a
    step: a component gives and takes the rate [N], a link carries its integral over the
    window [N s], so that momentum closes at every subcycling ratio. ``rate`` names the field
    of the same port that is this one's time derivative; inputs are then interpolated by
    cubic Hermite polynomials. ``labels`` are whole numbers of things that the items of one link
    belong to; those of the next link are counted on from there.
    """

    name: str
    shape: tuple[int, ...]  # of one item; the array is (n, *shape)
    unit: str
    centring: Literal["instant", "impulse"] = "instant"
    rate: str = ""
    frame: Literal["world", "body"] = "world"
    labels: bool = False

    def __post_init__(self) -> None:
        check_unit(self.unit, f"field {self.name}", self.centring)


@dataclass(frozen=True, slots=True)
class Port:
    """A named bundle of fields that all have one row per item.

    ``static`` fields go once, with the port, before the first step (a body's mass);
    ``states`` go once, against it (the spacing at which the taker wants surfaces sampled).
    ``items`` says whose they are: what several links bring to a component's own items is
    added up, what they bring as the partner's items stands in rows one after another.
    """

    name: str
    fields: tuple[Field, ...]
    items: Literal["own", "partner"] = "own"
    static: tuple[Field, ...] = ()
    states: tuple[Field, ...] = ()


@dataclass(slots=True)
class Totals:
    """What a component holds, for the ledger; SI, world frame, moments about the origin."""

    mass: float = 0.0  # kg
    momentum: Array = field(default_factory=lambda: np.zeros(3))  # (3,) kg m/s
    angular_momentum: Array = field(default_factory=lambda: np.zeros(3))  # (3,) kg m2/s
    kinetic: float = 0.0  # J
    potential: float = 0.0  # J, gravity
    internal: float = 0.0  # J, elastic and thermal


class Component(ABC):
    """A solver that the coupler can drive; it knows nothing of the others.

    Keys of all fields are ``"port.field"``. Arrays that come in are read-only and are not
    kept; arrays that go out are copies.
    """

    takes: tuple[Port, ...] = ()
    gives: tuple[Port, ...] = ()

    def describe(self) -> Fields:
        """Static fields of the ports it gives, and what it states at those it takes."""
        return {}

    def bind(self, static: Fields) -> None:  # noqa: B027  (most need none)
        """Static fields of the ports that are joined; once, before the first take."""

    @abstractmethod
    def stable_dt(self) -> float:
        """Largest step that the present state allows [s]."""

    @abstractmethod
    def take(self, fields: Fields) -> None:
        """Set the inputs; they hold until the next take. Rates, not integrals."""

    @abstractmethod
    def step(self, dt: float) -> None:
        """Advance by exactly dt [s]."""

    @abstractmethod
    def give(self) -> Fields:
        """Copy out the outputs: instants at the present time, means over the last step."""

    @abstractmethod
    def save(self) -> Fields:
        """Copy out all state."""

    @abstractmethod
    def load(self, state: Fields) -> None:
        """Come back to a saved state, bit for bit."""

    def totals(self) -> Totals:
        """Mass, momentum and energies of what it holds."""
        return Totals()

    def view(self) -> Fields:
        """What a picture needs: ``points`` (n, 3) m, optional ``cells`` (m, 3 or 4), and fields."""
        return {}

    def items(self) -> int:
        """How many particles, bodies or elements it advances per step."""
        return 1
