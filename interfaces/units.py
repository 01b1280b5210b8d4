"""Units of the fields that may cross a link: SI, one spelling each; others can be added."""

import re
from collections import Counter

from quintet.interfaces.errors import PortError

UNITS = {
    "1", "s", "m", "m2", "m3", "kg", "kg m2", "kg/m3", "kg/s", "m/s", "m/s2", "m2/s2", "rad/s",
    "1/s", "N", "N m", "N s", "N m s", "N/m", "Pa", "Pa s", "J", "W", "K", "J/K", "J/kg", "W/m2",
    "W/(m K)", "rad", "m3/s",
}  # fmt: skip

# What an impulse field carries over a link: its integral over the window.
INTEGRATED = {
    "N": "N s",
    "N m": "N m s",
    "W": "J",
    "m/s": "m",
    "rad/s": "rad",
    "kg/s": "kg",
    "m3/s": "m3",
}

# Derived units in base ones; rad is none.
DERIVED = {
    "N": {"kg": 1, "m": 1, "s": -2},
    "Pa": {"kg": 1, "m": -1, "s": -2},
    "J": {"kg": 1, "m": 2, "s": -2},
    "W": {"kg": 1, "m": 2, "s": -3},
    "rad": {},
}
PART = re.compile(r"([A-Za-z]+)(\d*)|[/()]")
SPELLING = re.compile(r"[A-Za-z0-9][A-Za-z0-9 /()]{0,23}")


def add_unit(unit: str, integral: str = "") -> None:
    """Let fields be in a unit that is not among those known, as ``add_unit("mol/s", "mol")``.

    Parameters
    ----------
    unit : str
        In SI base or derived units: letters, digits, spaces, / and parentheses.
    integral : str
        Unit of its integral over time, if it may be that of an impulse field.
    """
    for name in (unit, integral or unit):
        if not SPELLING.fullmatch(name):
            raise PortError(
                f"unit {name!r}: a unit must be at most 24 letters, digits, spaces, / and "
                "parentheses. Spell it as kg/(m s)."
            )
    if integral:
        if INTEGRATED.setdefault(unit, integral) != integral:
            raise PortError(
                f"unit {unit}: its integral is {INTEGRATED[unit]}; found {integral}. Use that."
            )
        UNITS.add(integral)
    UNITS.add(unit)


def check_unit(unit: str, where: str, centring: str) -> None:
    """Refuse a unit that is not known, or one that has no integral where one is needed."""
    if unit not in UNITS:
        raise PortError(
            f"{where}: a unit must be one of {', '.join(sorted(UNITS))}; found {unit!r}. "
            "Give the field in one of these, or add it with units.add_unit."
        )
    if centring == "impulse" and unit not in INTEGRATED:
        raise PortError(
            f"{where}: an impulse field must be in {', '.join(sorted(INTEGRATED))}; "
            f"found {unit!r}. Give its rate, or make it an instant field."
        )


def dimensions(unit: str) -> dict[str, int]:
    """Powers of the base units in a unit: ``{"kg": 1, "s": -3}`` of ``W/m2``."""
    powers: Counter[str] = Counter()
    bracket, sign = 1, 1
    for part in PART.finditer(unit):
        symbol, power = part[1], int(part[2] or 1)
        if symbol:
            for base, times in DERIVED.get(symbol, {symbol: 1}).items():
                powers[base] += bracket * sign * power * times
        if part[0] == "/":
            sign = -1
        else:  # a stroke divides by what follows next, a symbol or a bracket
            bracket = sign if part[0] == "(" else 1 if part[0] == ")" else bracket
            sign = 1
    return {base: power for base, power in powers.items() if power}


def same(first: str, other: str) -> bool:
    """Whether two units are one, however they are spelled: ``J/kg`` and ``m2/s2``."""
    spelled = all(SPELLING.fullmatch(unit) for unit in (first, other))
    return first == other or (spelled and dimensions(first) == dimensions(other))
