"""Values of checks as a snapshot has them: anything may be there, though its checksum holds."""

from collections.abc import Mapping
from typing import Any, TypeVar

import numpy as np

T = TypeVar("T")


def like(pattern: T, value: Any) -> T:
    """Return a value with the type of a pattern; arrays may have any shape.

    Raises
    ------
    TypeError
        Where it has another type.
    """
    if type(value) is int and value.bit_length() > 63:
        raise TypeError("a number of at most 63 bits expected")
    numbers = isinstance(value, np.ndarray) and value.dtype.kind == "f"
    if isinstance(pattern, float) and isinstance(value, (int, float)):
        value = float(value)
    if type(value) is not type(pattern) or (isinstance(value, np.ndarray) and not numbers):
        wanted = type(pattern).__name__
        raise TypeError(f"{wanted} expected, found {type(value).__name__} {value!r:.40}")
    return value


def require_same_keys(present: Mapping[str, Any], saved: Mapping[str, Any]) -> None:
    """Refuse a table with other keys than there are now; KeyError."""
    if others := sorted(set(present) ^ set(saved)):
        raise KeyError(f"{others[0]} is {'missing' if others[0] in present else 'not known'}")


def attributes_like(pattern: Any, values: Mapping[str, Any]) -> dict[str, Any]:
    """Return values by the names of a pattern's attributes, each with the type that it has there.

    Raises
    ------
    KeyError, TypeError
        Where one is missing, or has another type.
    """
    names = getattr(pattern, "__slots__", None) or vars(pattern)
    return {name: like(getattr(pattern, name), values[name]) for name in names}
