"""Keys of a parameter class: meaning and unit, type, range and default, as data.

Meaning and unit stand in the class's docstring, in numpydoc's section of parameters, where the unit
of what has numbers stands in the place of a type (``spacing : m``). Type, range and default are
those of the annotation, and are not repeated.
"""

import inspect
import json
import re
import types
from collections.abc import Mapping
from dataclasses import dataclass, is_dataclass
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import dataclasses
from pydantic.fields import FieldInfo

from quintet.interfaces.params import is_data_file

SECTION = re.compile(r"^(\w[\w ]*)\n-{3,}\n", re.MULTILINE)
WORDS = {  # of one and of many
    bool: ("true or false", "flags"),
    int: ("whole number", "whole numbers"),
    float: ("number", "numbers"),
    str: ("text", "texts"),
}


@dataclass(frozen=True, slots=True)
class Key:
    """One key of a parameter class."""

    name: str
    meaning: str
    unit: str  # of its numbers; "" where it has none
    words: str  # its type: "3 numbers", "list of tables"
    range: str  # "> 0", "0 to 1", "not empty"; "" if any
    default: str  # as TOML has it; "" where the key is needed, "none" where it may be left out
    needed: bool
    numeric: bool  # whether it has numbers of its own
    inner: type | None = None  # parameter class of the tables that it is or holds
    place: Literal["table", "list", "names"] = "table"  # one of these, several, or by name


def keys(params: type) -> list[Key]:
    """Return the keys of a class made by `parameters`, in its order."""
    texts = documented(params)
    fields = fields_of(params)
    return [
        _key(info.alias or name, info, *texts.get(name, ("", ""))) for name, info in fields.items()
    ]


def fields_of(params: type) -> dict[str, FieldInfo]:
    """Return the fields of a parameter class, or of a plain dataclass."""
    pydantic_class = (
        params if hasattr(params, "__pydantic_fields__") else dataclasses.dataclass(params)
    )
    fields: dict[str, FieldInfo] = pydantic_class.__pydantic_fields__
    return fields


def about(params: type) -> str:
    """Return what a class's docstring says before its sections; "" if it has none."""
    text = inspect.cleandoc(params.__dict__.get("__doc__") or "")
    if text.startswith(f"{params.__name__}("):  # made by dataclass where there is none
        return ""
    return SECTION.split(text)[0].strip().replace("``", "`")


def documented(params: type) -> dict[str, tuple[str, str]]:
    """Return unit and meaning of the names in the docstring's section of parameters.

    What a class derives from says that of its own.
    """
    keys: dict[str, tuple[str, str]] = {}
    for base in reversed(params.__mro__[:-1]):
        keys |= _documented(base)
    return keys


def _documented(params: type) -> dict[str, tuple[str, str]]:
    text = inspect.cleandoc(params.__dict__.get("__doc__") or "")
    parts = SECTION.split(text)
    body = dict(zip(parts[1::2], parts[2::2], strict=True)).get("Parameters", "")
    keys = {}
    for entry in re.split(r"\n(?=\S)", body.strip("\n")) if body else ():
        head, _, meaning = entry.partition("\n")
        names, _, unit = head.partition(" : ")
        for name in names.split(","):
            keys[name.strip()] = unit.strip(), " ".join(meaning.split()).replace("``", "`")
    return keys


def _key(name: str, info: FieldInfo, unit: str, meaning: str) -> Key:
    annotation: Any = info.annotation
    if info.metadata:
        annotation = Annotated[annotation, *info.metadata]
    inner, needed = _inner(annotation), info.is_required()
    return Key(
        name=name,
        meaning=meaning,
        unit=unit,
        words=_words(annotation),
        range=", ".join(_bounds(annotation)),
        default="" if needed else _toml(info.get_default(call_default_factory=True)),
        needed=needed,
        numeric=inner is None and _numeric(annotation),
        inner=inner,
        place=_place(annotation),
    )


