"""Messages: a header and arrays, encoded to bytes and decoded.

A frame is a prefix, a msgpack header with the table of the arrays packed by itself, and each
array's bytes, aligned. Nothing is pickled. The header has a checksum; every size, type and shape
is checked before a byte of an array is looked at.
"""

import struct
import zlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import msgpack
import numpy as np

from quintet.interfaces.component import Array, Fields
from quintet.interfaces.errors import MessageError
from quintet.interfaces.lines.layout import Layout, Shapes, aligned, lay_out, read_layout
from quintet.interfaces.sums import finite

Frame = Any  # bytes, a bytearray or an array of bytes: whatever has a buffer

MAGIC = b"qnt3"
PREFIX = struct.Struct("<4sIQI")  # magic, bytes of the header, bytes of the frame, CRC-32 of header
PACKER = msgpack.Packer()  # making one takes longer than packing a header
HEADER_LIMIT = 1 << 20  # bytes
UNLIMITED = 1 << 62  # bytes
WITHOUT_ARRAYS = ("failed", "unable", "abort")  # that may replace an expected message


@dataclass(slots=True)
class Message:
    """A message: ``header["order"]`` names it; fields are read-only views."""

    header: dict[str, Any]
    fields: dict[str, Array] = field(default_factory=dict)
    order: str = field(init=False)  # name of the order or answer

    def __post_init__(self) -> None:
        self.order = str(self.header.get("order", ""))


def encode(
    header: Mapping[str, Any],
    fields: Fields,
    scratch: bytearray | None,
    limit: int = UNLIMITED,
    room: int = 0,
    **stamp: Any,
) -> bytearray:
    """Pack a message into one frame; `scratch` is reused when it has the right length.

    A frame of more than `limit` bytes is refused before any memory is taken for it. `room` bytes
    are left free behind it. `stamp` has what the line adds to the header.
    """
    try:
        layout = lay_out(tuple([(key, a.dtype, a.shape) for key, a in fields.items()]))
    except AttributeError:
        _refuse_no_array(fields)
        raise
    packed = PACKER.pack({**header, **stamp, "arrays": layout.packed})
    if len(packed) > HEADER_LIMIT:
        _refuse_header(header, len(packed))
    first = aligned(PREFIX.size + len(packed))
    total = first + layout.size
    if total > limit:
        _refuse_large(layout, total, limit)
    size = total + room
    frame = scratch if scratch is not None and len(scratch) == size else bytearray(size)
    PREFIX.pack_into(frame, 0, MAGIC, len(packed), total, zlib.crc32(packed))
    frame[PREFIX.size : PREFIX.size + len(packed)] = packed
    for place, array in zip(layout.places, fields.values(), strict=True):
        np.ndarray(place.shape, place.dtype, frame, first + place.start)[...] = array
    return frame


def decode(frame: Frame, expected: Shapes | None = None) -> Message:
    """Unpack a frame; with `expected`, its arrays must have just these names and shapes."""
    header, first = _header(frame)
    packed = header.pop("arrays", None)
    if not isinstance(packed, bytes):
        raise MessageError(f"a message must list its arrays; found {type(packed).__name__}.")
    layout = read_layout(packed)
    if expected is not None and header.get("order") not in WITHOUT_ARRAYS:
        _compare(layout.shapes, expected)
    if first + layout.size != len(frame):
        _refuse_size(layout, len(frame) - first)
    buffer = _read_only(frame)
    return Message(
        header,
        {
            key: np.ndarray(shape, dtype, buffer, first + start)
            for key, dtype, shape, _, start, _ in layout.places
        },
    )


def _read_only(frame: Frame) -> Frame:
    """Buffer for arrays that stay read-only, whatever flag of them is set; it holds the frame."""
    if type(frame) is memoryview and type(frame.obj) is bytes:
        return frame
    return np.frombuffer(memoryview(frame).toreadonly(), np.uint8)


