"""Quantities as texts with a unit, ``"20 mm"``, converted to the SI unit of their key.

Numbers are computed as fractions and rounded once, so that ``"20 mm"`` gives the same bits as 0.02.
An angle is a dimension of its own: ``"60 Hz"`` is refused where rad/s is needed.
"""

import difflib
import re
from collections.abc import Callable, Iterator, Mapping
from fractions import Fraction
from functools import cache
from typing import Any

from quintet.interfaces.keys import Key, keys
from quintet.interfaces.libraries import require
from quintet.interfaces.params import LARGEST, shown

Table = dict[str, Any]
UnitOf = Callable[[Key, Mapping[str, Any]], str]  # of a key, in a table of its class

# Digits may be in groups, as in TOML: 1_000, but neither 2_ nor 1__0.
NUMBER = r"[+-]?(?:\d(?:_?\d){0,39}(?:\.\d{0,40})?|\.\d{1,40})(?:[eE][+-]?\d{1,3})?"
# What the unit itself may be is left to its reader.
QUANTITY = re.compile(rf"\s*({NUMBER})\s*((?:1\s*/\s*)?[A-Za-zµμΩÅ°%Δ][^\n\"]{{0,60}})")
PATTERN = rf"^\s*{NUMBER}\s*(1\s*/\s*)?[A-Za-zµμΩÅ°%Δ].*$"  # of the same, in a JSON schema
# Powers have one digit and stand at symbols: the time to read a unit is bounded.
SYMBOL = r"[A-Za-zµμΩÅ°%Δ_]+(?:(?:\^|\*\*)?-?\d|[²³])?"
TIMES = r"(?:\s*[*·⋅/]\s*|\s+)"
PRODUCT = rf"{SYMBOL}(?:{TIMES}{SYMBOL})*"
PART = rf"(?:{SYMBOL}|\(\s*{PRODUCT}\s*\))"
UNIT = re.compile(rf"(?:1\s*/\s*)?{PART}(?:{TIMES}{PART})*")
POWER = re.compile(r"(?<=[A-Za-zµμΩÅ°_])(?:\^|\*\*)?(-?\d)")

EXAMPLES = {
    "1": "30 %", "K": "25 degC", "Pa": "70 GPa", "Pa s": "1 mPa s", "kg": "20 g",
    "kg/m3": "7.85 g/cm3", "m": "20 mm", "m/s": "3 m/s", "m2/s": "1 mm2/s", "min": "2 h",
    "rad": "30 deg", "rad/s": "60 rpm", "s": "5 ms", "1/s": "50 Hz", "Hz": "50 Hz",
}  # fmt: skip

SYMBOLS = {"m", "s", "min", "kg", "K", "rad", "mol", "Hz", "N", "Pa", "J", "W"}  # of keys

# Exact by definition: BIPM, The International System of Units (2019); NIST SP 811, appendix B.8.
UNITS = """
femto- = 1e-15 = f-
pico- = 1e-12 = p-
nano- = 1e-9 = n-
micro- = 1e-6 = µ- = μ- = u-
milli- = 1e-3 = m-
centi- = 1e-2 = c-
deci- = 1e-1 = d-
hecto- = 1e2 = h-
kilo- = 1e3 = k-
mega- = 1e6 = M-
giga- = 1e9 = G-
tera- = 1e12 = T-
meter = [length] = m = metre
second = [time] = s = sec
gram = [mass] = g
kelvin = [temperature]; offset: 0 = K
radian = [angle] = rad
mole = [substance] = mol
percent = 0.01
minute = 60 * second = min
hour = 60 * minute = h = hr
day = 24 * hour = d
degree_Celsius = kelvin; offset: 273.15 = degC = celsius
degree_Fahrenheit = 5 / 9 * kelvin; offset: 459.67 * 5 / 9 = degF
degree = 3.14159265358979323846264338327950288 / 180 * radian = deg
turn = 360 * degree = rev = revolution
revolutions_per_minute = turn / minute = rpm
hertz = 1 / second = Hz
newton = kilogram * meter / second ** 2 = N
pascal = newton / meter ** 2 = Pa
joule = newton * meter = J
watt = joule / second = W
litre = 1e-3 * meter ** 3 = l = L = liter
tonne = 1000 * kilogram = t
angstrom = 1e-10 * meter = Å
inch = 0.0254 * meter = in
foot = 12 * inch = ft
yard = 3 * foot = yd
mile = 5280 * foot = mi
knot = 1852 * meter / hour = kn
pound = 0.45359237 * kilogram = lb
standard_gravity = 9.80665 * meter / second ** 2 = g_n
pound_force = pound * standard_gravity = lbf
pound_force_per_square_inch = pound_force / inch ** 2 = psi
bar = 1e5 * pascal
atmosphere = 101325 * pascal = atm
dyne = 1e-5 * newton = dyn
erg = 1e-7 * joule
electron_volt = 1.602176634e-19 * joule = eV
calorie = 4.184 * joule = cal
poise = 0.1 * pascal * second = P
stokes = 1e-4 * meter ** 2 / second = St
"""


