"""What a law finds: nothing, that it is broken, or that it says nothing of a component."""

from collections.abc import Callable

import numpy as np

from quintet.interfaces.component import Array, Fields
from quintet.interfaces.errors import QuintetError

SQUARE = 0.3  # of a gap that goes with the square of the step, at half the step: 1/4 and a margin
LESS = 0.45  # of one that goes with its power 5/4: 0.42; one that goes with the step is left by 1/2
ROUNDING = 1e-13


class LawBroken(QuintetError):
    """A component breaks a law: where, the rule, the value found, and what to do."""


class DoesNotApply(Exception):
    """A law says nothing of this component; carries why."""


def require(holds: bool, sentence: str) -> None:
    """Break the law unless it is kept."""
    if not holds:
        raise LawBroken(sentence)


def require_same_bits(arrays: Fields, expected: Fields, rule: str, remedy: str) -> None:
    """Break the law at the first array that differs in a bit, in name, type or shape."""
    if arrays.keys() != expected.keys():
        raise LawBroken(f"{rule}; found {_names(arrays)} where it was {_names(expected)}. {remedy}")
    for key in arrays:
        array, other = np.asarray(arrays[key]), np.asarray(expected[key])
        if array.dtype != other.dtype or array.shape != other.shape:
            raise LawBroken(
                f"{rule}; {key} is {array.dtype} {array.shape} where it was {other.dtype} "
                f"{other.shape}. {remedy}"
            )
        if array.tobytes() != other.tobytes():
            raise LawBroken(f"{rule}; {key}{_first_difference(array, other)}. {remedy}")


def raised(error: Exception) -> str:
    """An error as part of a sentence."""
    return f"{type(error).__name__}: {' '.join(str(error).split()).rstrip('.')}"


def _names(fields: Fields) -> str:
    return ", ".join(sorted(fields)) or "nothing"


def _first_difference(array: Array, other: Array) -> str:
    """First entry that differs, as text."""
    bits = [np.ascontiguousarray(a).reshape(-1).view(np.uint8) for a in (array, other)]
    differs = (bits[0] != bits[1]).reshape(array.size, -1).any(axis=1)
    index = np.unravel_index(int(np.argmax(differs)), array.shape)
    place = f" at {list(map(int, index))}" if array.ndim else ""
    return f"{place} is {array[index].item()!r} where it was {other[index].item()!r}"


def compare_gaps(
    gap: Callable[[float], dict[str, float]], dt: float, rule: str, remedy: str
) -> None:
    """Break the law unless gaps shrink faster than the step, or are rounding.

    Where the answer is smooth they go with the square of the step, and half of it shows this. At
    the onset of a contact (Hertz, damped: the power 5/4) they shrink less; then shorter steps must
    show that they do not go with the step itself.

    Parameters
    ----------
    gap : function
        Of a step [s]: largest difference of each field between two ways to the same end, as a
        share of its largest value if that is above 1.
    dt : float, s
        The longest step.
    """
    gaps = [gap(dt), gap(dt / 2.0)]
    if all(_shrinks(gaps, key, SQUARE) for key in gaps[0]):
        return
    gaps = [gap(dt / 4.0), gap(dt / 8.0)]
    for key, (whole, half) in {key: (gaps[0][key], gaps[1][key]) for key in gaps[0]}.items():
        if not _shrinks(gaps, key, LESS):
            raise LawBroken(
                f"{rule} apart by the square of the step; {key} is by {whole:.3g} at a step of "
                f"{dt / 4.0:g} s, and still by {half:.3g} at half of it. {remedy}"
            )


def _shrinks(gaps: list[dict[str, float]], key: str, share: float) -> bool:
    return gaps[1][key] <= share * gaps[0][key] + ROUNDING
