"""A message is decoded as it was encoded; other bytes are refused."""

import zlib

import msgpack
import numpy as np
import pytest

from quintet.interfaces.errors import MessageError
from quintet.interfaces.lines.layout import ALIGN, DTYPES
from quintet.interfaces.lines.message import PREFIX, decode, encode, require_finite


def frame(arrays, body=b"", header=None, **prefix):
    """A frame by hand, with errors on request."""
    usual = {"order": "x", "arrays": msgpack.packb(arrays)}
    packed = msgpack.packb(usual if header is None else header)
    start = -(-(PREFIX.size + len(packed)) // ALIGN) * ALIGN
    total = start + len(body)
    buffer = bytearray(total)
    magic, size = prefix.get("magic", b"qnt3"), prefix.get("size", len(packed))
    checksum = zlib.crc32(packed[:size])
    PREFIX.pack_into(buffer, 0, magic, size, prefix.get("total", total), checksum)
    buffer[PREFIX.size : PREFIX.size + len(packed)] = packed
    buffer[start:] = body
    return buffer


@pytest.mark.parametrize("name", sorted(DTYPES))
@pytest.mark.parametrize("shape", [(5,), (5, 3), (2, 3, 4), (0,), (0, 3), (4, 0), (1, 1, 1, 1), ()])
def test_every_type_and_shape_comes_back_bit_for_bit(name, shape):
    random = np.random.default_rng(3)
    array = random.integers(0, 2, shape).astype(name)
    if array.dtype.kind == "f":
        array = array * np.asarray(random.random(shape), name)
    message = decode(encode({"order": "x"}, {"a.b": array, "z": np.arange(3.0)}, None))
    assert message.fields["a.b"].dtype == array.dtype and message.fields["a.b"].shape == shape
    assert message.fields["a.b"].tobytes() == array.tobytes()
    assert (message.fields["z"] == np.arange(3.0)).all()


@pytest.mark.parametrize(
    "array",
    [
        np.arange(24.0).reshape(4, 6)[:, ::2],
        np.arange(24.0).reshape(4, 6).T,
        np.arange(10.0)[::-1],
        np.broadcast_to(np.float64(2.5), (3, 3)),
    ],
)
def test_arrays_that_are_not_contiguous_come_back(array):
    decoded = decode(encode({}, {"a": array}, None)).fields["a"]
    assert decoded.shape == array.shape and (decoded == array).all()


def test_a_header_comes_back_and_arrays_are_read_only():
    header = {"order": "advance", "dt": 0.1, "window": 3, "list": [1, "two", None, True]}
    message = decode(encode(header, {"a": np.zeros(3)}, None))
    assert message.header == header and message.order == "advance"
    with pytest.raises(ValueError, match="read-only"):
        message.fields["a"][0] = 1.0


@pytest.mark.parametrize(
    "kind",
    [
        bytes,
        bytearray,
        lambda frame: memoryview(bytes(frame)),
        lambda frame: memoryview(frame).toreadonly(),
        lambda frame: np.frombuffer(frame, np.uint8),
    ],
)
def test_no_array_of_a_message_can_be_made_writable(kind):
    array = decode(kind(encode({}, {"a": np.zeros(3)}, None))).fields["a"]
    with pytest.raises(ValueError, match="WRITEABLE"):
        array.setflags(write=True)


def test_a_frame_keeps_its_size_while_arrays_of_its_message_live():
    packed = encode({}, {"a": np.zeros(3)}, None)
    message = decode(packed)
    with pytest.raises(BufferError):
        packed.extend(b"more")
    del message
    packed.extend(b"more")


def test_every_array_is_aligned_and_frames_are_used_again():
    fields = {f"f{n}": np.arange(n, dtype="|u1") for n in (1, 7, 16, 17)}
    encoded = encode({"order": "x"}, fields, None)
    message = decode(encoded)
    base = np.frombuffer(encoded, np.uint8).ctypes.data
    for array in message.fields.values():
        assert (array.ctypes.data - base) % ALIGN == 0
    del message, array
    assert encode({"order": "x"}, fields, encoded) is encoded
    assert encode({"order": "longer " * 9}, fields, encoded) is not encoded


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"", "at least 20 bytes; found 0"),
        (b"qnt1" * 3, "at least 20 bytes; found 12"),
        (frame([], magic=b"pick"), "must begin with"),
        (frame([])[:-1], "bytes; "),
        (frame([]) + b"\0", "arrived"),
        (frame([], size=1 << 30), "does not fit"),
        (frame([], size=200), "does not fit"),
        (frame([], size=3), "msgpack"),
        (frame(None, header=[1, 2]), "must be a map; found list"),
        (frame(None, header={"order": "x"}), "must list its arrays; found NoneType"),
        (frame(None, header={"order": "x", "arrays": "abc"}), "must list its arrays; found str"),
        (frame(None, header={"order": "x", "arrays": b"\x93"}), "arrays is not valid msgpack"),
        (frame("abc"), "must list its arrays; found str"),
        (frame(["abc"]), "listed as name, type, shape"),
        (frame([["a", "<f8"]]), "listed as name, type, shape"),
        (frame([[1, "<f8", [1]]]), "listed as name, type, shape"),
        (frame([["a", "|O", [1]]], b"\0" * 16), "type '|O' is not one of"),
        (frame([["a", ">f8", [2]]], b"\0" * 16), "type '>f8' is not one of"),
        (frame([["a", ["<f8"], [2]]], b"\0" * 16), "is not one of"),
        (frame([["a", "<f8", [-2]]], b"\0" * 16), "is not a shape"),
        (frame([["a", "<f8", [1 << 40]]]), "is not a shape"),
        (frame([["a", "<f8", [1 << 39, 1 << 39, 1 << 39]]]), "must end within"),
        (frame([["a", "<f8", [0, 1 << 39, 1 << 39, 1 << 39]]]), "is not a shape"),
        (frame([["a", "<f8", [1, 1, 1, 1, 1]]]), "is not a shape of at most 4"),
        (frame([["a", "<f8", [2.0]]], b"\0" * 16), "is not a shape"),
        (frame([["a", "<f8", [True]]], b"\0" * 16), "is not a shape"),
        (frame([["a", "<f8", 2]], b"\0" * 16), "is not a shape"),
        (frame([["a", "<f8", [3]]], b"\0" * 16), "must end within"),
        (frame([["a", "<f8", [2]]], b"\0" * 32), "must be used up"),
        (frame([["a", "<f8", [2]], ["a", "<f8", [2]]], b"\0" * 32), "listed twice"),
        (frame([[f"a{n}", "<f8", [0]] for n in range(1001)]), "at most 1000 arrays; found 1001"),
    ],
)
def test_what_is_no_message_is_refused(data, words):
    with pytest.raises(MessageError) as error:
        decode(data)
    assert words in str(error.value)


