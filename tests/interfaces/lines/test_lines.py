"""A line loses nothing, mixes nothing up, and keeps its deadline."""

import time

import numpy as np
import pytest

from quintet.interfaces.errors import LineError, MessageError
from quintet.interfaces.lines.memory import MemoryLine
from quintet.interfaces.lines.message import encode
from quintet.interfaces.lines.transport import FramedLine, wait
from quintet.interfaces.serving.serve import answer


class ByHand(FramedLine):
    """A line that receives the frames that a test appends."""

    def __init__(self, run="r1", cause=""):
        super().__init__(run, "coupler")
        self.frames, self.sent, self.cause = [], [], cause

    def lay(self, seq, run="r1", **header):
        self.frames.append(encode({"order": "done", "seq": seq, "run": run, **header}, {}, None))

    def _put(self, frame):
        self.sent.append(bytes(frame))

    def _poll(self):
        return self.frames.pop(0) if self.frames else None

    def _broken(self):
        return self.cause

    def close(self):
        pass


def test_messages_in_order_are_received():
    line = ByHand()
    for seq in range(5):
        line.lay(seq, n=seq)
    assert [line.receive(0.1).header["n"] for _ in range(5)] == [0, 1, 2, 3, 4]


@pytest.mark.parametrize("seq", [3, -2, None, "2"])
def test_a_gap_is_refused(seq):
    line = ByHand()
    line.lay(0)
    line.lay(1)
    line.lay(seq)
    line.receive(0.1)
    line.receive(0.1)
    with pytest.raises(
        LineError, match=f"message 2 was expected, message {seq!r} arrived: messages"
    ):
        line.receive(0.1)


@pytest.mark.parametrize("repeated", [0, 1])
def test_a_message_that_arrives_twice_is_used_once(repeated):
    line = ByHand()
    for seq in (0, 1, repeated, 2):
        line.lay(seq, n=seq)
    assert [line.receive(0.1).header["n"] for _ in range(3)] == [0, 1, 2]
    assert not line.sent


def test_a_message_that_arrives_twice_is_neither_looked_at_nor_measured_by_what_is_expected():
    line, shapes = ByHand(), {"x": (3,)}
    frame = encode({"order": "done", "seq": 1, "run": "r1"}, {"x": np.zeros(3)}, None)
    line.lay(0)
    line.receive(0.1)
    line.lay(0)
    assert line.peek() is None
    line.lay(0)
    line.frames.append(frame)
    assert line.receive(0.1, shapes).fields["x"].shape == (3,)


def test_an_order_without_an_answer_is_sent_again_ever_more_rarely():
    line = ByHand()
    line.repeat_after = 0.1
    line.send({"order": "advance"}, {"x": np.arange(3.0)})
    with pytest.raises(LineError, match="nothing arrived"):
        line.receive(1.0)
    assert len(line.sent) == 4  # after 0, 0.1, 0.3 and 0.7 s
    assert len(set(line.sent)) == 1


def test_a_component_answers_again_the_order_that_it_has_answered():
    line = ByHand("")
    line.answers_again = True
    line.lay(0)
    line.lay(1)
    line.receive(0.1)
    line.receive(0.1)
    line.send({"order": "done"}, {})
    for seq in (0, 1, 2):  # 0: long past, nobody waits for its answer
        line.lay(seq)
    assert line.receive(0.1).header["seq"] == 2
    assert len(line.sent) == 2 and line.sent[0] == line.sent[1]


def test_a_message_of_another_run_is_refused():
    line = ByHand("r1")
    line.lay(0, "r1")
    line.lay(1, "r2")
    line.receive(0.1)
    with pytest.raises(LineError, match="a message of run 'r2' arrived in run 'r1'"):
        line.receive(0.1)


def test_a_component_learns_the_run_from_the_first_message_and_keeps_to_it():
    line = ByHand("")
    line.lay(0, "r7")
    line.lay(1, "r8")
    line.receive(0.1)
    assert line.run == "r7"
    with pytest.raises(LineError, match="of run 'r8' arrived in run 'r7'"):
        line.receive(0.1)


