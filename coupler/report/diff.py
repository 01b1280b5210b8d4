"""The first difference between two recordings: window, component, field and item, bit for bit.

Fields that both recordings have are compared; fields that only one of them has are listed.
"""

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal

import numpy as np

from quintet.coupler.files.recording import BATCH, Recording
from quintet.interfaces.component import Array, Fields, Port

Value = float | str


@dataclass(frozen=True, slots=True)
class Difference:
    """The first difference between two recordings.

    ``kind`` says what: a port, something static, the number of items, the number of windows, the
    time of a window, a value, or, where all that both have is the same, names of fields.
    """

    kind: Literal["names", "ports", "static", "items", "windows", "time", "value"]
    component: str
    field: str  # "port.field", or ""
    window: int  # 0 is the start
    time: float  # s, of that window in the first recording
    item: int
    index: tuple[int, ...]  # within the item: (axis,) of a vector
    a: Value
    b: Value
    shared: int = 0  # fields that both have, of different names


def compare(a: Path, b: Path) -> Difference | None:
    """Compare two recordings bit for bit, so that -0.0 is not 0.0 and NaN is itself.

    Parameters
    ----------
    a, b : Path
        Recordings, or the folders of their runs.

    Returns
    -------
    Difference or None
        The earliest one of the fields that both have, or, where there is none, that one of them
        has other fields; None when all is the same. What is laid out differently comes before what
        has different values; different lengths come last.
    """
    with Recording(a) as first, Recording(b) as other:
        return next(_differences(first, other), None)


def only_in_one(a: Path, b: Path) -> tuple[list[str], list[str]]:
    """``component.port.field`` of what only the first, and only the second recording has."""
    with Recording(a) as first, Recording(b) as other:
        return _lacking(first, other)


def _lacking(first: Recording, other: Recording) -> tuple[list[str], list[str]]:
    """Fields, and components without any, that only one of two recordings has."""
    names = [
        {
            *(f"{name}.{field}" for name in recording.names for field in recording.fields(name)),
            *(name for name in recording.names if not recording.fields(name)),
        }
        for recording in (first, other)
    ]
    return sorted(names[0] - names[1]), sorted(names[1] - names[0])


def _differences(first: Recording, other: Recording) -> Iterator[Difference]:
    both = [name for name in first.names if name in other.names]
    for name in both:
        yield from _layouts(first, other, name)
    yield from _values(first, other, both)
    for name in both:
        lengths = [len(recording.times(name)) for recording in (first, other)]
        if lengths[0] != lengths[1]:
            yield _plain("windows", name, "", f"{lengths[0]} rows", f"{lengths[1]} rows")
    lacking = _lacking(first, other)
    if any(lacking):
        shared = sum(len(_shared(first, other, name)) for name in both)
        names = (", ".join(names) or "no other" for names in lacking)
        yield replace(_plain("names", "", "", *names), shared=shared)


def _plain(
    kind: Literal["names", "ports", "static", "items", "windows"],
    component: str,
    field: str,
    a: Value,
    b: Value,
) -> Difference:
    return Difference(kind, component, field, 0, 0.0, 0, (), a, b)


def _shared(first: Recording, other: Recording, name: str) -> list[str]:
    """Fields of a component that both recordings have, in the order of the first."""
    return [field for field in first.fields(name) if field in other.fields(name)]


def _layouts(first: Recording, other: Recording, name: str) -> Iterator[Difference]:
    """Compare ports, but for the fields that only one of them has, and what they say once."""
    fields = _shared(first, other, name)
    ports, others = ({p.name: p for p in recording.ports(name)} for recording in (first, other))
    both = [port for port in ports if port in others]
    for port in both:
        shown = [_with_fields(of[port], fields) for of in (ports, others)]
        if shown[0] != shown[1]:
            yield _plain("ports", name, port, *map(repr, shown))
    statics, theirs = (
        {key: array for key, array in of.static(name).items() if key.partition(".")[0] in both}
        for of in (first, other)
    )
    yield from _statics(name, statics, theirs)
    for field in fields:
        shapes = [recording.items(name, field) for recording in (first, other)]
        if shapes[0] != shapes[1]:
            yield _plain("items", name, field, f"shape {shapes[0]}", f"shape {shapes[1]}")


