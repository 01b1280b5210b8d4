"""Hosts of a test: network namespaces with addresses and names of their own, on one switch.

A switch is a bridge in a namespace of its own, or, where frames are to be late or lost, a program
that forwards them: a kernel may lack ``netem``.
"""

import contextlib
import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

NEEDED = ("ip", "nsenter", "unshare", "openssl")
SWITCH = Path(__file__).with_name("lossy_switch.py")


def lacking():
    """Reason why no namespaces can be made here, or ""."""
    if os.geteuid() != 0:
        return "only root may make network namespaces"
    if missing := [name for name in NEEDED if shutil.which(name) is None]:
        return f"needs {', '.join(missing)}"
    name = f"q{os.getpid()}-try"
    result = subprocess.run(["ip", "netns", "add", name], capture_output=True, text=True)
    subprocess.run(["ip", "netns", "delete", name], capture_output=True)
    return f"network namespaces are refused: {result.stderr.strip()}" if result.returncode else ""


def ip(*words):
    subprocess.run(["ip", *words], check=True, capture_output=True, text=True)


def remove_left():
    """Remove the namespaces of tests that were killed."""
    for path in Path("/run/netns").glob("q*-*"):
        process = path.name[1:].partition("-")[0]
        if process.isdigit() and not Path("/proc", process).exists():
            end_inside(path.name)


def end_inside(namespace):
    """Kill the processes in a namespace, and remove it."""
    result = subprocess.run(["ip", "netns", "pids", namespace], capture_output=True, text=True)
    for pid in result.stdout.split():
        with contextlib.suppress(ProcessLookupError):
            os.kill(int(pid), signal.SIGKILL)
    subprocess.run(["ip", "netns", "delete", namespace], capture_output=True)


class Host:
    """A namespace with an address and a name."""

    def __init__(self, number):
        self.number = number
        self.namespace = f"q{os.getpid()}-{number}"
        self.name = f"host{number}"
        self.address = f"10.77.0.{number}"
        self.processes = []
        # A port of the switch has a name of its own, as it may lie in the namespace of the tests.
        self.port = f"q{os.getpid()}p{number}"

    @property
    def within(self):
        """Words before a command that is to run on this host."""
        rename = f'hostname {self.name} && exec "$@"'
        enter = ("nsenter", f"--net=/run/netns/{self.namespace}")
        return (*enter, "unshare", "--uts", "sh", "-c", rename, "sh")

    def start(self, command, log):
        """Start a program there, its output in a file."""
        with open(log, "ab") as file:
            program = subprocess.Popen(
                [*self.within, *command], stdout=file, stderr=file, start_new_session=True
            )
        self.processes.append(program)
        return program

    def kill(self):
        """Kill all programs of this host."""
        for program in self.processes:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(program.pid, signal.SIGKILL)
            program.wait()


class Network:
    """Some hosts on a switch; a cut host keeps its address, and receives no frame.

    Parameters
    ----------
    delay : float, s
        Of each frame, one way.
    loss : float
        Share of the frames that are lost.
    """

    def __init__(self, count, delay=0.0, loss=0.0):
        self.hosts = [Host(number) for number in range(1, count + 1)]
        self.switch = Host(0)
        self.forwarder = None
        remove_left()
        try:
            for host in (self.switch, *self.hosts):
                ip("netns", "add", host.namespace)
                ip("-n", host.namespace, "link", "set", "lo", "up")
            if delay or loss:
                self._begin_forwarder(delay, loss)
            else:
                self._make_bridge()
            for host in self.hosts:
                ip("-n", host.namespace, "addr", "add", f"{host.address}/24", "dev", "eth0")
                ip("-n", host.namespace, "link", "set", "eth0", "up")
        except BaseException:
            self.remove()
            raise

    def _make_bridge(self):
        prefix = ("-n", self.switch.namespace)
        ip(*prefix, "link", "add", "switch", "type", "bridge")
        ip(*prefix, "link", "set", "switch", "up")
        for host in self.hosts:
            peer = ("peer", "name", "eth0", "netns", host.namespace)
            ip(*prefix, "link", "add", host.port, "type", "veth", *peer)
            ip(*prefix, "link", "set", host.port, "master", "switch", "up")

    def _begin_forwarder(self, delay, loss):
        command = [sys.executable, str(SWITCH), str(delay), str(loss)]
        command += [word for host in self.hosts for word in (host.port, host.namespace)]
        self.forwarder = subprocess.Popen(command, stdout=subprocess.PIPE)
        assert self.forwarder.stdout.readline() == b"ready\n"

    def cut(self, host, link_down=False):
        """Cut a host off: frames no longer arrive, or its link goes down."""
        if link_down:
            ip("-n", self.switch.namespace, "link", "set", host.port, "down")
        else:
            ip("-n", self.switch.namespace, "link", "set", host.port, "nomaster")

    def heal(self, host):
        """Join a host again."""
        ip("-n", self.switch.namespace, "link", "set", host.port, "master", "switch", "up")

    def remove(self):
        """Remove the network, and end the processes in it."""
        if self.forwarder:
            self.forwarder.kill()
            self.forwarder.communicate()
        for host in (*self.hosts, self.switch):
            host.kill()
            end_inside(host.namespace)
