"""Messages from outside a run reach nobody in it; a component that joins is admitted once."""

import json
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from quintet.interfaces.errors import LineError
from quintet.interfaces.lines import join_secret
from quintet.interfaces.lines.admission import LONGEST_REQUEST, Admission, ask_to_join
from quintet.interfaces.lines.endpoint import free_port
from quintet.interfaces.lines.foreign_messages import TOO_MANY, ForeignMessages
from quintet.interfaces.lines.zenoh import Session, ZenohLine, configuration, connect, join

pytestmark = pytest.mark.zenoh
SECRET = "5ecret"
WHO = {"kind": "toy", "host": "here", "pid": 7}
OLD = "a former run"
KEYS = [
    "quintet/pong/to/coupler", "quintet/coupler/to/pong", "quintet/alive/pong", "quintet/**", "**",
    "*/*/pong/to/coupler", "quintet/*/coupler/to/pong", f"quintet/{SECRET}/pong/to/coupler",
    "quintet/@open/pong/to/coupler", "quintet/@/pong/to/coupler",
]  # fmt: skip


@pytest.fixture
def endpoint():
    return f"tcp/127.0.0.1:{free_port()}"


def admission(session, endpoint, foreign, others=()):
    """Of a run that awaits `pong`."""
    opened = Admission(session.zenoh, {"pong": "toy"}, others, foreign, endpoint)
    opened.await_join("pong", SECRET)
    opened.open()
    return opened


@pytest.fixture
def coupler(endpoint):
    session = Session(endpoint, True, "coupler", None, SECRET)
    session.foreign = ForeignMessages(session.zenoh, session.dropped)
    session.foreign.look()
    session.admission = admission(session, endpoint, session.foreign, ("ping",))
    yield session
    session.close()
    join_secret.remove(endpoint, ["pong"])


@pytest.fixture
def stranger(endpoint, coupler):
    import zenoh

    session = zenoh.open(configuration(endpoint, False, None))
    yield session
    session.close()


def test_strangers_neither_send_nor_overhear(coupler, stranger, endpoint):
    from zenoh import CongestionControl, handlers

    line = ZenohLine(coupler, "r1", "pong")
    pong = connect(endpoint, "pong", None, SECRET)
    line.wait_for_partner(10.0)
    overheard = stranger.declare_subscriber("**", handlers.FifoChannel(100))
    alive = stranger.liveliness().declare_token("quintet/alive/pong")
    time.sleep(0.2)
    for key in KEYS:
        for payload in (b"1234567", b"", bytes(100_000)):
            # Zenoh drops a message on a busy machine unless it is told to wait.
            stranger.put(key, payload, congestion_control=CongestionControl.BLOCK)
    alive.undeclare()
    for n in range(20):
        line.send({"order": "advance", "n": n}, {"a": np.full(3, float(n))})
        message = pong.receive(5.0)
        assert message.header["n"] == n and (message.fields["a"] == n).all()
        pong.send({"order": "done", "n": n}, {})
        assert line.receive(5.0).header["n"] == n
    reports, expected = "", 3 * (len(KEYS) - 4)  # `@...` and `*/*/...` reach nobody
    deadline = time.monotonic() + 10.0
    while coupler.foreign.count < expected and time.monotonic() < deadline:
        reports += coupler.foreign.look()
        time.sleep(0.01)
    assert "from outside the run were dropped; the first: 7 bytes" in reports
    assert coupler.foreign.count >= expected
    keys = [str(sample.key_expr) for sample in iter(overheard.try_recv, None)]
    assert keys and set(keys) <= set(KEYS)
    pong.close()


def test_a_flood_costs_little_and_is_reported_now_and_then(coupler, stranger):
    import zenoh

    reports, began, spent = [], time.monotonic(), time.process_time()
    sent = 0
    block = zenoh.CongestionControl.BLOCK
    while time.monotonic() - began < 1.5:
        for _ in range(1000):
            stranger.put("quintet/pong/to/coupler", b"x" * 50, congestion_control=block)
        sent += 1000
        reports.append(coupler.foreign.look())
    assert sent > 10 * TOO_MANY > coupler.foreign.count / 10
    assert len(list(filter(None, reports))) == 1
    assert "at least" in coupler.foreign.summary()[0]
    assert time.process_time() - spent < 8.0


def test_who_is_awaited_joins_once(coupler, endpoint):
    line = ZenohLine(coupler, "r1", "pong")
    pong = join(endpoint, "pong", WHO)
    pong.send({"order": "hello"}, {})
    assert line.receive(5.0).order == "hello"
    began = time.monotonic()
    with pytest.raises(LineError, match=r"pong has joined already \(process 7 on here\)"):
        join(endpoint, "pong", {**WHO, "pid": 8})
    assert time.monotonic() - began < 3.0
    line.send({"order": "go"}, {})
    assert pong.receive(5.0).order == "go"  # the second one has ended nothing
    assert "1 request(s) to join were refused" in coupler.foreign.look()
    pong.close()


