"""Lines over zenoh: the same bytes, nothing lost, no strangers."""

import socket
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from quintet.interfaces.errors import LineError
from quintet.interfaces.lines.endpoint import Security, check_endpoint
from quintet.interfaces.lines.memory import MemoryLine

pytestmark = pytest.mark.zenoh
PAUSE = 8.0  # s, longer than zenoh's own settings keep a blocked connection

SENDER = """
import sys
import numpy as np
from quintet.interfaces.lines.zenoh import connect
line = connect(sys.argv[1], "sender")
line.run = "r1"
array = np.zeros((200, 3))
for n in range(int(sys.argv[2])):
    array[0, 0] = n
    line.send({"order": "data"}, {"a": array})
line.send({"order": "end"}, {})
line.receive(60.0)
line.close()
"""


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


@pytest.fixture
def hubs():
    from quintet.interfaces.lines.zenoh import Session

    opened = []

    def open_two(endpoint, security=None):
        opened.append(Session(endpoint, True, "coupler", security))
        opened.append(Session(endpoint, False, "water", security))
        return opened

    yield open_two
    for session in opened:
        session.close()


def lines(hubs, endpoint, security=None):
    from quintet.interfaces.lines.zenoh import ZenohLine

    coupler, water = hubs(endpoint, security)
    coupler_line, water_line = ZenohLine(coupler, "r1", "water"), ZenohLine(water, "", "coupler")
    for line in (coupler_line, water_line):
        line.wait_for_partner(10.0)
    return coupler_line, water_line


def test_memory_and_zenoh_carry_the_same_bytes(hubs):
    coupler_line, water_line = lines(hubs, f"tcp/127.0.0.1:{free_port()}")
    memory, carried = MemoryLine("r1", "coupler"), []
    put = memory._put
    memory._put = lambda frame: carried.append(bytes(frame)) or put(frame)
    random = np.random.default_rng(0)
    for size in (0, 1, 1000, 200_000):
        fields = {"surface.position": random.random((size, 3)), "n": np.arange(size)}
        for line in (memory, coupler_line):
            line.send({"order": "advance", "window": size}, fields)
        frame = None
        while frame is None:
            frame = water_line._poll()
        assert bytes(frame) == carried[-1]


def test_a_partner_that_leaves_is_noticed_at_once(hubs):
    coupler_line, water_line = lines(hubs, f"tcp/127.0.0.1:{free_port()}")
    water_line.send({"order": "last words"}, {})
    time.sleep(0.1)
    water_line.session.close()
    began = time.perf_counter()
    assert coupler_line.receive(30.0).order == "last words"
    with pytest.raises(LineError, match="water is gone"):
        coupler_line.receive(30.0)
    assert time.perf_counter() - began < 10.0  # by itself zenoh misses a partner after 60 s


@pytest.mark.slow
def test_nothing_is_lost_while_a_receiver_pauses():
    from quintet.interfaces.lines.zenoh import Session, ZenohLine

    count = 10_000
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    session = Session(endpoint, True, "coupler", None)
    line = ZenohLine(session, "r1", "sender")
    arguments = [sys.executable, "-c", SENDER, endpoint, str(count)]
    with subprocess.Popen(arguments) as sender:
        line.wait_for_partner(20.0)
        for n in range(count):
            if n == count // 2:
                time.sleep(PAUSE)
            assert line.receive(20.0).fields["a"][0, 0] == n
        assert line.receive(20.0).order == "end"
        line.send({"order": "well done"}, {})
        assert sender.wait(20) == 0
    session.close()