@pytest.mark.parametrize(
    "array", [np.array([{}, None]), np.zeros(2, ">f8"), np.zeros(2, "c16"), np.array(["text"])]
)
def test_types_that_may_not_cross_are_refused_by_the_sender(array):
    with pytest.raises(MessageError, match=r"field f: its type must be one of .* Convert it"):
        encode({}, {"f": array}, None)


def test_another_shape_than_expected_is_refused_and_a_failure_is_not():
    encoded = encode({"order": "done"}, {"f": np.zeros((4, 3))}, None)
    assert decode(encoded, {"f": (4, 3)}).fields["f"].shape == (4, 3)
    with pytest.raises(MessageError, match=r"field f: expected shape \(5, 3\), shape \(4, 3\)"):
        decode(encoded, {"f": (5, 3)})
    with pytest.raises(MessageError, match=r"field g: expected shape \(1,\), nothing arrived"):
        decode(encoded, {"f": (4, 3), "g": (1,)})
    with pytest.raises(MessageError, match="field f: expected nothing"):
        decode(encoded, {})
    assert decode(encode({"order": "failed"}, {}, None), {"f": (4, 3)}).order == "failed"


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_a_number_that_is_not_finite_is_refused_with_its_item(bad):
    array = np.ones((6, 3))
    array[4, 1] = bad
    with pytest.raises(MessageError, match=r"here: every number of f must be finite; item 4 is \["):
        require_finite({"e": np.ones(2), "f": array}, "here")
    with pytest.raises(MessageError, match="item 0 is"):
        require_finite({"f": np.array(bad)}, "a single number")


def test_large_numbers_whose_squares_overflow_are_finite():
    require_finite({"f": np.full((3, 3), 1e300), "g": np.full(2, -1e200)}, "")
    require_finite({"f": np.full((3, 3), 3e38, "<f4"), "i": np.arange(3)}, "")
    require_finite({"e": np.zeros((0, 3))}, "")


def test_a_header_that_no_receiver_takes_is_not_sent():
    header = {"order": "go", "threads": 1, "params": {"positions": 200_000 * [0.1]}}
    with pytest.raises(MessageError, match=r"header of order go must have .*, the most .* params"):
        encode(header, {}, None)
