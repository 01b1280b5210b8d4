"""Types of printed values: numbers, tuples and named tuples of them, and None."""

from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np


@dataclass(frozen=True, slots=True)
class Scalar:
    """A number, by its name in OpenCL C and its letter in names of tuples."""

    name: str
    letter: str


REAL = Scalar("real", "r")  # double or float, as the program says
LANES = Scalar("reals", "v")  # as many of these as a program computes at once
INT = Scalar("long", "i")
FLAG = Scalar("int", "b")  # True or False: `bool` has no fixed size
MASK = Scalar("mask", "m")  # a truth of each of LANES
NONE = Scalar("none", "n")  # known when a law is printed; of it nothing is printed
NUMBERS = (FLAG, INT, REAL, LANES)  # each can become the next one


@dataclass(frozen=True, slots=True)
class Row:
    """A tuple; its items are f0, f1, ... in C."""

    items: tuple["Type", ...]

    @property
    def letter(self) -> str:
        """Letters of its items, equal ones counted: ``3r``."""
        letters, text, start = [item.letter for item in self.items], "", 0
        for end in range(1, len(letters) + 1):
            if end == len(letters) or letters[end] != letters[start]:
                text += (str(end - start) if end - start > 1 else "") + letters[start]
                start = end
        return f"t{text}e"

    @property
    def name(self) -> str:
        """Of its struct."""
        return f"tuple_{self.letter[1:-1]}"


@dataclass(frozen=True, slots=True)
class Record:
    """A named tuple; fields that are None are known of the type and have no place in memory."""

    name: str  # of its struct
    fields: tuple[tuple[str, "Type"], ...]

    @property
    def letter(self) -> str:
        """In names of tuples."""
        return f"_{self.name}_"

    @property
    def stored(self) -> tuple[tuple[str, "Type"], ...]:
        """Fields of its struct."""
        return tuple(pair for pair in self.fields if pair[1] != NONE)


Type: TypeAlias = Scalar | Row | Record


def type_of(example: Any) -> Type:
    """Type of a number, None, or a (named) tuple of these.

    Parameters
    ----------
    example : float, int, bool, None or tuple
        A value; a type stands for itself.

    Raises
    ------
    TypeError
        For anything else, as an array.
    """
    if isinstance(example, Scalar | Row | Record):
        return example
    if example is None:
        return NONE
    if isinstance(example, bool | np.bool_):
        return FLAG
    if isinstance(example, int | np.integer):
        return INT
    if isinstance(example, float | np.floating):
        return REAL
    if isinstance(example, tuple):
        items = tuple(map(type_of, example))
        if hasattr(example, "_fields"):
            return Record(type(example).__name__, tuple(zip(example._fields, items, strict=True)))
        return Row(items)
    raise TypeError(
        "an argument of a printed law must be a number, None, or a tuple or named tuple of these; "
        f"found {type(example).__name__}. Read arrays in the kernel, and pass their numbers."
    )


def unified(first: Type, second: Type) -> Type | None:
    """Type that holds values of both, as numba unifies them; None if there is none."""
    if first == second:
        return first
    if first in NUMBERS and second in NUMBERS:
        return max(first, second, key=NUMBERS.index)
    if isinstance(first, Row) and isinstance(second, Row) and len(first.items) == len(second.items):
        items = [unified(*pair) for pair in zip(first.items, second.items, strict=True)]
        kinds = tuple(item for item in items if item is not None)
        return Row(kinds) if len(kinds) == len(items) else None
    return None


def memory_type(kind: Type, real: type[np.floating]) -> np.dtype[Any]:
    """How the struct of a value lies in memory, on this machine and on the device."""
    if isinstance(kind, Row | Record):
        named = kind.stored if isinstance(kind, Record) else _numbered(kind)
        return np.dtype([(name, memory_type(item, real)) for name, item in named], align=True)
    return np.dtype({REAL: real, INT: np.int64, FLAG: np.int32}[kind])


def bytes_of(value: Any, real: type[np.floating]) -> np.ndarray[Any, Any]:
    """Return a value, as an array of one struct: an argument of a kernel."""
    kind = type_of(value)
    return np.array(_stored(value), memory_type(kind, real))


def _numbered(kind: Row) -> list[tuple[str, Type]]:
    return [(f"f{number}", item) for number, item in enumerate(kind.items)]


def _stored(value: Any) -> Any:
    if isinstance(value, tuple):
        return tuple(_stored(item) for item in value if item is not None)
    return value
