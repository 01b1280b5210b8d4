"""What a component says of itself is checked before its process is watched, signalled or killed."""

import os
import socket
from types import SimpleNamespace

import pytest

from quintet.coupler.coupling.participant import ComponentFailed, Participant
from quintet.coupler.launch.acceptance import identify
from quintet.coupler.launch.process_probe import ProcessProbe
from quintet.interfaces.errors import MessageError
from quintet.interfaces.lines.message import Message
from quintet.interfaces.serving.process import about_me

PLAN = SimpleNamespace(manifest=SimpleNamespace(kind="toy"), ranks=1)
SCENE = SimpleNamespace(components={"ping": PLAN})


def probe_after(folder, **about):
    """The probe of a component that says this of itself."""
    probe = ProcessProbe("ping")
    hello = Message({"order": "hello", "kind": "toy", **about_me(), **about})
    identify(SCENE, "ping", hello, probe, folder, 0)
    return probe


def test_the_process_of_a_component_is_found(tmp_path):
    assert probe_after(tmp_path).pid == os.getpid()
    assert probe_after(tmp_path, host=f"not {socket.gethostname()}").pid == 0


def test_the_process_of_a_container_is_none_of_this_host(tmp_path):
    """Its id may be that of a process that has nothing to do with the run."""
    assert probe_after(tmp_path, numbering="pid:[1]").pid == 0


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("pid", -1, r"pid, a whole number above 0; found -1\. Correct it\."),
        ("pid", 0, r"pid, a whole number above 0; found 0"),
        ("pid", None, r"pid, a whole number above 0; found None"),
        ("stack", 900, r"stack, the signal upon which it writes its stack; found 900"),
        ("shared", 3, r"shared, a list of files in shared memory; found 3"),
    ],
)
def test_a_hello_that_names_no_process_is_refused(tmp_path, key, value, words):
    with pytest.raises(ComponentFailed, match=f"ping failed in window 0: its hello must .*{words}"):
        probe_after(tmp_path, **{key: value})


def test_a_hello_that_cannot_be_read_is_told_of_its_component():
    class Line:
        def receive(self, seconds):
            raise MessageError("it has no header.")

    with pytest.raises(ComponentFailed, match="ping failed in window 0: did not join: it has no"):
        Participant("ping", Line()).await_hello(1.0, lambda seconds: None)
