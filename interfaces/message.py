"""One message: a small header and some arrays, to bytes and back.

A frame is a 16-byte prefix, a msgpack header, and each array's bytes, aligned. Nothing is
pickled. Every size, type and shape is checked before a byte of an array is looked at.
"""

import math
import struct
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import msgpack
import numpy as np

from quintet.interfaces.component import Array, Fields
from quintet.interfaces.errors import MessageError

Shapes = Mapping[str, tuple[int, ...]]
Frame = Any  # bytes, a bytearray or an array of bytes: whatever has a buffer

MAGIC = b"qnt1"
PREFIX = struct.Struct("<4sIQ")  # magic, bytes of the header, bytes of the frame
ALIGN = 16
HEADER_LIMIT = 1 << 20  # bytes
DIMENSIONS = 4
BARE = ("failed", "abort")  # orders that replace an expected message and bring no arrays
DTYPES = {name: np.dtype(name) for name in ("<f8", "<f4", "<i8", "<i4", "|i1", "|u1", "|b1")}


@dataclass(slots=True)
class Message:
    """What was said: ``header["order"]`` names it; fields are read-only views."""

    header: dict[str, Any]
    fields: dict[str, Array] = field(default_factory=dict)

    @property
    def order(self) -> str:
        """The verb of the message."""
        return str(self.header.get("order", ""))


def _aligned(offset: int) -> int:
    return -(-offset // ALIGN) * ALIGN


def encode(header: Mapping[str, Any], fields: Fields, scratch: bytearray | None) -> bytearray:
    """Pack a message into one frame; `scratch` is reused when it has the right length."""
    arrays = [(key, np.ascontiguousarray(value)) for key, value in fields.items()]
    for key, array in arrays:
        if array.dtype.str not in DTYPES:
            raise MessageError(
                f"field {key}: its type must be one of {', '.join(DTYPES)}; found "
                f"{array.dtype.str}. Convert it before giving it."
            )
    table = [(key, array.dtype.str, fields[key].shape) for key, array in arrays]
    packed = msgpack.packb({**header, "arrays": table})
    total = _aligned(PREFIX.size + len(packed))
    starts = []
    for _, array in arrays:
        starts.append(total)
        total = _aligned(total + array.nbytes)
    frame = scratch if scratch is not None and len(scratch) == total else bytearray(total)
    PREFIX.pack_into(frame, 0, MAGIC, len(packed), total)
    frame[PREFIX.size : PREFIX.size + len(packed)] = packed
    for (_, array), start in zip(arrays, starts, strict=True):
        if array.size:
            into = np.frombuffer(frame, array.dtype, array.size, start)
            into[:] = array.reshape(-1)
    return frame


def decode(frame: Frame, expected: Shapes | None = None) -> Message:
    """Unpack a frame; with `expected`, its arrays must have just these names and shapes."""
    header = _header(frame)
    table = header.pop("arrays", None)
    entries = [_entry(entry) for entry in table] if isinstance(table, list) else None
    if entries is None:
        raise MessageError(f"a message must list its arrays; found {type(table).__name__}.")
    if expected is not None and header.get("order") not in BARE:
        _compare({key: shape for key, _, shape in entries}, expected)
    offset = _aligned(PREFIX.size + PREFIX.unpack_from(frame)[1])
    message = Message(header)
    for key, dtype, shape in entries:
        count = math.prod(shape)
        end = offset + count * dtype.itemsize
        if end > len(frame):
            raise MessageError(
                f"field {key}: {count} items of {dtype.str} must end within the {len(frame)} "
                f"bytes of the message; they end at {end}."
            )
        if key in message.fields:
            raise MessageError(f"field {key} is listed twice.")
        array = np.frombuffer(frame, dtype, count, offset).reshape(shape)
        array.flags.writeable = False
        message.fields[key] = array
        offset = _aligned(end)
    if offset != len(frame):
        raise MessageError(f"a message of {len(frame)} bytes must be used up; {offset} were.")
    return message


def _header(frame: Frame) -> dict[str, Any]:
    if len(frame) < PREFIX.size:
        raise MessageError(f"a message has at least {PREFIX.size} bytes; found {len(frame)}.")
    magic, size, total = PREFIX.unpack_from(frame)
    if magic != MAGIC:
        raise MessageError(f"a message must begin with {MAGIC!r}; found {magic!r}.")
    if total != len(frame):
        raise MessageError(f"the message says it has {total} bytes; {len(frame)} arrived.")
    if size > min(HEADER_LIMIT, total - PREFIX.size):
        raise MessageError(f"a header of {size} bytes does not fit a message of {total} bytes.")
    try:
        header = msgpack.unpackb(bytes(frame[PREFIX.size : PREFIX.size + size]), raw=False)
    except (ValueError, msgpack.exceptions.UnpackException) as error:
        raise MessageError(f"the header is not valid msgpack: {error}") from error
    if not isinstance(header, dict):
        raise MessageError(f"the header must be a map; found {type(header).__name__}.")
    return header


def _entry(entry: Any) -> tuple[str, np.dtype[Any], tuple[int, ...]]:
    if not (isinstance(entry, list) and len(entry) == 3 and isinstance(entry[0], str)):
        raise MessageError(f"an array is listed as name, type, shape; found {entry!r}.")
    key, name, shape = entry
    if not isinstance(name, str) or name not in DTYPES:
        raise MessageError(f"field {key}: type {name!r} is not one of {', '.join(DTYPES)}.")
    fits = isinstance(shape, list) and len(shape) <= DIMENSIONS
    if not fits or not all(type(n) is int and 0 <= n < 1 << 40 for n in shape):
        raise MessageError(f"field {key}: {shape!r} is not a shape of at most {DIMENSIONS} sizes.")
    return key, DTYPES[name], tuple(shape)


def _compare(found: Shapes, expected: Shapes) -> None:
    if found == expected:
        return
    for key in sorted(set(found) | set(expected)):
        if found.get(key) != expected.get(key):
            raise MessageError(
                f"field {key}: expected {_shape(expected.get(key))}, {_shape(found.get(key))} "
                "arrived. The sender's item count must not change after it was joined."
            )


def _shape(shape: tuple[int, ...] | None) -> str:
    return "nothing" if shape is None else f"shape {shape}"


def finite(array: Array) -> bool:
    """Tell whether every number is finite; one pass over memory when all is well."""
    if array.dtype.kind != "f" or not array.size:
        return True
    flat = array.reshape(-1)
    # A sum of squares is finite unless a number is not, or is so large that its square overflows.
    with np.errstate(over="ignore", invalid="ignore"):
        return bool(math.isfinite(np.dot(flat, flat)) or np.isfinite(flat).all())


def require_finite(fields: Fields, where: str) -> None:
    """Refuse a field with a number that is not finite; name the first."""
    for key, array in fields.items():
        if not finite(array):
            rows = np.atleast_1d(array)
            item = int(np.argmin(np.isfinite(rows.reshape(len(rows), -1)).all(axis=1)))
            raise MessageError(
                f"{where}: every number of {key} must be finite; item {item} is "
                f"{np.array2string(rows[item])}. Reduce the time step, or look at that item."
            )
