"""Frames changed at random end a line in a sentence: no traceback, no hang, little memory."""

import resource
import time
import warnings
from functools import partial

import numpy as np
import pytest
from frames import header_and_body, in_header, mutated
from started import write_scene

from quintet.coupler.coupling.group import assemble
from quintet.coupler.coupling.judgement.checks import Judgement
from quintet.coupler.coupling.ledger import Ledger
from quintet.coupler.launch.connect import InMemory
from quintet.coupler.run.loop import run
from quintet.coupler.scene.read import load
from quintet.interfaces.errors import MessageError, QuintetError
from quintet.interfaces.lines.endpoint import free_port
from quintet.interfaces.lines.memory import MemoryLine
from quintet.interfaces.lines.message import decode, encode, header_of
from quintet.interfaces.lines.zenoh import Session, ZenohLine
from quintet.interfaces.serving.process import build
from quintet.interfaces.serving.serve import Server, answer

FEW, MANY = 1_500, 250_000
COUNTS = [FEW, pytest.param(MANY, marks=pytest.mark.full)]
LONGEST = 5.0  # s for one frame, on a machine under load
MEMORY = 200e6  # bytes that all of them may need
TOY = "items = 5\nsubsteps = 3"


class Silent:
    """Lets a run pass."""

    def warn(self, text): ...

    def plan(self, windows): ...

    def begin(self, coupling, described): ...

    def due(self, ticks):
        return True

    def end_window(self, coupling):
        for component in coupling.components.values():
            component.call("view")

    def wants_end(self):
        return False


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    return load(str(write_scene(tmp_path_factory.mktemp("scene"), end=0.003, ping=TOY, pong=TOY)))


class Unwatched:
    """Watches nobody: a thread for each of thousands of runs would take all the time."""

    def add(self, *_): ...

    def close(self): ...


def run_of(scene, tap=lambda line: None):
    """Run a scene in memory, with its lines tapped; return the lines."""
    connection = InMemory(scene, Unwatched())
    lines = [component.line for component in connection.participants.values()]
    for line in lines:
        tap(line)
    exchange = scene.exchange()
    coupling = assemble(scene.coupling, connection.participants, exchange, Ledger(exchange))
    run(
        coupling,
        scene.file.end,
        Silent(),
        scene.asked_outputs(),
        Judgement(coupling.ledger.accounts),
    )
    for component in connection.participants.values():
        state = component.save()
        component.order_keep(0)
        component.receive()
        component.order_rewind(0)
        component.receive()
        component.load(state, component.window)
        component.call("finish")
    return lines


@pytest.fixture(scope="module")
def sent(scene):
    """All frames of a run: orders to `pong`, and the answers of both components."""
    orders, answers = [], []

    def tap(line):
        put, answered = line._put, line.far._put
        line._put = lambda frame: (orders.append((line.name, bytes(frame))), put(frame))
        line.far._put = lambda frame: (answers.append(bytes(frame)), answered(frame))

    run_of(scene, tap)
    assert len(orders) == len(answers) > 20
    return [frame for name, frame in orders if name == "pong"], answers


@pytest.fixture(autouse=True)
def little_memory():
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    yield
    assert 1024 * (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - peak) < MEMORY