def has_quantities(value: Any) -> bool:
    """Whether any text in nested tables and lists looks like a number with a unit."""
    if isinstance(value, (Mapping, list, tuple)):
        return any(map(has_quantities, value.values() if isinstance(value, Mapping) else value))
    return isinstance(value, str) and QUANTITY.fullmatch(value) is not None


def is_in_si(unit: str) -> bool:
    """Whether the unit of a key is written in symbols of SI, not described in words."""
    return bool(unit) and set(re.findall(r"[^\W\d]+|`", unit)) <= SYMBOLS


def in_si(
    params: type, table: Table, where: str, unit_of: UnitOf | None = None
) -> tuple[Table, list[str]]:
    """Return settings with numbers in place of texts with units, and every mistake in those texts.

    Parameters
    ----------
    params : type
        Made by `quintet.interfaces.params.parameters`; its docstring gives the unit of each key.
    table : dict
        The settings, as they stand in a scene. It is not changed.
    where : str
        What the settings are called in sentences.
    unit_of : function of a key and its table, optional
        Unit of a key whose docstring names none, as that of another key; "" if it has none.
    """
    if not has_quantities(table):
        return table, []
    mistakes: list[str] = []
    return _table(params, table, where, unit_of or (lambda key, _: key.unit), mistakes), mistakes


def _table(params: type, table: Table, where: str, unit_of: UnitOf, mistakes: list[str]) -> Table:
    known = {key.name: key for key in keys(params)}
    converted = {}
    for name, value in table.items():
        key, place = known.get(name), f"{where}.{name}"
        if key is not None and has_quantities(value):
            if key.inner is not None:
                value = _inner(key.inner, value, place, unit_of, mistakes)
            elif key.numeric:
                unit = unit_of(key, table)
                value = _numbers(value, unit, place, "text" in key.words, mistakes)
        converted[name] = value
    return converted


def _inner(params: type, value: Any, where: str, unit_of: UnitOf, mistakes: list[str]) -> Any:
    """Convert a table, tables in a list, or tables by name."""
    if isinstance(value, list):
        return [
            _inner(params, part, f"{where}.{number}", unit_of, mistakes)
            for number, part in enumerate(value)
        ]
    if not isinstance(value, dict):
        return value
    own_names = {key.name for key in keys(params)}
    if value.keys().isdisjoint(own_names) and all(isinstance(v, dict) for v in value.values()):
        return {
            name: _inner(params, part, f"{where}.{name}", unit_of, mistakes)
            for name, part in value.items()
        }
    return _table(params, value, where, unit_of, mistakes)


def _numbers(value: Any, unit: str, where: str, may_be_text: bool, mistakes: list[str]) -> Any:
    """Convert the texts in a value of a key that has a unit."""
    if isinstance(value, (list, dict)):
        pairs = value.items() if isinstance(value, dict) else enumerate(value)
        parts = {
            name: _numbers(part, unit, f"{where}.{name}", may_be_text, mistakes)
            for name, part in pairs
        }
        return parts if isinstance(value, dict) else list(parts.values())
    if not isinstance(value, str) or not QUANTITY.fullmatch(value):
        return value
    try:
        return number_in(value, unit, where)
    except ValueError as error:
        if not may_be_text:
            mistakes.append(str(error))
        return value


