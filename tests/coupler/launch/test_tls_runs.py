"""Runs over TLS: who has no right to join is refused with the reason, and the bits are the same."""

import json
import os
import re
import signal
import socket
import subprocess
import sys

import pytest
from started import Started, same, write_scene

from quintet.coupler.launch.certificates import files_of, hosts_of, write_certificates
from quintet.interfaces.lines.endpoint import free_port

pytestmark = [pytest.mark.zenoh, pytest.mark.slow]


class OverTls:
    """A run over TLS whose second component is joined by hand."""

    def __init__(self, folder, *arguments):
        self.tls, self.port = folder / "tls", free_port()
        write_certificates(self.tls, hosts_of([], ["ping", "pong"], ""), 1)
        write_certificates(folder / "foreign", hosts_of([], ["pong"], ""), 1)
        self.scene = write_scene(folder, "zenoh", 0.3, ping="pause = 5e-3")
        self.settings = (
            "--set", f'endpoint="tls/localhost:{self.port}"',
            "--set", f"tls={json.dumps(files_of(self.tls, 'coupler'))}",
        )  # fmt: skip
        self.run = Started(self.scene, *self.settings, *arguments)
        self.run.wait_until(self.listens)

    def listens(self):
        with socket.socket() as probe:
            return probe.connect_ex(("127.0.0.1", self.port)) == 0

    def begin(self, name, *tls, protocol="tls"):
        """Start to join."""
        command = [sys.executable, "-m", "quintet.coupler.cli", "join", str(self.scene), name]
        command += ["--at", f"{protocol}/localhost:{self.port}", *tls]
        return subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        )

    def refusal(self, name, *tls, protocol="tls"):
        """What somebody is told who may not join."""
        process = self.begin(name, *tls, protocol=protocol)
        said, _ = process.communicate(timeout=60.0)
        assert process.returncode in (2, 3), said
        return said


@pytest.fixture
def over_tls(tmp_path):
    begun = []

    def begin(*arguments):
        begun.append(OverTls(tmp_path, *arguments))
        return begun[-1]

    yield begin
    for it in begun:
        it.run.end()


@pytest.mark.full
def test_who_has_no_right_to_join_is_told_why_and_the_run_goes_on(over_tls, tmp_path):
    it = over_tls("--elsewhere", "pong", "--set", "patience=60.0")
    port = f"localhost:{it.port}"
    stranger = socket.create_connection(("127.0.0.1", it.port))
    stranger.sendall(bytes(range(100)))
    assert "that of process" in (said := it.refusal("pong", "--tls", *files_of(it.tls, "ping")))
    assert "pong must join with a certificate whose common name is pong" in said
    foreign = files_of(tmp_path / "foreign", "pong")
    assert "is not signed by the authority" in it.refusal("pong", "--tls", *foreign)
    mixed = [files_of(it.tls, "pong")[0], *foreign[1:]]
    assert "its authority did not sign it" in it.refusal("pong", "--tls", *mixed)
    assert "tls needs authority, certificate and key" in it.refusal("pong")
    assert "the run listens with tls; a plain connection" in it.refusal("pong", protocol="tcp")
    command = re.search(r"pong is awaited: (.*)", it.run.process.stdout.readline() + "".join(
        it.run.process.stdout.readline() for _ in range(2)))[1]  # fmt: skip
    assert f"--at tls/{port} --tls {' '.join(files_of(it.tls, 'pong'))}" in command
    joined = it.begin("pong", "--tls", *files_of(it.tls, "pong"))
    it.run.wait_until(lambda: "built" in (it.run.folder / "log" / "ping.log").read_text(), 60.0)
    assert it.run.wait(120.0) == 0, it.run.err
    joined.communicate(timeout=30.0)
    assert "1 request(s) to join were refused" in it.run.results["notes"]["coupler"][0]
    stranger.close()
    alone = Started(it.scene, out=tmp_path / "alone")
    assert alone.wait() == 0
    assert same(it.run.folder, alone.folder)


@pytest.mark.full
def test_a_component_that_is_killed_during_a_run_over_tls_is_replaced(over_tls, tmp_path):
    it = over_tls("--set", "restarts=2")
    it.run.wait_for_windows()
    os.kill(it.run.pid_of("pong"), signal.SIGKILL)
    assert it.run.wait(120.0) == 0, it.run.err
    assert "with the same bits" in it.run.results["notes"]["pong"][0]
    alone = Started(it.scene, out=tmp_path / "alone")
    assert alone.wait() == 0
    assert same(it.run.folder, alone.folder)


@pytest.mark.full
def test_who_joined_over_tls_and_died_may_join_again(over_tls, tmp_path):
    it = over_tls("--elsewhere", "pong", "--set", "restarts=1")
    pair = files_of(it.tls, "pong")
    first = it.begin("pong", "--tls", *pair)
    while "step 50" not in first.stdout.readline():
        assert first.poll() is None
    first.kill()
    first.communicate()
    second = it.begin("pong", "--tls", *pair)
    assert it.run.wait(120.0) == 0, it.run.err
    second.communicate(timeout=30.0)
    assert "with the same bits" in it.run.results["notes"]["pong"][0]
    alone = Started(it.scene, out=tmp_path / "alone")
    assert alone.wait() == 0
    assert same(it.run.folder, alone.folder)
