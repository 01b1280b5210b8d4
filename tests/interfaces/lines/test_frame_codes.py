"""A frame is accepted once, in its place, and only as its sender wrote it."""

import numpy as np
import pytest
from frames import mutated

from quintet.interfaces.lines.frame_codes import CODE, DroppedFrames, FrameCodes, topic_of
from quintet.interfaces.lines.message import encode

SECRET = "5ecret"
FEW, MANY = 3_000, 1_000_000


def codes(secret=SECRET, sender="pong", receiver="coupler"):
    return FrameCodes(secret, sender, receiver)


def sealed(sender, number=0):
    """A frame with its code, as it goes over a line."""
    fields = {"out.number": np.full((5, 3), float(number))}
    frame = encode({"order": "done", "n": number}, fields, None, room=CODE.size)
    sender.add(frame)
    return bytes(frame)


def test_frames_are_opened_as_they_were():
    sender, receiver, dropped = codes(), codes(), DroppedFrames()
    for number in range(20):
        frame = sealed(sender, number)
        assert receiver.open(frame, dropped) == frame[: -CODE.size]
    assert dropped.count() == 0 and dropped.summary() == []


@pytest.mark.parametrize(
    "sender", [codes("an0ther"), codes(sender="ping"), codes(sender="coupler", receiver="pong")]
)
def test_codes_of_another_secret_component_or_direction_are_dropped(sender):
    dropped = DroppedFrames()
    assert codes().open(sealed(sender), dropped) is None
    assert dropped.invalid == 1


def test_a_repeated_frame_is_dropped_and_the_next_is_accepted():
    sender, receiver, dropped = codes(), codes(), DroppedFrames()
    first, second = sealed(sender, 0), sealed(sender, 1)
    assert receiver.open(first, dropped) is not None
    assert receiver.open(first, dropped) is None
    assert receiver.open(second, dropped) is not None
    assert receiver.open(first, dropped) is None
    assert (dropped.invalid, dropped.repeated) == (0, 2)
    assert "2 message(s) on keys of the run arrived a second time" in dropped.summary()[0]


def test_a_frame_that_is_sent_again_after_it_was_lost_is_accepted():
    sender, receiver, dropped = codes(), codes(), DroppedFrames()
    lost = sealed(sender)
    assert receiver.open(sealed(sender), dropped) is not None
    assert receiver.open(lost, dropped) is None
    assert (dropped.invalid, dropped.repeated) == (0, 1)


def test_every_flipped_bit_is_noticed():
    frame = sealed(codes())
    receiver, dropped = codes(), DroppedFrames()
    for number in range(8 * len(frame)):
        changed = bytearray(frame)
        changed[number // 8] ^= 1 << number % 8
        assert receiver.open(bytes(changed), dropped) is None
    assert dropped.invalid == 8 * len(frame)
    assert receiver.open(frame, dropped) is not None


def test_drops_are_told_now_and_then():
    reports = []
    dropped = DroppedFrames(tell=reports.append)
    for _ in range(100):
        assert codes().open(b"1234567", dropped) is None
        dropped.report()
    assert reports == [
        "1 message(s) on keys of the run had no valid authentication code and were dropped: they "
        "were damaged on the way, or another program sent them."
    ]


def test_the_secret_is_in_no_key():
    assert SECRET not in topic_of(SECRET) and topic_of(SECRET) != topic_of("an0ther")


@pytest.mark.parametrize("count", [FEW, pytest.param(MANY, marks=pytest.mark.full)])
def test_mutated_frames_are_dropped(count):
    random, receiver, dropped = np.random.default_rng(21), codes(), DroppedFrames()
    frame = sealed(codes())
    end = len(frame) - CODE.size
    dropping = 0
    for _ in range(count):
        code = bytearray(frame[end:])
        if random.random() < 0.3:
            code[random.integers(CODE.size)] ^= 1 << random.integers(8)
        changed = bytes(mutated(frame[:end], random)) + bytes(code)
        if changed == frame:
            continue
        dropping += 1
        assert receiver.open(changed, dropped) is None
    assert dropped.invalid == dropping > 0.9 * count
    assert receiver.open(frame, dropped) is not None