def test_whose_former_process_has_died_joins_with_another_secret(coupler, endpoint):
    former_line = ZenohLine(coupler, "r1", "pong")
    former = join(endpoint, "pong", WHO)
    coupler.admission.await_join("pong", "an0ther")
    line = ZenohLine(coupler.under("an0ther"), "r1", "pong")
    former_line.send({"order": "go"}, {})  # which the former process alone hears
    pong = join(endpoint, "pong", {**WHO, "pid": 8})
    with pytest.raises(LineError, match=r"pong has joined already \(process 8 on here\)"):
        join(endpoint, "pong", WHO)
    former.send({"order": "late"}, {})
    pong.send({"order": "hello"}, {})
    former.close()
    assert line.receive(5.0).order == "hello"
    line.send({"order": "load"}, {})
    assert pong.receive(5.0).order == "load"
    assert line.peek() is None and not line.partner_has_left()
    pong.close()
    limit = time.monotonic() + 5.0
    while not line.partner_has_left():
        assert time.monotonic() < limit
    line.leave()


@pytest.mark.parametrize(
    ("name", "about", "words"),
    [
        ("ping", WHO, "ping is started by the run itself. Start the run with --elsewhere ping"),
        ("peng", WHO, "the run awaits pong, not peng"),
        ("pong", {**WHO, "kind": "fish\x1b[2J\ud800"}, r"pong must be of kind toy; found fish\?\["),
        ("pong", {**WHO, "pid": "x"}, "a request to join must name its kind, host and process"),
    ],
)
def test_who_is_not_awaited_is_refused_with_the_reason(coupler, endpoint, name, about, words):
    with pytest.raises(LineError, match=words):
        join(endpoint, name, about)
    assert coupler.foreign.refused == 1 and not coupler.admission.joined


@pytest.mark.parametrize(
    "request_bytes",
    [b"", b"7654321", b"[" * 4000, b"{}", b"[]", b"null", b'{"kind": 1, "host": 2, "pid": 3}',
     json.dumps({**WHO, "more": "x" * LONGEST_REQUEST}).encode(), b"\xff\xfe"],
)  # fmt: skip
def test_a_malformed_request_is_refused(coupler, stranger, request_bytes):
    for key in ("quintet/join/pong", "quintet/join/*", "quintet/**"):
        replies = list(stranger.get(key, payload=request_bytes, timeout=5.0))
        assert [reply.ok for reply in replies] == [None]
    assert not coupler.admission.joined


def test_where_no_run_answers_a_join_says_so(endpoint, monkeypatch):
    monkeypatch.setattr("quintet.interfaces.lines.admission.ANSWERING", 1.0)
    session = Session(endpoint, True, "coupler", None, SECRET)  # which admits nobody
    with pytest.raises(LineError, match="no run answered within 1 s"):
        join(endpoint, "pong", WHO)
    session.close()


def test_a_component_of_a_former_run_reaches_nobody(coupler, endpoint):
    line = ZenohLine(coupler, "r1", "pong")
    late = Session(endpoint, False, "pong", None, OLD.replace(" ", "-"))
    old = ZenohLine(late, "r0", "coupler")
    for _ in range(5):
        old.send({"order": "done"}, {})
    time.sleep(0.2)
    assert line.peek() is None and line._broken() == ""
    late.close()
    time.sleep(0.1)
    assert line._broken() == ""


def test_a_join_may_begin_before_its_run(endpoint, monkeypatch):
    messages, opened = [], []

    def begin(text):
        messages.append(text)
        session = Session(endpoint, True, "coupler", None, SECRET)
        foreign = ForeignMessages(session.zenoh)
        opened.extend([session, admission(session, endpoint, foreign)])
        opened.append(ZenohLine(session, "r1", "pong"))

    pong = join(endpoint, "pong", WHO, None, begin)
    assert messages == [f"nobody listens at {endpoint} yet; waiting for up to 10 s"]
    pong.close()
    opened[0].close()
    join_secret.remove(endpoint, ["pong"])
    monkeypatch.setattr("quintet.interfaces.lines.zenoh.STARTING", 0.3)
    with pytest.raises(LineError, match="nobody listens on port"):
        join(endpoint, "pong", WHO, None, messages.append)


def test_who_asks_before_the_run_has_begun_is_answered_when_it_has(endpoint):
    session = Session(endpoint, True, "coupler", None, SECRET)
    foreign = ForeignMessages(session.zenoh)
    waiting = Admission(session.zenoh, {"pong": "toy"}, (), foreign, endpoint)
    waiting.await_join("pong", "a new secret")
    with ThreadPoolExecutor() as pool:
        future = pool.submit(ask_to_join, session.zenoh, endpoint, "pong", WHO)
        time.sleep(0.3)
        assert not future.done()
        waiting.open()
        assert future.result(5.0) == "a new secret"
    session.close()
    join_secret.remove(endpoint, ["pong"])
