"""Runs over TLS: a foreign process is refused with the reason, and the bits are the same."""

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
        """The output of a process that may not join."""
        process = self.begin(name, *tls, protocol=protocol)
        output, _ = process.communicate(timeout=60.0)
        assert process.returncode in (2, 3), output
        return output


@pytest.fixture
def over_tls(tmp_path):
    runs = []

    def begin(*arguments):
        runs.append(OverTls(tmp_path, *arguments))
        return runs[-1]

    yield begin
    for tls_run in runs:
        tls_run.run.end()


@pytest.mark.full
def test_who_has_no_right_to_join_is_told_why_and_the_run_goes_on(over_tls, tmp_path):
    tls_run = over_tls("--elsewhere", "pong", "--set", "patience=60.0")
    port = f"localhost:{tls_run.port}"
    stranger = socket.create_connection(("127.0.0.1", tls_run.port))
    stranger.sendall(bytes(range(100)))
    assert "that of process" in (
        message := tls_run.refusal("pong", "--tls", *files_of(tls_run.tls, "ping"))
    )
    assert "pong must join with a certificate whose common name is pong" in message
    foreign = files_of(tmp_path / "foreign", "pong")
    assert "is not signed by the authority" in tls_run.refusal("pong", "--tls", *foreign)
    mixed = [files_of(tls_run.tls, "pong")[0], *foreign[1:]]
    assert "its authority did not sign it" in tls_run.refusal("pong", "--tls", *mixed)
    assert "tls needs authority, certificate and key" in tls_run.refusal("pong")
    assert "the run listens with tls; a plain connection" in tls_run.refusal("pong", protocol="tcp")
    command = re.search(r"pong is awaited: (.*)", tls_run.run.process.stdout.readline() + "".join(
        tls_run.run.process.stdout.readline() for _ in range(2)))[1]  # fmt: skip
    assert f"--at tls/{port} --tls {' '.join(files_of(tls_run.tls, 'pong'))}" in command
    process = tls_run.begin("pong", "--tls", *files_of(tls_run.tls, "pong"))
    tls_run.run.wait_until(
        lambda: "built" in (tls_run.run.folder / "log" / "ping.log").read_text(), 60.0
    )
    assert tls_run.run.wait(120.0) == 0, tls_run.run.err
    process.communicate(timeout=30.0)
    assert "1 request(s) to join were refused" in tls_run.run.results["notes"]["coupler"][0]
    stranger.close()
    reference = Started(tls_run.scene, out=tmp_path / "alone")
    assert reference.wait() == 0
    assert same(tls_run.run.folder, reference.folder)


@pytest.mark.full
def test_a_component_that_is_killed_during_a_run_over_tls_is_replaced(over_tls, tmp_path):
    tls_run = over_tls("--set", "restarts=2")
    tls_run.run.wait_for_windows()
    os.kill(tls_run.run.pid_of("pong"), signal.SIGKILL)
    assert tls_run.run.wait(120.0) == 0, tls_run.run.err
    assert "with the same bits" in tls_run.run.results["notes"]["pong"][0]
    reference = Started(tls_run.scene, out=tmp_path / "alone")
    assert reference.wait() == 0
    assert same(tls_run.run.folder, reference.folder)


@pytest.mark.full
def test_who_joined_over_tls_and_died_may_join_again(over_tls, tmp_path):
    tls_run = over_tls("--elsewhere", "pong", "--set", "restarts=1")
    files = files_of(tls_run.tls, "pong")
    first = tls_run.begin("pong", "--tls", *files)
    while "step 50" not in first.stdout.readline():
        assert first.poll() is None
    first.kill()
    first.communicate()
    second = tls_run.begin("pong", "--tls", *files)
    assert tls_run.run.wait(120.0) == 0, tls_run.run.err
    second.communicate(timeout=30.0)
    assert "with the same bits" in tls_run.run.results["notes"]["pong"][0]
    reference = Started(tls_run.scene, out=tmp_path / "alone")
    assert reference.wait() == 0
    assert same(tls_run.run.folder, reference.folder)
