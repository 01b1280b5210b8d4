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
    """A frame that was changed in one or a few places."""
    change = [in_bytes, in_bytes, cut, in_header, in_header, in_header, in_arrays, in_arrays, noise]
    return change[random.integers(len(change))](bytearray(frame), random)


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
    made = frame[: random.integers(len(frame) + 1)] + random.bytes(random.integers(40))
    if len(made) > PREFIX.size and random.random() < 0.7:
        struct.pack_into("<Q", made, 8, len(made))
    return made


def noise(frame, random):
    return frame[: random.integers(24)] + bytearray(random.bytes(random.integers(200)))


def in_header(frame, random):
    """Another value, key or order in a header whose checksum is right."""
    header, body = taken_apart(frame)
    for _ in range(random.integers(1, 3)):
        changed(header, random)
    return put_together(header, body)


def changed(value, random):
    """Change something in a table or list, however deep."""
    keys = list(value) if isinstance(value, dict) else list(range(len(value)))
    if not keys:
        return
    key = keys[random.integers(len(keys))]
    inner = value[key]
    if isinstance(inner, (dict, list)) and inner and random.random() < 0.7:
        changed(inner, random)
    elif key == "order":
        value[key] = ORDERS[random.integers(len(ORDERS))]
    elif random.random() < 0.2:
        del value[key]
    elif isinstance(value, dict) and random.random() < 0.1:
        value[f"{key}x"] = value.pop(key)
    else:
        value[key] = deepcopy(ODD[random.integers(len(ODD))])


def in_arrays(frame, random):
    """Another table of arrays: names, types, shapes, with the bytes that they need."""
    header, body = taken_apart(frame)
    table = msgpack.unpackb(header["arrays"])
    for _ in range(random.integers(1, 3)):
        if table and random.random() < 0.8:
            entry = table[random.integers(len(table))]
            whole = isinstance(entry, list) and len(entry) == 3
            match random.integers(5) if whole else 4:
                case 0:
                    entry[0] = str(ODD[random.integers(len(ODD))])
                case 1:
                    entry[1] = sorted(DTYPES)[random.integers(len(DTYPES))]
                case 2:
                    entry[2] = [int(n) for n in random.integers(0, 6, random.integers(6))]
                case 3:
                    table.remove(entry)
                case 4:
                    changed(table, random)
        else:
            table.append(["in.number", "<f8", [5, 3]])
    header["arrays"] = msgpack.packb(table)
    if random.random() < 0.7:
        body = random.bytes(room_of(table)) if random.random() < 0.5 else bytes(room_of(table))
    return put_together(header, body)


def room_of(table):
    """Bytes of the arrays of a table, as far as it makes sense."""
    size = 0
    for entry in table:
        try:
            items = int(np.prod(entry[2]))
            size += aligned(min(1 << 14, max(0, items) * DTYPES[entry[1]].itemsize))
        except (TypeError, ValueError, LookupError, OverflowError):
            continue
    return size


def taken_apart(frame):
    size = PREFIX.unpack_from(frame)[1]
    header = msgpack.unpackb(bytes(frame[PREFIX.size : PREFIX.size + size]))
    return header, frame[aligned(PREFIX.size + size) :]


def put_together(header, body):
    packed = msgpack.packb(header)
    first = aligned(PREFIX.size + len(packed))
    made = bytearray(first + len(body))
    PREFIX.pack_into(made, 0, b"qnt3", len(packed), len(made), zlib.crc32(packed))
    made[PREFIX.size : PREFIX.size + len(packed)] = packed
    made[first:] = body
    return made