def _parts(annotation: Any) -> tuple[Any, tuple[Any, ...], list[Any]]:
    """Origin and arguments of an annotation without None in it, and its metadata."""
    metadata: list[Any] = []
    if get_origin(annotation) is Annotated:
        annotation, *metadata = get_args(annotation)
    origin, arguments = get_origin(annotation), get_args(annotation)
    if origin in (Union, types.UnionType):
        left = tuple(part for part in arguments if part is not types.NoneType)
        if len(left) == 1:
            origin, arguments, more = _parts(left[0])
            return origin, arguments, metadata + more
        return Union, left, metadata
    return origin or annotation, arguments, metadata


def _words(annotation: Any, many: bool = False) -> str:
    """Name a type in words."""
    origin, arguments, metadata = _parts(annotation)
    if is_dataclass(origin):
        return "tables" if many else "table"
    if origin is Literal:
        return _either([json.dumps(part) for part in arguments])
    if origin is Union:
        return _either(list(dict.fromkeys(_words(part, many) for part in arguments)))
    if origin is tuple and arguments[-1] is Ellipsis:
        return f"list{'s' * many} of {_words(arguments[0], True)}"
    if origin is tuple:
        return _row(arguments)
    if isinstance(origin, type) and issubclass(origin, Mapping):
        free = len(arguments) < 2 or arguments[1] is Any
        held = "" if free else f" of {_words(arguments[1], True)}"
        return f"table{'s' * many}{held}"
    if any(map(is_data_file, metadata)):
        return "files" if many else "file"
    return WORDS.get(origin, ("any value", "any values"))[many]


def _either(words: list[str]) -> str:
    """Join alternatives: "a, b or c"."""
    return " or ".join([", ".join(words[:-1]), words[-1]] if words[1:] else words)


def _row(arguments: tuple[Any, ...]) -> str:
    """Name a list of fixed length: "3 numbers", "2 × 3 numbers"."""
    held = list(dict.fromkeys(_words(part, True) for part in arguments))
    if len(held) == 1:
        return f"{len(arguments)} {'× ' if held[0][0].isdigit() else ''}{held[0]}"
    return ", ".join(_words(part) for part in arguments)


def _bounds(annotation: Any) -> list[str]:
    """Tell the bounds of what is in an annotation: "> 0", "0 to 1", "not empty"."""
    origin, arguments, metadata = _parts(annotation)
    limits: dict[str, Any] = {}
    for entry in metadata:
        for part in entry.metadata if isinstance(entry, FieldInfo) else [entry]:
            for name in ("gt", "ge", "lt", "le", "min_length"):
                if (bound := getattr(part, name, None)) is not None:
                    limits[name] = bound
    bounds = ["not empty"] if limits.pop("min_length", None) else []
    if limits.keys() == {"ge", "le"}:
        bounds.append(f"{limits['ge']:g} to {limits['le']:g}")
    else:
        signs = {"gt": ">", "ge": "≥", "lt": "<", "le": "≤"}
        bounds += [f"{sign} {limits[name]:g}" for name, sign in signs.items() if name in limits]
    if origin is not Literal and not is_dataclass(origin):
        bounds += [bound for part in arguments if part is not Ellipsis for bound in _bounds(part)]
    return list(dict.fromkeys(bounds))


def _numeric(annotation: Any) -> bool:
    """Whether an annotation has numbers in it."""
    origin, arguments, _ = _parts(annotation)
    if origin is Literal:
        return False
    return origin in (int, float) or any(map(_numeric, arguments))


def _inner(annotation: Any) -> type | None:
    """Return the parameter class of the tables in an annotation."""
    origin, arguments, _ = _parts(annotation)
    if isinstance(origin, type) and is_dataclass(origin):
        return origin
    classes = [inner for part in arguments if origin is not Literal and (inner := _inner(part))]
    return classes[0] if classes else None


def _place(annotation: Any) -> Literal["table", "list", "names"]:
    """How the tables in an annotation are found: one, in a list, or by name."""
    origin, _, _ = _parts(annotation)
    if origin is tuple:
        return "list"
    return "names" if isinstance(origin, type) and issubclass(origin, Mapping) else "table"


def _toml(value: Any) -> str:
    """Write a default as a scene would; "none" of what has no value, "" of a table of defaults."""
    if value is None:
        return "none"
    if is_dataclass(value):
        return ""
    text = json.dumps(value, ensure_ascii=False, default=str)
    return re.sub(r"e([+-])0*(\d)", lambda m: f"e{m[1].strip('+')}{m[2]}", text)
