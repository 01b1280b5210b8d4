"""Texts with units become numbers, with the bits of the decimal number."""

import itertools
import re

import pytest

from quintet.interfaces.params import Number, Positive, Vector, parameters
from quintet.interfaces.quantities import has_quantities, in_si, is_in_si, number_in


@parameters
class Wall:
    """A wall.

    Parameters
    ----------
    temperature : K
        Of its surface.
    """

    temperature: Positive


@parameters
class Fluid:
    """A fluid.

    Parameters
    ----------
    spacing : m
        Of particles.
    gravity : m/s2
        Free fall.
    window : s
        Of time.
    name
        Any text.
    level : of the field
        Where the field has a unit of its own.
    walls
        In a list.
    faces
        By name.
    count
        Without a unit.
    """

    spacing: Positive = 1.0
    gravity: Vector = (0.0, 0.0, 0.0)
    window: Positive | str = "auto"
    name: str = ""
    level: Number = 0.0
    walls: tuple[Wall, ...] = ()
    faces: dict[str, Wall] | None = None
    count: Number = 0.0


# Texts, unit of the key, the number as a scene would write it.
SAME = [
    ("20 mm", "m", 0.02),
    ("0.3mm", "m", 0.0003),
    ("17.3 cm", "m", 0.173),
    ("3 µm", "m", 3e-6),
    ("1e-3 km", "m", 1.0),
    ("1 in", "m", 0.0254),
    ("3 ft", "m", 0.9144),
    ("5 m²", "m2", 5.0),
    ("7.85 g/cm3", "kg/m3", 7850.0),
    ("7.85 g/cm^3", "kg/m3", 7850.0),
    ("7.85 g cm-3", "kg/m3", 7850.0),
    ("3 m/s", "m/s", 3.0),
    ("36 km/h", "m/s", 10.0),
    ("1 min", "s", 60.0),
    ("7 ms", "s", 0.007),
    ("2 h", "min", 120.0),
    ("25 degC", "K", 298.15),
    ("-40 °F", "K", 233.15),
    ("70 GPa", "Pa", 70e9),
    ("1.1 bar", "Pa", 1.1e5),
    ("1 cP", "Pa s", 0.001),
    ("4.2 kJ/(kg K)", "J/(kg K)", 4200.0),
    ("60 rpm", "rad/s", 6.283185307179586),
    ("90 deg", "rad", 1.5707963267948966),
    ("50 Hz", "1/s", 50.0),
    ("5 1/s", "Hz", 5.0),
    ("30 %", "1", 0.3),
    ("3 N s/m", "N s/m", 3.0),
    ("1 g_n", "m/s2", 9.80665),
]


@pytest.mark.parametrize(("text", "unit", "number"), SAME)
def test_a_text_with_a_unit_has_the_bits_of_its_number(text, unit, number):
    assert number_in(text, unit, "key").hex() == number.hex()


def test_every_whole_number_of_millimetres_has_the_bits_of_its_decimal():
    assert [number_in(f"{n} mm", "m", "key") for n in range(2000)] == [
        float(f"{n}e-3") for n in range(2000)
    ]


WRONG = {
    ("20 kg", "m"): 'must be in m, or in a unit of the same dimension, as in "20 mm"',
    ("60 Hz", "rad/s"): 'must be in rad/s, or in a unit of the same dimension, as in "60 rpm"',
    ("3 mm", "1"): 'must be a pure number, as in "30 %"',
    ("1e999 m", "m"): "must be below 1e+30 in size, in SI units; found '1e999 m'",
    ("30 mn", "m"): """the unit of '30 mn' is not known. Write it as in "20 mm".""",
    ("3 mss", "s"): "the unit of '3 mss' is not known. Did you mean ms?",
    ("3 metr", "m"): "the unit of '3 metr' is not known. Did you mean metre?",
    ("3 m^99", "m"): "the unit of '3 m^99' is not known",
    ("3 m//s", "m/s"): "the unit of '3 m//s' is not known",
    ("3 m**", "m"): "the unit of '3 m**' is not known",
    ("3 mm", "of the field"): "must be a plain number, in the unit of the field",
    ("3 mm", ""): "must be a plain number, as its kind states no unit for this key",
}


