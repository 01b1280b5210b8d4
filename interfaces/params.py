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
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Annotated, Any, dataclass_transform, get_args

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


TAG = re.compile(r"constrained-\w+|(?:literal|tuple|dict)\[.*\]")  # what pydantic adds to a place


@dataclass_transform(kw_only_default=True, frozen_default=True)
def parameters(cls: type) -> Any:
    """Make a class a frozen, validated parameter set; unknown names are refused."""
    config = ConfigDict(extra="forbid", strict=True)
    return dataclass(frozen=True, kw_only=True, config=config)(cls)


def read(
    params: type, given: dict[str, Any], where: str, folder: Path | None = None
) -> tuple[Any, list[str]]:
    """Check settings against a parameter class; return it filled, or None and every mistake.

    Parameters
    ----------
    params : type
        Made by `parameters`.
    given : dict
        The settings, as they stand in a scene.
    where : str
        What the settings are called in sentences.
    folder : Path, by default the working folder
        Where their data files lie.
    """
    try:
        # Strict checking of JSON takes lists for tuples, but no text for numbers.
        text = json.dumps(given)
        context = {"folder": folder or Path()}
        return TypeAdapter(params).validate_json(text, strict=True, context=context), []
    except ValidationError as error:
        found = _by_place(error.errors())
        return None, [_sentence(params, where, one) for one in _without_old(params, found)]
    except (TypeError, ValueError) as error:
        return None, [f"{where}: {error}. Use numbers, text, lists and tables only."]


def _by_place(mistakes: Iterable[Any]) -> list[dict[str, Any]]:
    """One mistake for each place; where a value may be of several kinds, their rules joined."""
    found: dict[tuple[Any, ...], dict[str, Any]] = {}
    for one in mistakes:
        place = tuple(part for part in one["loc"] if not TAG.fullmatch(str(part)))
        if place in found:
            found[place]["msg"] += " or " + one["msg"].removeprefix("Input should be ")
        else:
            found[place] = {**one, "loc": place}
    return list(found.values())


def _without_old(params: type, mistakes: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """All but keys said to be missing that are there under their old names."""
    there = {
        (*one["loc"][:-1], *new.split("."))
        for one in mistakes
        if (new := _renamed(params, [str(part) for part in one["loc"]]))
    }
    gone = ("missing", "missing_argument")
    return [one for one in mistakes if one["loc"] not in there or one["type"] not in gone]


def _renamed(params: type, names: list[str]) -> str:
    """Path of what the key at the end of these names is called now; "" if it keeps its name."""
    *heads, last = names or [""]
    return str(getattr(_class_at(params, heads), "RENAMED", {}).get(last, ""))


def _sentence(params: type, where: str, mistake: Any) -> str:
    names = [str(part) for part in mistake["loc"]]
    place = ".".join([where, *names])
    if new := _renamed(params, names):
        return f"{place} is now {new}. Rename it."
    if mistake["type"] in ("unexpected_keyword_argument", "extra_forbidden"):
        return unknown(place, names[-1], _names(_class_at(params, names[:-1])))
    if mistake["type"] in ("missing", "missing_argument"):
        return f"{place} is needed. Add {names[-1]} to it."
    if mistake["type"] == "value_error":
        return f"{where}: {mistake['ctx']['error']}"
    rule = mistake["msg"].removeprefix("Input ").rstrip(".")
    return f"{place} {rule}; found {mistake['input']!r}. Correct it."


def unknown(place: str, name: str, known: Iterable[str]) -> str:
    """Say that a name is not known, and which is nearest."""
    known = sorted(known)
    near = difflib.get_close_matches(name, known, 1, 0.5)
    hint = f"Did you mean {near[0]}?" if near else f"Known here: {', '.join(known) or 'nothing'}."
    return f"{place} is not known. {hint}"


def _class_at(params: Any, path: list[str]) -> Any:
    """Return a nested parameter class; lists and tables are stepped through."""
    found = params
    for part in path:
        fields = {f.name: f.type for f in dataclasses.fields(found)}
        found = _inner(fields[part]) if part in fields else found
        if not dataclasses.is_dataclass(found):
            return found
    return found


def _names(params: Any) -> list[str]:
    """Names that a parameter class knows; none of what is no parameter class."""
    known = dataclasses.fields(params) if dataclasses.is_dataclass(params) else ()
    return [f.name.rstrip("_") for f in known]


def _inner(annotation: Any) -> Any:
    """Return the parameter class inside a tuple, a table or an optional, or the annotation."""
    for part in get_args(annotation):
        if dataclasses.is_dataclass(_inner(part)):
            return _inner(part)
    return annotation