@pytest.fixture(autouse=True)
def numbers_that_overflow():
    """Allow warnings of overflow, as the numbers may be absurd."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        yield


@pytest.mark.parametrize("count", COUNTS)
def test_the_decoder_refuses_what_is_no_message(sent, count):
    random, refused = np.random.default_rng(11), 0
    frames = [*sent[0], *sent[1]]
    for _ in range(count):
        bad = mutated(frames[random.integers(len(frames))], random)
        try:
            decode(bad)
        except QuintetError as error:
            refused += 1
            assert len(str(error)) < 3000
    assert 0.3 * count < refused < count


@pytest.mark.parametrize("count", COUNTS)
def test_a_component_answers_every_order_in_a_sentence(scene, sent, count):
    random, ended = np.random.default_rng(12), 0
    orders = sent[0]
    for _ in range(count):
        line = MemoryLine("", "pong")
        server = Server(build(scene.components["pong"].manifest, GO), "pong")
        index = random.integers(len(orders))
        began = time.monotonic()
        for number, frame in enumerate(orders[: index + 1]):
            line.far.inbox.append(mutated(frame, random) if number == index else frame)
            try:
                goes_on = answer(server, line.far, line.far.receive(0.0))
            except QuintetError:
                goes_on = False
                continue
            header = decode(line.far.outbox.pop()).header
            assert header["order"] == "done" or not header["traceback"], header["traceback"]
        ended += not goes_on
        assert time.monotonic() - began < LONGEST
    assert ended > 0.5 * count


@pytest.mark.parametrize("count", COUNTS)
def test_a_component_is_built_from_nothing_else_than_its_parameters(scene, count):
    random, refused = np.random.default_rng(14), 0
    go = encode({"order": "go", **GO, "params": {}, "folder": "/none"}, {}, None)
    for _ in range(count // 4):
        header, _ = header_and_body(in_header(go, random))
        try:
            build(scene.components["pong"].manifest, header)
        except QuintetError as error:
            refused += 1
            assert len(str(error)) < 1 << 14
    assert refused > 0.1 * count


def is_old(frame, received):
    """Whether a frame has the number of a message that was received before."""
    try:
        return header_of(frame).get("seq") in range(received)
    except MessageError:
        return False


@pytest.mark.zenoh
@pytest.mark.parametrize("count", [200, pytest.param(20_000, marks=pytest.mark.full)])
def test_a_live_endpoint_refuses_them_alike(sent, count):
    """Frames with right codes, as of a component that is faulty."""
    random, refused = np.random.default_rng(15), 0
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    ours = Session(endpoint, True, "coupler", None)
    line = ZenohLine(ours, "", "pong")
    pong = ZenohLine(Session(endpoint, False, "pong", None), "", "coupler", True)
    pong.wait_for_partner(10.0)
    for _ in range(count):
        frame = mutated(sent[1][random.integers(len(sent[1]))], random)
        if is_old(frame, line._received):  # it would be dropped without a word
            refused += 1
            continue
        pong._put(bytearray(frame) + bytes(pong.room))
        try:
            line.receive(30.0)
        except QuintetError as error:
            refused += 1
            assert "nothing arrived" not in str(error)
    pong.close()
    ours.close()
    assert refused > 0.9 * count


@pytest.mark.zenoh
@pytest.mark.parametrize("count", [500, pytest.param(20_000, marks=pytest.mark.full)])
def test_a_live_endpoint_drops_frames_that_are_forged_damaged_or_repeated(sent, count):
    random, repeated = np.random.default_rng(16), 0
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    ours = Session(endpoint, True, "coupler", None)
    line = ZenohLine(ours, "", "pong")
    pong = ZenohLine(Session(endpoint, False, "pong", None), "", "coupler", True)
    pong.wait_for_partner(10.0)
    publish = pong._publish
    for n in range(count):
        forged = mutated(sent[1][random.integers(len(sent[1]))], random)
        publish(bytearray(forged) + random.bytes(random.integers(40)))
        if n % 50 == 0:
            copies = []
            pong._publish = lambda frame, copies=copies: copies.append(bytearray(frame))
            pong.send({"order": "done", "n": n}, {})
            for frame in (*copies, *copies):
                publish(frame)
            assert line.receive(30.0).header["n"] == n
            repeated += 1
    deadline = time.monotonic() + 30.0
    while ours.dropped.count() < count + repeated and time.monotonic() < deadline:
        assert line.peek() is None
    assert (ours.dropped.invalid, ours.dropped.repeated) == (count, repeated)
    pong.close()
    ours.close()


GO = {"params": {"items": 5, "substeps": 3}, "threads": 1}


class Changing:
    """Changes one of the answers that components send."""

    def __init__(self, index, random):
        self.index, self.random, self.count = index, random, 0

    def tap(self, line):
        line.far._put = partial(self.put, line.far._put)

    def put(self, answered, frame):
        answered(mutated(frame, self.random) if self.count == self.index else frame)
        self.count += 1


@pytest.mark.parametrize("count", COUNTS)
def test_the_coupler_meets_every_answer_in_a_sentence(scene, sent, count):
    random, ended, count = np.random.default_rng(13), 0, count // 20
    for _ in range(count):
        index = random.integers(len(sent[1]))
        began = time.monotonic()
        try:
            run_of(scene, Changing(index, random).tap)
        except QuintetError as error:
            ended += 1
            assert len(str(error)) < 1 << 17
        assert time.monotonic() - began < LONGEST
    assert ended > 0.1 * count