def test_bytes_that_are_no_message_are_refused():
    line = ByHand()
    line.frames.append(b"not a message at all")
    with pytest.raises(MessageError):
        line.receive(0.1)


@pytest.mark.parametrize("seconds", [0.0, 0.05, 0.3])
def test_the_deadline_is_kept(seconds):
    began = time.perf_counter()
    with pytest.raises(LineError, match=f"nothing arrived within {seconds:.1f} s"):
        ByHand().receive(seconds)
    assert seconds <= time.perf_counter() - began < seconds + 5.0  # on a loaded machine


def test_a_broken_line_says_why_before_the_deadline():
    line = ByHand(cause="pong is gone")
    began = time.perf_counter()
    with pytest.raises(LineError, match="pong is gone"):
        line.receive(60.0)
    assert time.perf_counter() - began < 20.0
    line.watch = lambda: "process 7 was killed by signal 9"  # who knows more is believed
    with pytest.raises(LineError, match="process 7 was killed"):
        line.receive(60.0)


def test_what_was_sent_before_the_break_still_arrives():
    inbox = []

    def broken():
        inbox.append("last words")  # came while nobody looked
        return "gone"

    assert wait(lambda: inbox.pop() if inbox else None, 1.0, broken) == "last words"


def test_a_wait_gives_the_processor_away():
    began = time.process_time()
    with pytest.raises(LineError):
        ByHand().receive(1.0)
    assert time.process_time() - began < 0.25


def test_every_message_says_run_and_number():
    line = ByHand("r1")
    for _ in range(2):
        line.send({"order": "advance", "seq": 99, "run": "forged"}, {})
    receiver = ByHand("r1")
    receiver.frames = list(line.sent)
    for seq in range(2):
        header = receiver.receive(0.1).header
        assert (header["seq"], header["run"]) == (seq, "r1")


def test_a_line_in_memory_hands_over_at_once():
    line = MemoryLine("r1", "echo")

    def answer(message):
        line.far.send({"order": "done", "got": message.order}, message.fields)

    line.handle = answer
    for order in ("describe", "bind"):
        line.send({"order": order}, {})
        assert line.receive(0.0).header["got"] == order
    with pytest.raises(LineError, match="the component gave no answer"):
        line.receive(1.0)


def test_a_message_that_is_too_large_is_refused_before_memory_is_taken_for_it():
    line = ByHand()
    line.limit = 1 << 30
    huge = np.broadcast_to(0.0, (1 << 37, 3))
    with pytest.raises(MessageError, match=r"at most 1\.07 GB .* out\.number with shape \(137438"):
        line.send({"order": "done"}, {"few": np.zeros(3), "out.number": huge})
    line.send({"order": "done"}, {"few": np.zeros(3)})
    assert len(line.sent) == 1  # and numbered 0: nothing was lost
    receiver = ByHand()
    receiver.frames = list(line.sent)
    assert receiver.receive(0.1).header["seq"] == 0


def test_what_is_no_array_is_named():
    for value, words in ((None, "found NoneType"), (3.0, "found float")):
        with pytest.raises(MessageError, match=f"field x: it must be an array .* {words}"):
            ByHand().send({"order": "done"}, {"n": np.zeros(3), "x": value})


def test_an_answer_that_cannot_be_sent_is_the_failure_of_its_component(capsys):
    line = MemoryLine("r1", "echo")
    line.far.limit = 1 << 20

    class Large:
        is_alone = True

        def handle(self, message):
            return {}, {"state": np.zeros(1 << 20)}

    line.handle = lambda message: answer(Large(), line.far, message)
    line.send({"order": "save"}, {})
    failed = line.receive(0.0)
    assert failed.order == "failed" and failed.header["error"] == "MessageError"
    assert "the most of it state" in failed.header["text"]
