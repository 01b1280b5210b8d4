"""Layout of the arrays in a message: names, types, shapes and offsets, packed and unpacked.

A run sends the same arrays window after window. So their table is packed by itself, and both
sides derive the layout from it, and check it, once.
"""

import functools
import math
import reprlib
from collections.abc import Mapping
from typing import Any, NamedTuple

import msgpack
import numpy as np

from quintet.interfaces.errors import MessageError

Shape = tuple[int, ...]
Shapes = Mapping[str, Shape]

ALIGN = 16
DIMENSIONS = 4
DTYPES = {name: np.dtype(name) for name in ("<f8", "<f4", "<i8", "<i4", "|i1", "|u1", "|b1")}
CACHED = 64  # layouts
MOST = 1000  # arrays in a message
LONGEST = 1000  # characters of a field's name


class Place(NamedTuple):
    """One array of a message: name, type, shape, and its bytes counted from the first array."""

    key: str
    dtype: np.dtype[Any]
    shape: Shape
    numbers: int
    start: int  # bytes
    end: int


class Layout(NamedTuple):
    """All arrays of a message."""

    places: tuple[Place, ...]
    size: int  # bytes, with what aligns the end
    shapes: dict[str, Shape]
    packed: bytes


def aligned(offset: int) -> int:
    """Round an offset up to the alignment of arrays."""
    return -(-offset // ALIGN) * ALIGN


@functools.lru_cache(CACHED)
def lay_out(arrays: tuple[tuple[str, np.dtype[Any], Shape], ...]) -> Layout:
    """Lay out arrays of these names, types and shapes one after the other."""
    table = tuple((key, dtype.str, shape) for key, dtype, shape in arrays)
    for key, name, _ in table:
        if name not in DTYPES:
            raise MessageError(
                f"field {key}: its type must be one of {', '.join(DTYPES)}; found {name}. "
                "Convert it before giving it."
            )
    return _place(table, msgpack.packb(table))


@functools.lru_cache(CACHED)
def read_layout(packed: bytes) -> Layout:
    """Decode the table of a received message; all of it is checked."""
    try:
        table = msgpack.unpackb(packed, raw=False)
    except (ValueError, msgpack.exceptions.UnpackException) as error:
        raise MessageError(f"the list of arrays is not valid msgpack: {error}") from error
    if not isinstance(table, list):
        raise MessageError(f"a message must list its arrays; found {type(table).__name__}.")
    if len(table) > MOST:
        raise MessageError(f"a message lists at most {MOST} arrays; found {len(table)}.")
    entries = tuple(_entry(entry) for entry in table)
    seen: set[str] = set()
    for key, _, _ in entries:
        if key in seen:
            raise MessageError(f"field {key} is listed twice.")
        seen.add(key)
    return _place(entries, packed)


def _place(table: tuple[tuple[str, str, Shape], ...], packed: bytes) -> Layout:
    places, offset = [], 0
    for key, name, shape in table:
        numbers = math.prod(shape)
        end = offset + numbers * DTYPES[name].itemsize
        places.append(Place(key, DTYPES[name], shape, numbers, offset, end))
        offset = aligned(end)
    return Layout(tuple(places), offset, {key: shape for key, _, shape in table}, packed)


def _entry(entry: Any) -> tuple[str, str, Shape]:
    if not (isinstance(entry, list) and len(entry) == 3 and isinstance(entry[0], str)):
        raise MessageError(f"an array is listed as name, type, shape; found {reprlib.repr(entry)}.")
    key, name, shape = entry
    if len(key) > LONGEST:
        raise MessageError(f"a field's name has at most {LONGEST} characters; found {len(key)}.")
    if not isinstance(name, str) or name not in DTYPES:
        text = reprlib.repr(name)
        raise MessageError(f"field {key}: type {text} is not one of {', '.join(DTYPES)}.")
    fits = isinstance(shape, list) and len(shape) <= DIMENSIONS
    fits = fits and all(type(n) is int and 0 <= n < 1 << 40 for n in shape)
    # numpy makes no array of such sizes, though one of them is 0 and it holds nothing.
    if not fits or (0 in shape and math.prod(n or 1 for n in shape) >= 1 << 56):
        text = reprlib.repr(shape)
        raise MessageError(f"field {key}: {text} is not a shape of at most {DIMENSIONS} sizes.")
    return key, name, tuple(shape)
