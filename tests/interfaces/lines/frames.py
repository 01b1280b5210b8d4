"""Frames of the wire protocol, changed at random in their bytes or in their meaning."""

import struct
import zlib
from copy import deepcopy

import msgpack
import numpy as np

from quintet.interfaces.lines.layout import DTYPES, aligned
from quintet.interfaces.lines.message import PREFIX

ODD = [
    None, True, False, -1, 0, 1, 2**31, 2**62, 2**63 - 1, 0.0, -0.0, 1e300, 5e-324, float("nan"),
    float("inf"), float("-inf"), "", "x", "out.number", "in.push", "\x00", "x" * 5000, b"", b"\xff",
    [], [[]], [[[]]], ["x"], [1, 2], [["a", "b", "c"]], [["out.push", "in.number", "x"]], {},
    {"x": 1}, {"in": [[0, 99]]}, {"": []}, {"out.push": [0.0]}, [1.0] * 40,
    msgpack.ExtType(5, b"x"), msgpack.Timestamp(1), ["in.number"] * 400,
]  # fmt: skip
ORDERS = (
    "describe bind give prime advance keep rewind save load view finish done failed abort".split()
)


def mutated(frame, random):
    """Return a frame with one or a few changes."""
    edits = [in_bytes, in_bytes, cut, in_header, in_header, in_header, in_arrays, in_arrays, noise]
    return edits[random.integers(len(edits))](bytearray(frame), random)


def in_bytes(frame, random):
    for _ in range(random.integers(1, 6)):
        place = random.integers(len(frame) if random.random() < 0.5 else min(96, len(frame)))
        frame[place] = (
            random.integers(256)
            if random.random() < 0.5
            else frame[place] ^ (1 << random.integers(8))
        )
    return frame


def cut(frame, random):
    shortened = frame[: random.integers(len(frame) + 1)] + random.bytes(random.integers(40))
    if len(shortened) > PREFIX.size and random.random() < 0.7:
        struct.pack_into("<Q", shortened, 8, len(shortened))
    return shortened


def noise(frame, random):
    return frame[: random.integers(24)] + bytearray(random.bytes(random.integers(200)))


def in_header(frame, random):
    """Another value, key or order in a header whose checksum is right."""
    header, body = header_and_body(frame)
    for _ in range(random.integers(1, 3)):
        change_value(header, random)
    return frame_of(header, body)


def change_value(value, random):
    """Change one value in a table or list, at any depth."""
    keys = list(value) if isinstance(value, dict) else list(range(len(value)))
    if not keys:
        return
    key = keys[random.integers(len(keys))]
    inner = value[key]
    if isinstance(inner, (dict, list)) and inner and random.random() < 0.7:
        change_value(inner, random)
    elif key == "order":
        value[key] = ORDERS[random.integers(len(ORDERS))]
    elif random.random() < 0.2:
        del value[key]
    elif isinstance(value, dict) and random.random() < 0.1:
        value[f"{key}x"] = value.pop(key)
    else:
        value[key] = deepcopy(ODD[random.integers(len(ODD))])


def in_arrays(frame, random):
    """Another table of arrays: names, types, shapes; the body may have the bytes they need."""
    header, body = header_and_body(frame)
    table = msgpack.unpackb(header["arrays"])
    for _ in range(random.integers(1, 3)):
        if table and random.random() < 0.8:
            entry = table[random.integers(len(table))]
            is_complete = isinstance(entry, list) and len(entry) == 3
            match random.integers(5) if is_complete else 4:
                case 0:
                    entry[0] = str(ODD[random.integers(len(ODD))])
                case 1:
                    entry[1] = sorted(DTYPES)[random.integers(len(DTYPES))]
                case 2:
                    entry[2] = [int(n) for n in random.integers(0, 6, random.integers(6))]
                case 3:
                    table.remove(entry)
                case 4:
                    change_value(table, random)
        else:
            table.append(["in.number", "<f8", [5, 3]])
    header["arrays"] = msgpack.packb(table)
    if random.random() < 0.7:
        body = random.bytes(room_of(table)) if random.random() < 0.5 else bytes(room_of(table))
    return frame_of(header, body)


def room_of(table):
    """Bytes of the arrays of a table; entries that are malformed need none."""
    size = 0
    for entry in table:
        try:
            items = int(np.prod(entry[2]))
            size += aligned(min(1 << 14, max(0, items) * DTYPES[entry[1]].itemsize))
        except (TypeError, ValueError, LookupError, OverflowError):
            continue
    return size


def header_and_body(frame):
    size = PREFIX.unpack_from(frame)[1]
    header = msgpack.unpackb(bytes(frame[PREFIX.size : PREFIX.size + size]))
    return header, frame[aligned(PREFIX.size + size) :]


def frame_of(header, body):
    packed = msgpack.packb(header)
    start = aligned(PREFIX.size + len(packed))
    frame = bytearray(start + len(body))
    PREFIX.pack_into(frame, 0, b"qnt3", len(packed), len(frame), zlib.crc32(packed))
    frame[PREFIX.size : PREFIX.size + len(packed)] = packed
    frame[start:] = body
    return frame
