"""Parameters of a component: a frozen dataclass, checked once, before anything starts.

``@parameters`` makes one. Fields are annotated with the constrained types below, so that a
wrong scene is refused with every mistake at once and no solver imported.

A class whose keys were renamed says so in ``RENAMED``, by which an old key is answered with the
new one, a dotted path from the same table:

    @parameters
    class Water:
        RENAMED: ClassVar = {"laminar": "viscosity.kinematic"}
        viscosity: Viscosity = Viscosity()
"""

import dataclasses
import difflib
import json
import math
import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from contextvars import ContextVar
from functools import cache
from pathlib import Path
from typing import Annotated, Any, dataclass_transform, get_args

import numpy as np
from pydantic import (
    AfterValidator,
    ConfigDict,
    Field,
    TypeAdapter,
    ValidationError,
    ValidationInfo,
)
from pydantic.dataclasses import dataclass

Number = Annotated[float, Field(allow_inf_nan=False)]
Positive = Annotated[float, Field(gt=0, allow_inf_nan=False)]
NotNegative = Annotated[float, Field(ge=0, allow_inf_nan=False)]
Fraction = Annotated[float, Field(ge=0, le=1, allow_inf_nan=False)]
Count = Annotated[int, Field(ge=1)]
Vector = tuple[Number, Number, Number]
PositiveVector = tuple[Positive, Positive, Positive]


def _data_file(name: str, info: ValidationInfo) -> str:
    """Return the path of a file that lies in the scene's folder."""
    path = Path((info.context or {}).get("folder", "")) / name
    if not path.is_file():
        raise ValueError(
            f"file {name} must lie beside the scene; in its folder there is none. Put it there, "
            "or correct its name."
        )
    return str(path)


DataFile = Annotated[str, AfterValidator(_data_file)]  # named from the scene's folder on


def is_data_file(metadata: object) -> bool:
    """Whether metadata of a text are those of `DataFile`."""
    return isinstance(metadata, AfterValidator) and metadata.func is _data_file


# What pydantic adds to a place.
TAG = re.compile(r"constrained-\w+|(?:literal|tuple|dict|function-\w+)\[.*\]")
LARGEST = 1e30  # no quantity in SI units is as large; of ten of them a product is still finite
DEEPEST = 32  # tables and lists within each other
SHOWN = 200  # characters of a value in a sentence
MOST_NEAR = 200  # names among which the nearest is looked for, and that are listed
MOST_SAID = 20  # mistakes of one table
MISSING = ("missing", "missing_argument")  # pydantic's names of mistakes
# What to write where a text stands in the place of a number, by pydantic's rule.
NUMBERS = {
    "should be a valid number": "it without quotes, or, if its key has a unit, with a decimal "
    'point and a unit, as in "2.5 mm"',
    "should be a valid integer": "it without quotes",
}


@dataclass_transform(kw_only_default=True, frozen_default=True)
def parameters(cls: type) -> Any:
    """Make a class a frozen, validated parameter set; unknown names are refused."""
    config = ConfigDict(extra="forbid", strict=True)
    return dataclass(frozen=True, kw_only=True, config=config)(cls)


_starts: ContextVar[bool] = ContextVar("starts", default=True)


def starts_there() -> bool:
    """Whether the parameters that are checked now also say where the component starts.

    Not of a component that begins from the state of another run: where its bodies or particles
    would stand otherwise is then no mistake.
    """
    return _starts.get()


def read(
    params: type,
    table: dict[str, Any],
    where: str,
    folder: Path | None = None,
    starts: bool = True,
    beside: Collection[str] = (),
) -> tuple[Any, list[str]]:
    """Check settings against a parameter class; return it filled, or None and every mistake.

    Parameters
    ----------
    params : type
        Made by `parameters`.
    table : dict
        The settings, as they stand in a scene.
    where : str
        What the settings are called in sentences.
    folder : Path, by default the working folder
        Where their data files lie.
    starts : bool
        See `starts_there`.
    beside : collection of str
        Further keys of the same table, which others read: a misspelt one may be meant.
    """
    if extreme := list(extremes(table, where)):
        return None, extreme
    token = _starts.set(starts)
    try:
        # Strict checking of JSON takes lists for tuples, but no text for numbers.
        text = json.dumps(table)
        context = {"folder": folder or Path()}
        with np.errstate(over="raise", divide="raise", invalid="raise"):
            return _adapter(params).validate_json(text, strict=True, context=context), []
    except ValidationError as error:
        wrong = _drop_renamed(params, _by_place(error.errors(), table))
        more = [f"{where}: {len(wrong) - MOST_SAID} more mistakes."] if wrong[MOST_SAID:] else []
        sentences = (_sentence(params, where, mistake, beside) for mistake in wrong[:MOST_SAID])
        return None, [*sentences, *more]
    except (ArithmeticError, np.linalg.LinAlgError) as error:
        return None, [beyond_computing(where, table, error)]
    except (TypeError, ValueError) as error:
        return None, [f"{where}: {error}. Use numbers, text, lists and tables only."]
    finally:
        _starts.reset(token)