ALLOWED = ["tcp/127.0.0.1:7447", "tcp/localhost:1", "tcp/[::1]:7447"]
OFF_LOOPBACK = [
    "tcp/0.0.0.0:7447", "tcp/192.168.1.2:7447", "tcp/example.org:7447", "tcp/[::]:7447",
    "tcp/127.0.0.1.example.org:7447",
]  # fmt: skip
MALFORMED = [
    "", "tcp", "tcp/", "tcp/127.0.0.1", "udp/127.0.0.1:7447", "quic/127.0.0.1:7447",
    "127.0.0.1:7447", "tcp/127.0.0.1:7447,tcp/0.0.0.0:7447", "tcp/0.0.0.0@127.0.0.1:7447",
    "tcp/127.0.0.1:7447#iface=eth0",
]  # fmt: skip
FILES = Security("ca.pem", "me.pem", "me.key")


@pytest.mark.parametrize("endpoint", ALLOWED)
def test_the_loopback_needs_no_certificates(endpoint):
    check_endpoint(endpoint, None)


@pytest.mark.parametrize("security", [None, FILES], ids=["plain", "with files"])
@pytest.mark.parametrize("endpoint", OFF_LOOPBACK)
def test_off_the_loopback_plain_connections_are_refused(endpoint, security):
    with pytest.raises(LineError) as error:
        check_endpoint(endpoint, security)
    assert str(error.value) == (
        f"endpoint {endpoint!r}: off the loopback only tls with certificates on both sides is "
        "allowed. Use tls/HOST:PORT and give authority, certificate and key."
    )


@pytest.mark.parametrize("endpoint", MALFORMED)
def test_what_is_no_endpoint_is_refused(endpoint):
    with pytest.raises(LineError, match=r"must be tcp/HOST:PORT on the loopback or tls/HOST:PORT"):
        check_endpoint(endpoint, FILES)


def test_tls_needs_certificates():
    check_endpoint("tls/example.org:7447", FILES)
    with pytest.raises(LineError, match="tls needs authority, certificate and key"):
        check_endpoint("tls/example.org:7447", None)


def test_messages_cross_mutual_tls(hubs, certificates):
    coupler_line, water_line = lines(hubs, f"tls/localhost:{free_port()}", certificates[0])
    coupler_line.send({"order": "advance"}, {"a": np.arange(3.0)})
    assert (water_line.receive(5.0).fields["a"] == np.arange(3.0)).all()
    water_line.send({"order": "done"}, {})
    assert coupler_line.receive(5.0).order == "done"


@pytest.mark.parametrize("stranger", ["no certificate", "a foreign certificate", "plain tcp"])
def test_strangers_are_refused(certificates, stranger):
    import json

    import zenoh

    from quintet.interfaces.lines.zenoh import Session, configuration

    ours, foreign = certificates
    port = free_port()
    session = Session(f"tls/localhost:{port}", True, "coupler", ours)
    endpoint = f"tcp/localhost:{port}" if stranger == "plain tcp" else f"tls/localhost:{port}"
    files = {"no certificate": ours, "a foreign certificate": foreign, "plain tcp": None}[stranger]
    config = configuration(endpoint, False, files)
    config.insert_json5("connect/timeout_ms", "700")
    if files:
        tls = {"root_ca_certificate": ours.authority, "verify_name_on_connect": True}
        if stranger == "a foreign certificate":
            pair = {"connect_certificate": files.certificate, "connect_private_key": files.key}
            tls |= {"enable_mtls": True, **pair}
        config.insert_json5("transport/link/tls", json.dumps(tls))
    with pytest.raises(zenoh.ZError):
        zenoh.open(config)
    session.update()
    assert session.alive <= {"coupler"}
    session.close()


def test_nobody_there_is_said(monkeypatch):
    from quintet.interfaces.lines import zenoh as ours

    plain = ours.configuration

    def hasty(*arguments):
        config = plain(*arguments)
        config.insert_json5("connect/timeout_ms", "300")
        return config

    monkeypatch.setattr(ours, "configuration", hasty)
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    with pytest.raises(LineError, match=f"endpoint {endpoint}: water cannot reach it"):
        ours.connect(endpoint, "water")


def test_zenoh_is_imported_only_where_it_is_used():
    code = "import quintet.interfaces.serving.process, sys; sys.exit('zenoh' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], cwd=Path.home()).returncode == 0
