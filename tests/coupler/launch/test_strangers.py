"""Whatever other programs send to a run's endpoint, the run goes on, and says what it dropped."""

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
    """Another program that sends what it can; return what it has overheard."""
    command = [sys.executable, "-c", STRANGER, f"tcp/127.0.0.1:{port}"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=True)
    return json.loads(done.stdout)


def begun(folder, port, *arguments):
    folder.mkdir()
    scene = write_scene(folder, "zenoh", 0.5, ping="pause = 0.01")
    run = Started(scene, "--set", f'endpoint="tcp/127.0.0.1:{port}"', *arguments)
    wait_for_endpoint(port)
    return run, scene


def join(scene, name, port):
    """Try to join a run by hand; return the status, what is said, and the time it took."""
    command = [sys.executable, "-m", "quintet.coupler.cli", "join", str(scene), name]
    command += ["--at", f"tcp/127.0.0.1:{port}"]
    began = time.monotonic()
    done = subprocess.run(command, capture_output=True, text=True, timeout=60)
    return done.returncode, done.stdout + done.stderr, time.monotonic() - began


@pytest.mark.slow
def test_a_run_among_strangers_gives_the_same_bits(tmp_path):
    port = free_port()
    run, scene = begun(tmp_path / "disturbed", port)
    links = [socket.create_connection(("127.0.0.1", port)) for _ in range(30)]
    for n, link in enumerate(links):
        link.sendall(bytes(range(n)))
    overheard = strangers(port)  # as the components start
    run.wait_for_windows()
    assert strangers(port) == overheard  # within windows
    assert not [key for key in overheard if "@" in key]
    status, said, _ = join(scene, "pong", port)
    assert status == 3 and "pong is started by the run itself" in said
    assert run.wait() == 0, run.err
    for link in links:
        link.close()
    notes = run.results["notes"]["coupler"]
    dropped = re.match(r"(\d+) message\(s\) from outside the run were dropped", notes[0])
    assert dropped and 500 <= int(dropped[1]) <= 1000  # the first ones may come before it listens
    assert "1 request(s) to join were refused" in notes[1]
    assert run.err.count("message(s) from outside the run") < 6  # at most one in ten seconds
    alone = Started(scene, out=tmp_path / "alone")
    assert alone.wait() == 0 and "notes" not in alone.results["notes"]
    assert same(run.folder, alone.folder)
    status, said, took = join(scene, "pong", port)
    assert status == 3 and "nobody listens on port" in said and took < 20.0


@pytest.mark.slow
def test_a_second_join_is_refused_and_ends_nothing(tmp_path):
    port = free_port()
    run, scene = begun(tmp_path / "run", port, "--elsewhere", "pong", "--set", "patience=1.0")
    assert join(scene, "ping", port)[0] == 3
    time.sleep(2.0)
    command = [sys.executable, "-m", "quintet.coupler.cli", "join", str(scene), "pong"]
    command += ["--at", f"tcp/127.0.0.1:{port}"]
    first = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    run.wait_until(lambda: "built" in (run.folder / "log" / "ping.log").read_text())
    time.sleep(1.0)
    status, said, _ = join(scene, "pong", port)
    assert status == 3
    assert "pong has joined already (process" in said or "nobody listens" in said
    assert run.wait() == 0, run.err
    assert first.wait(10.0) == 0
    assert "the run waits for pong: nobody has joined as pong yet" in run.err
    assert "on another host" not in run.err
    assert "pong has joined already" in run.results["notes"]["coupler"][-1]
