"""What a law finds: nothing, that it is broken, or that it says nothing of a component."""

from collections.abc import Callable

import numpy as np

from quintet.interfaces.component import Array, Fields
from quintet.interfaces.errors import QuintetError

SHRINKS = 0.3  # of a gap that goes with the square of the step, at half the step; 0.25 and a margin
ROUNDING = 1e-13  # in the field's unit


class LawBroken(QuintetError):
    """A component breaks a law: where, the rule, the value found, and what to do."""


class DoesNotApply(Exception):
    """A law says nothing of this component; carries why."""


def require(kept: bool, sentence: str) -> None:
    """Break the law unless it is kept."""
    if not kept:
        raise LawBroken(sentence)


def require_same_bits(found: Fields, expected: Fields, rule: str, remedy: str) -> None:
    """Break the law at the first array that differs in a bit, in name, type or shape."""
    if found.keys() != expected.keys():
        raise LawBroken(f"{rule}; found {_names(found)} where it was {_names(expected)}. {remedy}")
    for key in found:
        one, other = np.asarray(found[key]), np.asarray(expected[key])
        if one.dtype != other.dtype or one.shape != other.shape:
            raise LawBroken(
                f"{rule}; {key} is {one.dtype} {one.shape} where it was {other.dtype} "
                f"{other.shape}. {remedy}"
            )
        if one.tobytes() != other.tobytes():
            raise LawBroken(f"{rule}; {key}{_first_difference(one, other)}. {remedy}")


def _names(fields: Fields) -> str:
    return ", ".join(sorted(fields)) or "nothing"


def _first_difference(one: Array, other: Array) -> str:
    """First entry that differs, as text."""
    bits = [np.ascontiguousarray(a).reshape(-1).view(np.uint8) for a in (one, other)]
    differs = (bits[0] != bits[1]).reshape(one.size, -1).any(axis=1)
    index = np.unravel_index(int(np.argmax(differs)), one.shape)
    place = f" at {list(map(int, index))}" if one.ndim else ""
    return f"{place} is {one[index]!r} where it was {other[index]!r}"


def compare_gaps(
    gap: Callable[[float], dict[str, float]], dt: float, rule: str, remedy: str
) -> None:
    """Break the law unless gaps shrink with the square of the step, or are rounding.

    Parameters
    ----------
    gap : function
        Of a step [s]: largest difference of each field between two ways to the same end.
    dt : float, s
        The longer step; the other is half of it.
    """
    whole, half = gap(dt), gap(0.5 * dt)
    for key, found in whole.items():
        if not half[key] <= SHRINKS * found + ROUNDING:
            raise LawBroken(
                f"{rule} apart by the square of the step or less; {key} is by {found:.3g} at a "
                f"step of {dt:g} s, and still by {half[key]:.3g} at half of it. {remedy}"
            )
