"""What the header of each order must hold; anything else is refused in a sentence."""

import math
import reprlib
from collections.abc import Callable, Mapping
from typing import Any

from quintet.interfaces.errors import OrderError

MOST_STEPS = 10_000  # that may be asked for in a window
LARGEST = 1 << 62
TEXTS = frozenset((str,))
Rule = tuple[Callable[[Any], bool], str]  # whether a value is right, and what it must be


def is_count(value: Any) -> bool:
    """Whether a value is a whole number from 0."""
    return type(value) is int and 0 <= value < LARGEST


def is_names(value: Any) -> bool:
    """Whether a value is a list of texts."""
    return isinstance(value, list) and TEXTS.issuperset(map(type, value))


def _is_length(value: Any) -> bool:
    return type(value) in (int, float) and math.isfinite(value) and value > 0


def _is_steps(value: Any) -> bool:
    return is_count(value) and value <= MOST_STEPS


def _is_works(value: Any) -> bool:
    return isinstance(value, list) and all(is_names(names) and len(names) == 3 for names in value)


def _is_shares(value: Any) -> bool:
    return isinstance(value, dict) and all(map(_is_rows, value.values()))


def _is_rows(value: Any) -> bool:
    return isinstance(value, list) and all(
        isinstance(pair, list) and len(pair) == 2 and all(map(is_count, pair)) for pair in value
    )


COUNT: Rule = is_count, "a whole number from 0"
NAMES: Rule = is_names, "a list of names"
FLAG: Rule = lambda value: isinstance(value, bool), "true or false"
OF_ALL: dict[str, Rule] = {"window": COUNT, "depth": COUNT, "trial": FLAG}
OPTIONAL: dict[str, dict[str, Rule]] = {
    "go": {
        "folder": (lambda value: isinstance(value, str) and "\0" not in value, "a folder"),
        "starts": FLAG,
        "device": (lambda value: isinstance(value, str) and value != "", "the name of a device"),
    },
    "begin": {"goes_on": FLAG},
    "bind": {
        "joined": NAMES,
        "wanted": NAMES,
        "works": (_is_works, "a list of three names each"),
    },
    "prime": {"shares": (_is_shares, "a table of pairs of rows")},
    "rewind": {"last": FLAG},
    "advance": {
        "steps": (_is_steps, f"a whole number from 0 to {MOST_STEPS}"),
        "totals": FLAG,
    },
}
REQUIRED: dict[str, dict[str, Rule]] = {
    "go": {
        "threads": (lambda value: is_count(value) and value > 0, "a whole number from 1"),
        "params": (lambda value: isinstance(value, dict), "a table"),
    },
    "advance": {"window": COUNT, "dt": (_is_length, "a positive number"), "ends": NAMES},
}


def _rules(order: str) -> list[tuple[str, Rule, bool]]:
    """Of an order: key, rule, whether the order must have it."""
    required = REQUIRED.get(order, {})
    rules = {**OF_ALL, **OPTIONAL.get(order, {}), **required}
    return [(key, rule, key in required) for key, rule in rules.items()]


RULES = {order: _rules(order) for order in ("", *OPTIONAL, *REQUIRED)}


def check_order(order: str, header: Mapping[str, Any]) -> None:
    """Refuse an order whose header lacks something, or has what it may not."""
    for key, (is_right, words), required in RULES.get(order) or RULES[""]:
        if required or key in header:
            value = header.get(key)
            if not is_right(value):
                text = reprlib.repr(value)
                raise OrderError(f"order {order}: {key} must be {words}; found {text}.")