def _with_fields(port: Port, names: Collection[str]) -> Port:
    """A port with some of its fields alone, and without what other settings would add."""
    fields = tuple(field for field in port.fields if f"{port.name}.{field.name}" in names)
    return replace(port, fields=fields, lacks=())


def _statics(name: str, statics: Fields, other: Fields) -> Iterator[Difference]:
    for key in sorted(statics.keys() | other.keys()):
        arrays = [static.get(key, np.zeros(0)) for static in (statics, other)]
        shapes = [f"{array.dtype} of shape {array.shape}" for array in arrays]
        if shapes[0] != shapes[1]:
            yield _plain("static", name, key, *shapes)
        elif (place := _first(*arrays)) is not None:
            a, b = (float(array[place]) for array in arrays)
            item, index = (place[0], place[1:]) if place else (0, ())
            yield Difference("static", name, key, 0, 0.0, item, index, a, b)


def _values(first: Recording, other: Recording, names: Sequence[str]) -> Iterator[Difference]:
    """Yield the first different value, comparing blocks of rows of components that both have."""
    rows = {name: min(len(first.times(name)), len(other.times(name))) for name in names}
    for start in range(0, max(rows.values(), default=0), BATCH):
        differences = []
        for name in names:
            part = slice(start, min(start + BATCH, rows[name]))
            differences += [*_times(first, other, name, part), *_fields(first, other, name, part)]
        if differences:  # the first of the earliest window, in the order of the recording
            yield min(differences, key=lambda difference: difference.window)


def _times(first: Recording, other: Recording, name: str, part: slice) -> Iterator[Difference]:
    arrays = [recording.ticks(name)[part] * recording.tick for recording in (first, other)]
    if (place := _first(*arrays)) is not None:
        a, b = (float(array[place]) for array in arrays)
        yield Difference("time", name, "", part.start + place[0], a, 0, (), a, b)


def _fields(first: Recording, other: Recording, name: str, part: slice) -> Iterator[Difference]:
    for field in _shared(first, other, name):
        arrays = [recording.field(name, field, part) for recording in (first, other)]
        if (place := _first(*arrays)) is not None:
            window = part.start + place[0]
            time = float(first.times(name)[window])
            a, b = (float(array[place]) for array in arrays)
            yield Difference("value", name, field, window, time, place[1], place[2:], a, b)


def _first(a: Array, b: Array) -> tuple[int, ...] | None:
    """Index of the first number whose bits differ; None if there is none."""
    whole = np.dtype(f"u{a.dtype.itemsize}")
    unequal = np.ascontiguousarray(a).view(whole) != np.ascontiguousarray(b).view(whole)
    if not unequal.any():
        return None
    place = np.unravel_index(int(np.argmax(unequal)), unequal.shape)
    return tuple(int(i) for i in place)[: a.ndim]


def sentence(difference: Difference | None) -> str:
    """Describe a difference in one sentence."""
    if difference is None:
        return "The recordings are the same, bit for bit."
    d = difference
    if d.kind == "names":
        only = f"only the first has {d.a}, only the second has {d.b}"
        same = f"The {d.shared} fields that both recordings have are the same, bit for bit"
        return f"{same if d.shared else 'The recordings have no field in common'}; {only}."
    where = ".".join(part for part in (d.component, d.field) if part)
    if d.kind == "value" or (d.kind == "static" and not isinstance(d.a, str)):
        when = "static" if d.kind == "static" else f"window {d.window} (t = {d.time:g} s)"
        place = f"item {d.item}" + "".join(f"[{i}]" for i in d.index)
        return f"{when}: {where}, {place}: {_exact(d.a)} against {_exact(d.b)}."
    if d.kind == "time":
        return f"window {d.window}: {where} is at {d.a!r} s against {d.b!r} s."
    text = "the same until one ends" if d.kind == "windows" else f"different {d.kind}"
    return f"{where or 'the recordings'}: {text}: {d.a} against {d.b}."


def _exact(value: Value) -> str:
    """A number in its shortest exact decimal form, and in hexadecimal."""
    return value if isinstance(value, str) else f"{value!r} ({value.hex()})"
