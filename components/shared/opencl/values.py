"""Printed values: their code, their type, and their number where it is known when printed."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from quintet.components.shared.opencl.names import identifier
from quintet.components.shared.opencl.prelude import Precision
from quintet.components.shared.opencl.types import (
    FLAG,
    INT,
    LANES,
    NONE,
    REAL,
    Record,
    Row,
    Type,
)

MOST_SINGLE = float(np.finfo(np.float32).max)
LEAST_SINGLE = float(np.finfo(np.float32).tiny)


@dataclass(frozen=True, slots=True)
class Value:
    """A value in C.

    Parameters
    ----------
    code : str
    kind : Type
    number : int, float, bool or None
        If it is known as the law is printed.
    items : tuple of Value
        Of a tuple that was written out.
    """

    code: str
    kind: Type
    number: Any = None
    items: "tuple[Value, ...] | None" = None

    def item(self, number: int) -> "Value":
        """One of a tuple, from its end if the number is negative."""
        if self.items is not None:
            return self.items[number]
        assert isinstance(self.kind, Row | Record)
        if isinstance(self.kind, Row):
            number %= len(self.kind.items)
            return Value(f"{self.code}.f{number}", self.kind.items[number])
        name, kind = self.kind.fields[number]
        return Value("" if kind == NONE else f"{self.code}.{identifier(name)}", kind)


def literal(number: Any, precision: Precision) -> Value:
    """Constant of a law.

    Raises
    ------
    OverflowError
        If single precision cannot hold it.
    TypeError
        If it is no number.
    """
    if number is None:
        return Value("", NONE)
    if isinstance(number, bool | np.bool_):
        return Value(str(int(number)), FLAG, bool(number))
    if isinstance(number, int | np.integer):
        return Value(f"{int(number)}L", INT, int(number))
    if isinstance(number, float | np.floating):
        return Value(_real(float(number), precision), REAL, float(number))
    raise TypeError(type(number).__name__)


def _real(number: float, precision: Precision) -> str:
    if math.isnan(number):
        return "NAN"
    if math.isinf(number):
        return "INFINITY" if number > 0.0 else "(-INFINITY)"
    size = abs(number)
    if precision == "single" and size and not LEAST_SINGLE <= size <= MOST_SINGLE:
        raise OverflowError(f"{number!r}")
    text = repr(number)
    text += "" if any(mark in text for mark in ".e") else ".0"
    text += "f" if precision == "single" else ""
    return f"({text})" if number < 0.0 else text


def converted(value: Value, kind: Type, precision: Precision) -> Value:
    """Return the same value as another type that holds it.

    Raises
    ------
    ValueError
        If it is a tuple with items of other types that was not written out.
    """
    if value.kind == kind:
        return value
    if kind == REAL and value.number is not None:
        return literal(float(value.number), precision)
    if kind == LANES:
        return Value(f"(reals)({converted(value, REAL, precision).code})", kind)
    if isinstance(kind, Row):
        if value.items is None:
            raise ValueError
        pairs = zip(value.items, kind.items, strict=True)
        return row([converted(item, item_kind, precision) for item, item_kind in pairs])
    assert kind in (REAL, INT)
    return Value(f"({'real' if kind == REAL else 'long'})({value.code})", kind)


def row(items: list[Value]) -> Value:
    """Make a tuple of values."""
    kind = Row(tuple(item.kind for item in items))
    return Value(struct_of(kind, items), kind, items=tuple(items))


def struct_of(kind: Row | Record, items: list[Value]) -> str:
    """Code that makes a struct."""
    codes = ", ".join(item.code for item in items if item.kind != NONE)
    return f"(({kind.name}){{{codes}}})"