@cache
def _adapter(params: type) -> TypeAdapter[Any]:
    """What checks a parameter class, made once: making it takes longer than checking."""
    return TypeAdapter(params)


def extremes(value: Any, where: str, depth: int = 0) -> Iterator[str]:
    """Sentences about numbers that are too large to compute with, and lists that are too deep."""
    if depth > DEEPEST:
        yield f"{where} must be at most {DEEPEST} lists and tables deep; it is deeper. Flatten it."
    elif isinstance(value, (Mapping, list, tuple)):
        pairs = value.items() if isinstance(value, Mapping) else enumerate(value)
        for key, part in pairs:
            yield from extremes(part, f"{where}.{key}" if where else str(key), depth + 1)
    elif isinstance(value, (int, float)) and LARGEST <= abs(value) < math.inf:
        yield (
            f"{where} must be below {LARGEST:.0e} in size, in SI units; found {shown(value)}. "
            "Correct it."
        )


def beyond_computing(where: str, table: Any, error: Exception) -> str:
    """Sentence about numbers that leave what can be computed, though each by itself is sound."""
    sizes = [size for size in _sizes(table) if size > 0.0]
    span = f"from {min(sizes):.3g} to {max(sizes):.3g}" if sizes else "none"
    return (
        f"{where}: its numbers must be such that what follows from them can be computed; found "
        f"sizes {span} ({error}). Correct them; all are in SI units."
    )


def _sizes(value: Any) -> Iterator[float]:
    if isinstance(value, (Mapping, list, tuple)):
        for part in value.values() if isinstance(value, Mapping) else value:
            yield from _sizes(part)
    elif isinstance(value, (int, float)) and not isinstance(value, bool):
        yield abs(float(value))


def shown(value: Any) -> str:
    """Text of a value as a sentence says what was found: of a long one its beginning."""
    if isinstance(value, int) and abs(value) >= LARGEST:
        return f"about 1e{round(value.bit_length() * math.log10(2.0))}"
    text = repr(value)
    return text if len(text) <= SHOWN else f"{text[:SHOWN]}..."


def _by_place(mistakes: Iterable[Any], table: Any) -> list[dict[str, Any]]:
    """One mistake for each place; where a value may be of several kinds, their rules joined."""
    joined: dict[tuple[Any, ...], dict[str, Any]] = {}
    for mistake in mistakes:
        place = _without_kinds(mistake["loc"], table, mistake["type"] in MISSING)
        around = joined.get(place[:-1])
        if around and around["input"] == mistake["input"]:  # the same value, as another kind
            place = place[:-1]
        if place in joined:
            joined[place]["msg"] += " or " + mistake["msg"].removeprefix("Input should be ")
        else:
            joined[place] = {**mistake, "loc": place}
    # Of a table that may stand in the place of a text, only what is wrong in it is said.
    outer = {place[:n] for place in joined for n in range(len(place))}
    return [mistake for place, mistake in joined.items() if place not in outer]


def _without_kinds(place: tuple[Any, ...], table: Any, is_missing: bool) -> tuple[Any, ...]:
    """Place of a mistake without the names of kinds that a value may be of."""
    names, value = [], table
    for number, part in enumerate(place):
        is_last = number + 1 == len(place)
        is_key = isinstance(value, Mapping) and part in value
        is_item = isinstance(value, list) and isinstance(part, int) and part < len(value)
        if is_key or is_item:
            value = value[part]
        elif TAG.fullmatch(str(part)) or not (is_last and is_missing):
            continue
        names.append(part)
    return tuple(names)