def order_of(frame: Frame) -> str:
    """Order or answer that a message carries."""
    return str(header_of(frame).get("order"))


def header_of(frame: Frame) -> dict[str, Any]:
    """Header of a message, checked."""
    return _header(frame)[0]


def _header(frame: Frame) -> tuple[dict[str, Any], int]:
    """Decode the header; return it with the offset of the first array."""
    if len(frame) < PREFIX.size:
        raise MessageError(f"a message has at least {PREFIX.size} bytes; found {len(frame)}.")
    magic, size, total, checksum = PREFIX.unpack_from(frame)
    if magic != MAGIC:
        raise MessageError(f"a message must begin with {MAGIC!r}; found {magic!r}.")
    if total != len(frame):
        raise MessageError(f"the message says it has {total} bytes; {len(frame)} arrived.")
    if size > HEADER_LIMIT or size > total - PREFIX.size:
        raise MessageError(f"a header of {size} bytes does not fit a message of {total} bytes.")
    text = frame[PREFIX.size : PREFIX.size + size]
    if zlib.crc32(text) != checksum:
        raise MessageError("the header is not as it was sent: its checksum differs.")
    try:
        header = msgpack.unpackb(text)
    except (ValueError, msgpack.exceptions.UnpackException) as error:
        raise MessageError(f"the header is not valid msgpack: {error}") from error
    if not isinstance(header, dict):
        raise MessageError(f"the header must be a map; found {type(header).__name__}.")
    return header, aligned(PREFIX.size + size)


def _refuse_no_array(fields: Fields) -> None:
    for key, array in fields.items():
        if not isinstance(array, np.ndarray):
            raise MessageError(
                f"field {key}: it must be an array of numbers; found {type(array).__name__}. "
                "Correct what gives it."
            )


def _refuse_header(header: Mapping[str, Any], size: int) -> None:
    largest = max(header, key=lambda key: len(PACKER.pack(header[key])), default="arrays")
    raise MessageError(
        f"the header of order {header.get('order')} must have at most {HEADER_LIMIT} bytes; this "
        f"one has {size}, the most of them in {largest}. Shorten it, or give it as a file."
    )


def _refuse_large(layout: Layout, total: int, limit: int) -> None:
    largest = max(layout.places, key=lambda place: place.end - place.start)
    raise MessageError(
        f"a message must have at most {limit / 1e9:.2f} GB on this line; this one has "
        f"{total / 1e9:.2f} GB, the most of it {largest.key} with shape {largest.shape}. Use "
        "fewer items, or the transport mpi or memory."
    )


def _refuse_size(layout: Layout, room: int) -> None:
    for place in layout.places:
        if place.end > room:
            raise MessageError(
                f"field {place.key}: {place.numbers} numbers of {place.dtype.str} must end within "
                f"the {room} bytes of arrays of the message; they end at {place.end}."
            )
    raise MessageError(f"{room} bytes of arrays must be used up; {layout.size} were.")


def _compare(shapes: Shapes, expected: Shapes) -> None:
    if shapes == expected:
        return
    for key in sorted(set(shapes) | set(expected)):
        if shapes.get(key) != expected.get(key):
            raise MessageError(
                f"field {key}: expected {_shape(expected.get(key))}, {_shape(shapes.get(key))} "
                "arrived. The sender's item count must not change after it was joined."
            )


def _shape(shape: tuple[int, ...] | None) -> str:
    return "nothing" if shape is None else f"shape {shape}"


def require_finite(fields: Fields, where: str) -> None:
    """Refuse fields with numbers that are not finite; name the first such item."""
    for key, array in fields.items():
        if not finite(array):
            rows = np.atleast_1d(array)
            item = int(np.argmin(np.isfinite(rows.reshape(len(rows), -1)).all(axis=1)))
            raise MessageError(
                f"{where}: every number of {key} must be finite; item {item} is "
                f"{np.array2string(rows[item])}. Reduce the time step, or look at that item."
            )
