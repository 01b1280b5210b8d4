"""What the answer to each order must hold; anything else ends the run in a sentence."""

import math
import reprlib
from collections.abc import Iterable, Mapping
from typing import Any

from quintet.interfaces.component import Field, Fields
from quintet.interfaces.errors import MessageError
from quintet.interfaces.lines.message import Message
from quintet.interfaces.serving.orders import Rule, is_count, is_names

NUMBERS = frozenset((int, float))
MOTION = frozenset(("first", "moved", "span"))
NONE: dict[str, Rule] = {}
TOTALS = {
    "mass": 0,
    "momentum": 3,
    "angular_momentum": 3,
    "kinetic": 0,
    "potential": 0,
    "internal": 0,
    "work": 0,
}
DISSIPATED = "dissipated"  # of totals: a number or None, where a component knows it
MASS_BALANCE = "mass_balance"  # of totals: numbers by reason, where a component knows them


def _is_number(value: Any) -> bool:
    return type(value) in NUMBERS and value == value  # which nan is not


def _is_time(value: Any) -> bool:
    return type(value) in NUMBERS and 0 <= value < math.inf


def _is_list(value: Any) -> bool:
    return type(value) is list and NUMBERS.issuperset(map(type, value))


def _is_sums(value: Any) -> bool:
    return type(value) is dict and (not value or all(map(_is_list, value.values())))


def _is_motion(value: Any) -> bool:
    return (
        type(value) is dict
        and value.keys() == MOTION
        and _is_sums(value["first"])
        and _is_sums(value["moved"])
        and _is_time(value["span"])
    )


def _are_totals(value: Any) -> bool:
    if not isinstance(value, dict) or value.keys() - {DISSIPATED, MASS_BALANCE} != TOTALS.keys():
        return False
    masses = value.get(MASS_BALANCE, {})
    if not isinstance(masses, dict) or not is_names([*masses]):
        return False
    if not all(map(_is_number, masses.values())):
        return False
    dissipated = value.get(DISSIPATED)
    if dissipated is not None and type(dissipated) not in NUMBERS:
        return False
    return all(
        type(value[key]) in (int, float) if not count else _is_list(value[key])
        for key, count in TOTALS.items()
    )


def _are_texts(value: Any) -> bool:
    return isinstance(value, dict) and is_names([*value, *value.values()])


COUNT: Rule = is_count, "a whole number from 0"
NUMBER: Rule = _is_number, "a number"
TIME: Rule = _is_time, "a time in s"
SUMS: Rule = _is_sums, "sums of fields"
ANSWERS: dict[str, dict[str, Rule]] = {
    "describe": {"seconds": TIME},
    "bind": {"items": COUNT},
    "prepare": {"stable": NUMBER, "seconds": TIME},
    "advance": {
        "steps": COUNT,
        "stable": NUMBER,
        "busy": TIME,
        "cpu": TIME,
        "sent": SUMS,
        "received": SUMS,
        "applied": SUMS,
        "inputs": (_is_motion, "sums of the motion that came"),
        "totals": (lambda value: value is None or _are_totals(value), "totals, or nothing"),
    },
    "load": {"stable": NUMBER},
    "conclude": {"warnings": (_are_texts, "texts by subject")},
    "view": {"totals": (_are_totals, "totals")},
    "finish": {"memory": COUNT, "cpu": TIME},  # cpu: of ranks that have not answered before
}


def check_answer(order: str, answer: Message) -> None:
    """Refuse an answer that lacks what the order asks for, or has what it may not."""
    if answer.order != "done":
        raise MessageError(
            f"the answer to {order} must be done or failed; found {reprlib.repr(answer.order)}."
        )
    header = answer.header
    notes = header.get("notes")
    if notes is not None and not is_names(notes):
        raise MessageError(f"the answer to {order}: notes must be a list of texts.")
    warnings = header.get("warnings")
    if warnings is not None and not _are_texts(warnings):
        raise MessageError(f"the answer to {order}: warnings must be texts by subject.")
    for key, (is_right, words) in ANSWERS.get(order, NONE).items():
        value = header.get(key)
        if not is_right(value):
            text = reprlib.repr(value)
            raise MessageError(f"the answer to {order}: {key} must be {words}; found {text}.")


def check_outputs(fields: Fields, wanted: Iterable[str], gives: Mapping[str, Field]) -> None:
    """Refuse outputs at the start that are not those that are wanted, or are of another shape."""
    if wrong := set(wanted) ^ fields.keys():
        name = reprlib.repr(min(wrong))
        raise MessageError(f"the answer to give must have all fields that are wanted; see {name}.")
    for key, array in fields.items():
        if array.dtype.kind not in "fiu" or array.shape[1:] != gives[key].shape or not array.ndim:
            raise MessageError(
                f"the answer to give: {key} must be numbers of shape (n, *{gives[key].shape}); "
                f"found {array.dtype} of shape {array.shape}."
            )


class AnswerSums:
    """Lengths of the sums in the answers of a component, of the fields that it takes and gives.

    Parameters
    ----------
    takes, gives : mapping of fields
        By their keys ``"port.field"``.
    links : mapping of int
        Force given -> links among which its work is divided.
    """

    def __init__(
        self, takes: Mapping[str, Field], gives: Mapping[str, Field], links: Mapping[str, int]
    ) -> None:
        self._taken, self._given = _lengths(takes, links), _lengths(gives, links)

    def check(self, answer: Message) -> None:
        """Refuse sums of fields that are not there, or of another length than the field's."""
        header = answer.header
        for key, array in answer.fields.items():
            if array.dtype.kind not in "fiu":
                raise MessageError(f"the answer to advance: {key} must be numbers.")
        _check_lengths("sent", header["sent"], self._given)
        for place in ("received", "applied"):
            _check_lengths(place, header[place], self._taken)
        for place in ("first", "moved"):
            _check_lengths(place, header["inputs"][place], self._taken)


def _lengths(fields: Mapping[str, Field], links: Mapping[str, int]) -> dict[str, int]:
    """Count the numbers of each sum of which an answer may tell."""
    lengths = {f"{key}/work": links[key] for key in fields if key in links}
    for key, field in fields.items():
        lengths |= {key: math.prod(field.shape), f"{key}/size": 1, f"{key}/moment": 3}
    return lengths


def _check_lengths(place: str, sums: Mapping[str, list[float]], lengths: Mapping[str, int]) -> None:
    for key, numbers in sums.items():
        if len(numbers) != lengths.get(key):
            raise MessageError(
                f"the answer to advance: {reprlib.repr(key)} of {len(numbers)} numbers is no "
                f"sum of what was {place}."
            )