def number_in(text: str, unit: str, where: str) -> float:
    """Return a quantity as a number in a unit, correctly rounded.

    Raises
    ------
    ValueError
        It is of another dimension, or its unit is not known.
    SceneError
        The library that knows units is not installed.
    """
    require("pint", f"{where} = {shown(text)}, a text with a unit,")
    # Start-up: only scenes with such texts need it.
    from pint.errors import PintError

    target = _unit(unit) if unit else None
    if target is None:
        of_unit = f"in the unit {unit}" if unit else "as its kind states no unit for this key"
        raise ValueError(
            f"{where} must be a plain number, {of_unit}; found {shown(text)}. Write it without a "
            "unit."
        )
    match = QUANTITY.fullmatch(text)
    assert match is not None
    given_unit = _unit(match[2].strip())
    if given_unit is None:
        near = _nearest(match[2].strip(), target)
        hint = f"Did you mean {near}?" if near else f'Write it as in "{_example(unit)}".'
        raise ValueError(f"{where}: the unit of {shown(text)} is not known. {hint}")
    try:
        return float(_registry().Quantity(Fraction(match[1]), given_unit).to(target).magnitude)
    except OverflowError as error:
        raise ValueError(
            f"{where} must be below {LARGEST:.0e} in size, in SI units; found {shown(text)}. "
            "Correct it."
        ) from error
    except (PintError, ArithmeticError) as error:
        rule = f"in {unit}, or in a unit of the same dimension" if unit != "1" else "a pure number"
        raise ValueError(
            f'{where} must be {rule}, as in "{_example(unit)}"; found {shown(text)}. Correct its '
            "unit."
        ) from error


def _example(unit: str) -> str:
    return EXAMPLES.get(unit, f"1 {unit}")


@cache
def _registry() -> Any:
    # Start-up: only scenes with such texts need it.
    import pint

    # With few units it is ready at once, and no rare unit hides a slip of the pen.
    registry: Any = pint.UnitRegistry(None, non_int_type=Fraction, cache_folder=None)
    registry.load_definitions(UNITS.strip().splitlines())
    return registry


@cache
def _unit(text: str) -> Any:
    """Read a unit; None where it is not known."""
    # Start-up: only scenes with such texts need it.
    from pint.errors import PintError

    if text == "1":
        return _registry().dimensionless
    if not UNIT.fullmatch(text):
        return None
    try:
        return _registry().parse_units(_spelled(text))
    except PintError:
        return None


def _spelled(text: str) -> str:
    """Write a unit as its reader takes it: ``cm**3`` of ``cm3``."""
    for sign, name in (("°C", "degC"), ("°F", "degF"), ("°", "deg"), ("%", "percent")):
        text = text.replace(sign, name)
    return POWER.sub(r"**\1", text)


def _nearest(text: str, target: Any) -> str:
    """Return a known unit that a text may mean, of the dimension of a target; "" if none does."""
    symbols = re.findall(r"[A-Za-zµμΩÅ°_]+", text)
    if len(symbols) != 1:
        return ""
    common = ("mm", "cm", "µm", "km", "ms", "µs", "kg", "kPa", "MPa", "GPa", "kN", "kJ", "kW")
    near = difflib.get_close_matches(symbols[0], [*common, *_names()], 1, 0.5)
    unit = _unit(near[0]) if near else None
    return near[0] if unit is not None and unit.is_compatible_with(target) else ""


def _names() -> Iterator[str]:
    """Yield the names and symbols of the units."""
    for line in UNITS.split("\n"):
        name, *parts = (part.strip() for part in line.partition(";")[0].split(" = "))
        if name and not name.endswith("-"):
            yield name
            yield from (part for part in parts if re.fullmatch(r"[A-Za-zÅ°_]+", part))
