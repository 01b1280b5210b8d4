"""Keys of a parameter class are read as data, from its docstring and annotations."""

from dataclasses import dataclass
from typing import Annotated, Any, Literal

from pydantic import Field

from quintet.interfaces.keys import about, keys
from quintet.interfaces.params import (
    Count,
    DataFile,
    Fraction,
    NotNegative,
    Positive,
    PositiveVector,
    Vector,
    parameters,
)


@parameters
class Leg:
    """A leg."""

    length: Positive = 1.0


@parameters
class Table:
    """A table to stand on.

    It has legs.

    Parameters
    ----------
    height : m
        Of its top, over
        two lines.
    low, high : kg/m3
        Of its wood.
    colour
        Any.

    References
    ----------
    None : of them.
    """

    height: Positive
    low: NotNegative = 0.0
    high: Positive | None = None
    colour: Literal["red", "green", "blue"] = "red"
    corners: tuple[Vector, Vector] = ((0.0, 0.0, 0.0), (1e-6, 1.0, 1.0))
    size: PositiveVector | None = None
    share: Fraction = 0.5
    many: Annotated[tuple[Vector, ...], Field(min_length=1)] = ((0.0, 0.0, 1.0),)
    every: Positive | Literal["auto"] = "auto"
    count: Count = 3
    file: DataFile = ""
    free: dict[str, Any] = Field(default_factory=dict)
    leg: Leg = Leg()
    legs: tuple[Leg, ...] = ()
    named: dict[str, Leg] = Field(default_factory=dict)
    first: Annotated[int, Field(alias="from", ge=2)] = 2


KEYS = {key.name: key for key in keys(Table)}


def test_meaning_and_unit_are_those_of_the_docstring():
    assert (KEYS["height"].meaning, KEYS["height"].unit) == ("Of its top, over two lines.", "m")
    assert KEYS["low"].unit == KEYS["high"].unit == "kg/m3"
    assert (KEYS["colour"].meaning, KEYS["colour"].unit) == ("Any.", "")
    assert (KEYS["size"].meaning, KEYS["size"].unit) == ("", "")
    assert about(Table) == "A table to stand on.\n\nIt has legs."


def test_a_plain_dataclass_is_read_too():
    @dataclass
    class Plain:
        """Plain.

        Parameters
        ----------
        height : m
            Of it.
        """

        height: float = 2.0
        share: Fraction = 0.5

    height, share = keys(Plain)
    assert (height.meaning, height.unit, height.words) == ("Of it.", "m", "number")
    assert (share.range, share.default) == ("0 to 1", "0.5")


def test_a_class_without_a_docstring_says_nothing():
    @parameters
    class Silent:
        height: Positive

    assert about(Silent) == "" and [key.meaning for key in keys(Silent)] == [""]


def test_type_range_and_default_are_those_of_the_annotation():
    rows = {name: (key.words, key.range, key.default) for name, key in KEYS.items()}
    assert rows == {
        "height": ("number", "> 0", ""),
        "low": ("number", "≥ 0", "0.0"),
        "high": ("number", "> 0", "none"),
        "colour": ('"red", "green" or "blue"', "", '"red"'),
        "corners": ("2 × 3 numbers", "", "[[0.0, 0.0, 0.0], [1e-6, 1.0, 1.0]]"),
        "size": ("3 numbers", "> 0", "none"),
        "share": ("number", "0 to 1", "0.5"),
        "many": ("list of 3 numbers", "not empty", "[[0.0, 0.0, 1.0]]"),
        "every": ('number or "auto"', "> 0", '"auto"'),
        "count": ("whole number", "≥ 1", "3"),
        "file": ("file", "", '""'),
        "free": ("table", "", "{}"),
        "leg": ("table", "", ""),
        "legs": ("list of tables", "", "[]"),
        "named": ("table of tables", "", "{}"),
        "from": ("whole number", "≥ 2", "2"),
    }
    assert [key.name for key in KEYS.values() if key.needed] == ["height"]


def test_tables_within_and_numbers_are_known():
    inner = {name: key.place for name, key in KEYS.items() if key.inner is Leg}
    assert inner == {"leg": "table", "legs": "list", "named": "names"}
    text = {"colour", "file", "free", *inner}
    assert {name for name, key in KEYS.items() if not key.numeric} == text
