"""Over TLS a certificate is good for the component that it names, and for nothing else."""

import json
import time

import pytest

from quintet.coupler.launch.certificates import COUPLER, files_of, hosts_of, write_certificates
from quintet.interfaces.errors import LineError
from quintet.interfaces.lines.access import access, common_name
from quintet.interfaces.lines.admission import Admission
from quintet.interfaces.lines.endpoint import Security, free_port
from quintet.interfaces.lines.foreign_messages import ForeignMessages
from quintet.interfaces.lines.frame_codes import topic_of
from quintet.interfaces.lines.zenoh import Session, ZenohLine, configuration, connect, join

pytestmark = pytest.mark.zenoh
SECRETS = {"ping": "5ecret of ping", "pong": "5ecret of pong"}
WHO = {"kind": "toy", "host": "here", "pid": 7}


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    folder = tmp_path_factory.mktemp("tls")
    write_certificates(folder, hosts_of([], [*SECRETS, "third"], ""), 1)
    return lambda name: Security(*files_of(folder, name))


@pytest.fixture
def endpoint():
    return f"tls/localhost:{free_port()}"


@pytest.fixture
def coupler(endpoint, files):
    security = files(COUPLER)
    rights = access(
        common_name(security.certificate),
        {name: [topic_of(text)] for name, text in SECRETS.items()},
    )
    session = Session(endpoint, True, "coupler", security, None, access=rights)
    session.foreign = ForeignMessages(session.zenoh, session.dropped)
    awaited = dict.fromkeys(SECRETS, "toy")
    session.admission = Admission(session.zenoh, awaited, (), session.foreign, endpoint)
    for name, secret in SECRETS.items():
        session.admission.await_join(name, secret)
    session.admission.open()
    session.lines = {
        name: ZenohLine(session.under(secret), "r1", name) for name, secret in SECRETS.items()
    }
    yield session
    session.close()


def test_a_certificate_of_the_component_is_admitted_and_messages_pass(coupler, endpoint, files):
    line = coupler.lines["pong"]
    pong = join(endpoint, "pong", WHO, files("pong"))
    pong.send({"order": "hello"}, {})
    assert line.receive(5.0).order == "hello"
    line.send({"order": "go"}, {})
    assert pong.receive(5.0).order == "go"
    pong.close()
    limit = time.monotonic() + 5.0
    while not line.partner_has_left():
        assert time.monotonic() < limit


@pytest.mark.parametrize("name", ["ping", "third"])
def test_a_certificate_of_another_component_is_refused_with_the_reason(
    coupler, endpoint, files, name
):
    with pytest.raises(LineError) as error:
        join(endpoint, "pong", WHO, files(name))
    reason = (
        f"pong must join with a certificate whose common name is pong; that of process 7 on here "
        f"has {name}. Name its certificate with --tls."
    )
    assert str(error.value) == f"the run refuses it: {reason}"
    assert coupler.foreign.refused == 1 and coupler.foreign.reason == reason
    join(endpoint, "pong", WHO, files("pong")).close()  # the name is still free


def test_a_certificate_of_the_coupler_is_good_for_all(coupler, endpoint, files):
    for name in SECRETS:
        join(endpoint, name, WHO, files(COUPLER)).close()


def test_who_says_that_it_has_another_certificate_is_not_heard(
    coupler, endpoint, files, monkeypatch
):
    import zenoh

    session = zenoh.open(configuration(endpoint, False, files("ping")))
    asking = json.dumps({**WHO, "certificate": "pong"}).encode()
    for key in ("quintet/admit/pong", "quintet/admit/*", "quintet/**"):
        replies = list(session.get(key, payload=asking, timeout=2.0))
        assert [reply.ok for reply in replies] in ([], [None])
    assert not coupler.admission.joined
    session.close()


def test_a_component_neither_hears_nor_disturbs_another_though_it_knows_the_secret(
    coupler, endpoint, files
):
    from zenoh import handlers

    line = coupler.lines["pong"]
    pong = connect(endpoint, "pong", files("pong"), SECRETS["pong"])
    spy = Session(endpoint, False, "pong", files("ping"), SECRETS["pong"])
    overheard = spy.zenoh.declare_subscriber(f"{spy.root}/**", handlers.FifoChannel(100))
    forged = ZenohLine(spy, "r1", "coupler")
    time.sleep(0.2)
    for n in range(5):
        forged.send({"order": "forged"}, {})
        line.send({"order": "advance", "n": n}, {})
        assert pong.receive(5.0).header["n"] == n
        pong.send({"order": "done", "n": n}, {})
        assert line.receive(5.0).header["n"] == n
    heard = [sample.payload.to_bytes() for sample in iter(overheard.try_recv, None)]
    assert not [frame for frame in heard if b"advance" in frame]
    spy.close()
    time.sleep(0.2)
    assert line.peek() is None and not line.partner_has_left()
    assert coupler.dropped.count() == 0  # zenoh drops them before
    pong.close()
