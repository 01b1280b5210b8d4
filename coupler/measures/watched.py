"""Quantities whose coupling error a run estimates: those of expectations, and fields to watch."""

from dataclasses import dataclass
from typing import Annotated

import numpy as np
import pydantic

from quintet.coupler.measures.expectation import Expectation, Index
from quintet.interfaces.component import Array, Field
from quintet.interfaces.params import parameters
from quintet.interfaces.sums import norm


@parameters
class ErrorBarSettings:
    """Estimate of the error that the coupling makes in the watched quantities.

    Parameters
    ----------
    on
        Whether the error is estimated.
    every : 1
        One window of so many is repeated in 2 and in 4 shorter windows, as a trial.
    """

    on: bool = False
    every: Annotated[int, pydantic.Field(ge=1)] = 200


@dataclass(frozen=True, slots=True)
class Watched:
    """A quantity of one component: a whole field, or of it an item, a component, a mean.

    Parameters
    ----------
    name : str
        That of the expectation, or ``"component.port.field"``.
    component, field : str
        The component, and its field as ``"port.field"``.
    is_impulse : bool
        Whether the field is an impulse, which is watched as its mean rate.
    item : int or str
        Number of the item, or the mean, max or min of all; "all" keeps every item.
    axis : int or None
        Number of a vector's component; its magnitude if None, unless all items are kept.
    scale : float
        Factor of the values.
    rate : str
        Field of the rate of a single value, "" if there is none.
    """

    name: str
    component: str
    field: str
    is_impulse: bool
    item: Index | str = "all"
    axis: int | None = None
    scale: float = 1.0
    rate: str = ""

    def values(self, output: Array, window: float) -> Array:
        """Return the values (k,) from the field (n, ...) at the end of a window [s]."""
        array = output / window if self.is_impulse else output
        if self.item == "all":
            return np.asarray(self.scale * array).ravel()
        if self.axis is not None:
            array = array[..., self.axis]
        elif array.ndim > 1:
            array = np.array([norm(row) for row in array])
        if isinstance(self.item, int):
            array = array[self.item : self.item + 1]
        else:
            array = np.atleast_1d(getattr(array, self.item)())
        return np.asarray(self.scale * array)


def of_expectation(expectation: Expectation, field: Field) -> Watched:
    """Return what an expectation measures."""
    return Watched(
        expectation.name,
        expectation.component,
        expectation.field,
        field.centring == "impulse",
        expectation.item,
        expectation.axis,
        expectation.scale,
        _rate_of(expectation, field),
    )


def _rate_of(expectation: Expectation, field: Field) -> str:
    is_linear = expectation.item not in ("max", "min")
    is_linear = is_linear and (expectation.axis is not None or field.shape == ())
    port = expectation.field.partition(".")[0]
    return f"{port}.{field.rate}" if field.rate and is_linear else ""


def of_path(path: str, field: Field) -> Watched:
    """Return a whole field, given as ``"component.port.field"``."""
    component, _, key = path.partition(".")
    return Watched(path, component, key, field.centring == "impulse")
