"""Runs over several hosts, with certificates for each."""

import contextlib
import os
import signal
import subprocess
import sys
import time

import pytest
from network import Network, lacking
from started import Started, write_scene

PORT = 7447
CLI = (sys.executable, "-m", "quintet.coupler.cli")


def openssl(folder, *arguments):
    subprocess.run(["openssl", *arguments], cwd=folder, check=True, capture_output=True)


@pytest.fixture(scope="session")
def host_certificates(tmp_path_factory):
    """An authority, and certificates for a component, or the coupler, and its host."""
    folder = tmp_path_factory.mktemp("hosts")
    key = ("-newkey", "rsa:2048", "-nodes")
    openssl(
        folder, "req", "-x509", *key, "-days", "1", "-keyout", "authority.key",
        "-out", "authority.pem", "-subj", "/CN=quintet tests",
    )  # fmt: skip
    files = {}
    for owner, number in (("coupler", 1), ("pong", 2), ("pong", 3), ("ping", 3)):
        host = f"host{number}"
        name = f"{owner}-{host}"
        openssl(
            folder, "req", *key, "-keyout", f"{name}.key", "-out", f"{name}.csr",
            "-subj", f"/CN={owner}",
        )  # fmt: skip
        names = f"subjectAltName=DNS:{host},IP:10.77.0.{number}"
        (folder / "leaf.ext").write_text(f"{names}\nextendedKeyUsage=serverAuth,clientAuth\n")
        openssl(
            folder, "x509", "-req", "-in", f"{name}.csr", "-CA", "authority.pem",
            "-CAkey", "authority.key", "-CAcreateserial", "-days", "1",
            "-extfile", "leaf.ext", "-out", f"{name}.pem",
        )  # fmt: skip
        leaf = (folder / "authority.pem", folder / f"{name}.pem", folder / f"{name}.key")
        files[name] = [str(path) for path in leaf]
    return files


@pytest.fixture
def network():
    """Make hosts; at the end all are removed, and their processes killed."""
    if reason := lacking():
        pytest.skip(reason)
    networks = []

    def make(count, **faults):
        networks.append(Network(count, **faults))
        return networks[-1]

    yield make
    for hosts in networks:
        hosts.remove()


class SpreadRun:
    """A run whose coupler is on the first host; some components are joined on others."""

    def __init__(self, folder, hosts, certificates, elsewhere, end, toys, *settings):
        self.hosts, self.certificates = hosts, certificates
        self.endpoint = f"tls/{hosts[0].address}:{PORT}"
        self.scene = write_scene(folder, "zenoh", end, **toys)
        self.said = folder / "said.txt"
        arguments = [word for name in elsewhere for word in ("--elsewhere", name)]
        arguments += [
            "--set",
            f'endpoint="{self.endpoint}"',
            *self.tls("coupler", hosts[0]),
            *settings,
        ]
        screen = ("sh", "-c", f'exec "$@" 2>>{self.said}', "sh")
        self.run = Started(self.scene, *arguments, within=(*hosts[0].within, *screen))
        self.joined = {name: self.join(name, host) for name, host in elsewhere.items()}

    def tls(self, name, host):
        """Words that give the certificates of a component on a host."""
        files = ", ".join(f'"{path}"' for path in self.certificates[f"{name}-{host.name}"])
        return ["--set", f"tls=[{files}]"]

    def log_of(self, name, host):
        return self.scene.parent / f"{name}-{host.name}.log"

    def join(self, name, host):
        """Join a component on a host by the command on the screen."""
        command = [
            *CLI,
            "join",
            str(self.scene),
            name,
            "--at",
            self.endpoint,
            *self.tls(name, host),
        ]
        return host.start(command, self.log_of(name, host))

    def wait_for_step(self, name, host, seconds=60.0):
        """Wait until a component has stepped for a while."""
        log = self.log_of(name, host)
        self.run.wait_until(lambda: "step 50" in log.read_text(), seconds)

    def wait_for_words(self, words, seconds):
        """Wait until words appear on the screen; return the time that it took."""
        start = time.monotonic()
        self.run.wait_until(lambda: words in self.said.read_text(), seconds)
        return time.monotonic() - start

    def wait(self, seconds=120.0):
        """Wait for the end; return the exit status and the text of the screen."""
        status = self.run.wait(seconds)
        return status, self.said.read_text()

    def stop(self, name):
        """Stop all threads of a component (SIGSTOP), and the processes between it and the tests."""
        os.killpg(self.joined[name].pid, signal.SIGSTOP)

    def go_on(self, name):
        """Let the stopped processes go on."""
        os.killpg(self.joined[name].pid, signal.SIGCONT)


@pytest.fixture
def spread(tmp_path, host_certificates):
    """Start a run over several hosts."""
    runs = []

    def start(hosts, elsewhere, *settings, end=0.4, toys=None):
        folder = tmp_path / f"spread{len(runs)}"
        folder.mkdir()
        toys = toys or {"ping": "items = 1000\npause = 5e-3", "pong": "items = 1000"}
        runs.append(SpreadRun(folder, hosts, host_certificates, elsewhere, end, toys, *settings))
        return runs[-1]

    yield start
    for run in runs:
        run.run.end()
        run.run.process.kill()
        with contextlib.suppress(ValueError):  # they are closed
            run.run.process.communicate()