@pytest.mark.parametrize(("text", "unit"), WRONG)
def test_a_wrong_unit_is_refused_with_the_one_that_is_needed(text, unit):
    with pytest.raises(ValueError) as error:
        number_in(text, unit, "components.water.spacing")
    assert str(error.value).startswith("components.water.spacing")
    assert WRONG[text, unit] in str(error.value)
    assert repr(text) in str(error.value)


GROUPS = ("1_000 mm", "1_0.5 m", "2_ kg", "2_kg", "1__0 m", "_1 m", "1_.5 m", "2.e1 m")


@pytest.mark.parametrize("text", GROUPS)
def test_digits_are_in_groups_as_in_toml_or_the_text_is_no_quantity(text):
    digits = text.removesuffix("kg").removesuffix("mm").removesuffix("m").strip()
    if not has_quantities(text):
        assert "_" in digits and not re.fullmatch(r"\d(_?\d)*", digits)
        table = {"spacing": text}
        assert in_si(Fluid, table, "water") == (table, [])  # refused as no number
    else:
        metres = float(digits) * (1e-3 if "mm" in text else 1.0)
        assert number_in(text, "m", "spacing") == pytest.approx(metres, rel=1e-15)


def test_every_text_that_looks_like_a_quantity_has_a_number_or_a_clear_mistake():
    parts = (part for n in range(1, 7) for part in itertools.product("1_.E", repeat=n))
    texts = [f"{''.join(part)} m" for part in parts]
    quantities = [text for text in texts if has_quantities(text)]
    outcomes = {text: _number_or_mistake(text) for text in quantities}
    assert sum(isinstance(number, float) for number in outcomes.values()) > 50
    for text, outcome in outcomes.items():
        # An E without an exponent is read as a unit.
        expected = float(text[:-2]) if isinstance(outcome, float) else f"unit of '{text}' is not"
        assert outcome == expected if isinstance(outcome, float) else expected in outcome


def _number_or_mistake(text):
    try:
        return number_in(text, "m", "key")
    except ValueError as error:
        return str(error)


def test_numbers_are_converted_wherever_a_key_has_them():
    table = {
        "spacing": "20 mm",
        "gravity": [0, "0 m/s2", "-981 cm/s2"],
        "window": "1 ms",
        "name": "20 mm",
        "walls": [{"temperature": "25 degC"}],
        "faces": {"north": {"temperature": "300 K"}},
    }
    converted, mistakes = in_si(Fluid, table, "water")
    assert mistakes == []
    assert converted == {
        "spacing": 0.02,
        "gravity": [0, 0.0, -9.81],
        "window": 0.001,
        "name": "20 mm",
        "walls": [{"temperature": 298.15}],
        "faces": {"north": {"temperature": 300.0}},
    }
    assert table["spacing"] == "20 mm"


def test_every_mistake_is_told_with_its_place():
    table = {"gravity": [0, 0, "1 m"], "walls": [{"temperature": "2 m"}], "level": "1 m"}
    _, mistakes = in_si(Fluid, {**table, "count": "3 kg"}, "water")
    places = [mistake.split(" ")[0] for mistake in mistakes]
    assert places == ["water.gravity.2", "water.walls.0.temperature", "water.level", "water.count"]


def test_words_and_texts_of_other_keys_are_left():
    table = {"window": "3 days later", "name": "42CrMo4", "spacing": "wide"}
    assert in_si(Fluid, table, "water") == (table, [])


def test_a_number_alone_is_no_text_with_a_unit():
    assert not has_quantities({"a": "0.02", "b": ["auto", "m 3"], "c": 1.0})
    assert has_quantities({"a": [{"b": "2 m"}]})


def test_units_in_symbols_are_told_from_those_in_words():
    assert all(map(is_in_si, ("m", "1", "1/s", "W/(m K)", "N s/m", "kg/m3")))
    assert not any(map(is_in_si, ("", "of the field", "`unit`", "`unit` over that of the field")))