def _drop_renamed(params: type, mistakes: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """All but keys said to be missing that are there under their old names."""
    renamed = {
        (*mistake["loc"][:-1], *new.split("."))
        for mistake in mistakes
        if (new := _renamed(params, [str(part) for part in mistake["loc"]]))
    }
    return [
        mistake
        for mistake in mistakes
        if mistake["loc"] not in renamed or mistake["type"] not in MISSING
    ]


def _renamed(params: type, names: list[str]) -> str:
    """Path of what the key at the end of these names is called now; "" if it keeps its name."""
    *heads, last = names or [""]
    return renamed_keys(_class_at(params, heads)).get(last, "")


def renamed_keys(params: type) -> Mapping[str, str]:
    """Old keys of a parameter class, with the paths of the new ones: its ``RENAMED``, if any."""
    renamed: Mapping[str, str] = getattr(params, "RENAMED", {})
    return renamed


def _sentence(params: type, where: str, mistake: Any, beside: Collection[str]) -> str:
    names = [str(part) for part in mistake["loc"]]
    place = ".".join([where, *names])
    if new := _renamed(params, names):
        return f"{place} is now {new}. Rename it."
    if mistake["type"] in ("unexpected_keyword_argument", "extra_forbidden"):
        known = _names(_class_at(params, names[:-1]))
        return unknown(place, names[-1], {*known, *(beside if len(names) == 1 else ())})
    if mistake["type"] in MISSING:
        return f"{place} is needed. Add {names[-1]} to it."
    if mistake["type"] == "value_error":
        return _placed(where, names, str(mistake["ctx"]["error"]))
    # "Input should be ...", or, of a length, "Tuple should have ... after validation, not 0".
    text = mistake["msg"].partition(" after validation")[0].rstrip(".")
    rule = text[text.find("should ") :] if "should " in text else text
    is_quoted = isinstance(mistake["input"], str) and rule in NUMBERS
    cure = f"Write {NUMBERS[rule]}." if is_quoted else "Correct it."
    return f"{place} {rule}; found {shown(mistake['input'])}. {cure}"


def _placed(where: str, names: list[str], text: str) -> str:
    """Sentence of a parameter class with the path of its table, which it may begin with a part of.

    "damping must ..." of the table boundary.damping.0 of components.water becomes
    "components.water.boundary.damping.0 must ...".
    """
    place = ".".join([where, *names])
    keys = [name for name in names if not name.isdecimal()]
    for first in range(len(keys)):
        head = ".".join(keys[first:])
        if text.startswith((f"{head} ", f"{head}.", f"{head}: ")):
            return f"{place}{text.removeprefix(head)}"
    return f"{place}: {text}"


def unknown(place: str, name: str, known: Iterable[str]) -> str:
    """Say that a name is not known, and which is nearest."""
    known = sorted(known)
    # The search takes the square of the lengths of names: of absurd ones none is near.
    is_short = len(name) <= SHOWN and len(known) <= MOST_NEAR
    near = difflib.get_close_matches(name, known, 1, 0.5) if is_short else []
    place = place if len(place) <= 2 * SHOWN else f"{place[:SHOWN]} ... {place[-SHOWN:]}"
    names = ", ".join(known[:MOST_NEAR]) + (", ..." if len(known) > MOST_NEAR else "")
    hint = f"Did you mean {near[0]}?" if near else f"Known here: {names or 'nothing'}."
    return f"{place} is not known. {hint}"


def _class_at(params: Any, path: list[str]) -> Any:
    """Return a nested parameter class; lists and tables are stepped through."""
    place = params
    for part in path:
        fields = {f.name: f.type for f in dataclasses.fields(place)}
        place = _inner(fields[part]) if part in fields else place
        if not dataclasses.is_dataclass(place):
            return place
    return place


def _names(params: Any) -> list[str]:
    """Names that a parameter class knows; none of what is no parameter class."""
    known = dataclasses.fields(params) if dataclasses.is_dataclass(params) else ()
    return [f.name.rstrip("_") for f in known]


def _inner(annotation: Any) -> Any:
    """Return the parameter class inside a tuple, a table or an optional, or the annotation."""
    for part in get_args(annotation):
        if isinstance(inner := _inner(part), type) and dataclasses.is_dataclass(inner):
            return inner
    return annotation
