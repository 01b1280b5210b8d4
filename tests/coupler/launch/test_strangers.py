"""A run goes on whatever other programs send to its endpoint, and reports the dropped messages."""

import json
import re
import socket
import subprocess
import sys
import time

import pytest
from started import Started, same, write_scene

from quintet.interfaces.lines.endpoint import free_port

pytestmark = pytest.mark.zenoh
STRANGER = """
import json, sys, time
import zenoh
config = zenoh.Config()
for key, value in {"mode": "peer", "scouting/multicast/enabled": False,
                   "connect/endpoints": [sys.argv[1]], "listen/endpoints": []}.items():
    config.insert_json5(key, json.dumps(value))
session = zenoh.open(config)
heard = []
session.declare_subscriber("**", lambda sample: heard.append(str(sample.key_expr)))
names = ("ping", "pong")
tokens = [session.liveliness().declare_token(f"quintet/alive/{n}") for n in (*names, "coupler")]
for n in range(100):
    for name in names:
        session.put(f"quintet/{name}/to/coupler", b"7654321")
        session.put(f"quintet/coupler/to/{name}", bytes(n))
    session.put("quintet/**", b"x" * 10_000)
    time.sleep(0.002)
for token in tokens:
    token.undeclare()
print(json.dumps(sorted(set(heard))))
session.close()
"""


def wait_for_endpoint(port, seconds=30.0):
    """Wait until a run listens."""
    limit = time.monotonic() + seconds
    while True:
        with socket.socket() as probe:
            if probe.connect_ex(("127.0.0.1", port)) == 0:
                return
        assert time.monotonic() < limit
        time.sleep(0.02)


def strangers(port):
    """Run another program that sends messages of all kinds; return the messages it overheard."""
    command = [sys.executable, "-c", STRANGER, f"tcp/127.0.0.1:{port}"]
    result = subprocess.run(command, capture_output=True, text=True, timeout=60, check=True)
    return json.loads(result.stdout)


def begin_run(folder, port, *arguments):
    folder.mkdir()
    scene = write_scene(folder, "zenoh", 0.5, ping="pause = 0.01")
    run = Started(scene, "--set", f'endpoint="tcp/127.0.0.1:{port}"', *arguments)
    wait_for_endpoint(port)
    return run, scene


def join(scene, name, port):
    """Try to join a run by hand; return the status, the output, and the time it took."""
    command = [sys.executable, "-m", "quintet.coupler.cli", "join", str(scene), name]
    command += ["--at", f"tcp/127.0.0.1:{port}"]
    start = time.monotonic()
    result = subprocess.run(command, capture_output=True, text=True, timeout=60)
    return result.returncode, result.stdout + result.stderr, time.monotonic() - start


@pytest.mark.slow
def test_a_run_among_strangers_gives_the_same_bits(tmp_path):
    port = free_port()
    run, scene = begin_run(tmp_path / "disturbed", port)
    links = [socket.create_connection(("127.0.0.1", port)) for _ in range(30)]
    for index, link in enumerate(links):
        link.sendall(bytes(range(index)))
    overheard = strangers(port)  # as the components start
    run.wait_for_windows()
    assert strangers(port) == overheard  # within windows
    assert not [key for key in overheard if "@" in key]
    status, message, _ = join(scene, "pong", port)
    assert status == 3 and "pong is started by the run itself" in message
    assert run.wait() == 0, run.err
    for link in links:
        link.close()
    notes = run.results["notes"]["coupler"]
    match = re.match(r"(\d+) message\(s\) from outside the run were dropped", notes[0])
    assert match and 500 <= int(match[1]) <= 1000  # the first ones may come before it listens
    assert "1 request(s) to join were refused" in notes[1]
    assert run.err.count("message(s) from outside the run") < 6  # at most one in ten seconds
    reference = Started(scene, out=tmp_path / "alone")
    assert reference.wait() == 0 and "notes" not in reference.results["notes"]
    assert same(run.folder, reference.folder)
    status, message, seconds = join(scene, "pong", port)
    assert status == 3 and "nobody listens on port" in message and seconds < 20.0


@pytest.mark.slow
def test_a_second_join_is_refused_and_ends_nothing(tmp_path):
    port = free_port()
    run, scene = begin_run(tmp_path / "run", port, "--elsewhere", "pong", "--set", "patience=1.0")
    assert join(scene, "ping", port)[0] == 3
    time.sleep(2.0)
    command = [sys.executable, "-m", "quintet.coupler.cli", "join", str(scene), "pong"]
    command += ["--at", f"tcp/127.0.0.1:{port}"]
    first = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    run.wait_until(lambda: "built" in (run.folder / "log" / "ping.log").read_text())
    time.sleep(1.0)
    status, message, _ = join(scene, "pong", port)
    assert status == 3
    assert "pong has joined already (process" in message or "nobody listens" in message
    assert run.wait() == 0, run.err
    assert first.wait(10.0) == 0
    assert "the run waits for pong: nobody has joined as pong yet" in run.err
    assert "on another host" not in run.err
    assert "pong has joined already" in run.results["notes"]["coupler"][-1]
