"""A component that lets the others wait for a good reason is named, and not ended."""

import pytest
import toys

from quintet.coupler.scene.read import load
from quintet.interfaces.manifest import find

OVER = [pytest.param("zenoh", marks=pytest.mark.zenoh), pytest.param("mpi", marks=pytest.mark.mpi)]
DOES = {  # while it waits
    "lock": "is sleeping",
    "disk": "is waiting for a disk",
    "child": "is waiting for its children, which compute",
    "programs": "is waiting for its children, which compute",
    "first": "is sleeping",
}


def check_waiting(run, reason, seconds):
    """The run came to its end, and named the component that kept it waiting."""
    assert run.wait(seconds + 60.0) == 0, run.err
    if reason == "build":
        assert "keeps the others waiting" not in run.err
        return
    window = 0 if reason == "first" else 30
    message = run.err.partition("quintet: pong keeps the others waiting for ")[2]
    assert f"in window {window}" in message and DOES[reason] in message
    if reason != "disk":  # there the system does not let it answer
        assert "toy_waits.py" in message
    assert "quintet: pong goes on after " in message
    assert not run.left_processes() and not run.left_in_shared_memory()


@pytest.mark.zenoh
def test_an_external_program_that_computes_is_waited_for(faulty):
    run = faulty("Waiting", "zenoh", 'fails_by = "child"\nseconds = 6.5')
    check_waiting(run, "child", 6.5)


@pytest.mark.mpi
def test_a_build_that_computes_may_take_longer_than_its_patience(faulty):
    pong = 'fails_by = "build"\nseconds = 4.0'
    run = faulty("Waiting", "mpi", pong, top="patience = 1.0")
    assert run.wait() == 0, run.err
    assert "s to be built: process" in run.err and "pong goes on after" in run.err


@pytest.mark.full
@pytest.mark.parametrize("transport", OVER)
@pytest.mark.parametrize("reason", [*DOES, "build"])
def test_half_a_minute_of_waiting_is_no_fault(faulty, transport, reason):
    run = faulty("Waiting", transport, f'fails_by = "{reason}"\nseconds = 30.0')
    check_waiting(run, reason, 30.0)


@pytest.mark.full
@pytest.mark.parametrize("transport", OVER)
def test_a_first_window_of_ten_times_the_usual_is_no_fault(faulty, transport):
    pong = 'fails_by = "first"\nseconds = 20.0\npause = 2.0'
    run = faulty("Waiting", transport, pong, end=0.005)
    check_waiting(run, "first", 40.0)


PATIENT = "patience = 7.0\nname = "


def test_the_patience_is_that_of_the_scene_or_of_the_kind(tmp_path):
    scene = tmp_path / "scene.toml"
    text = 'name = "one"\nend = 1.0\n[components.echo]\nkind = "echo"\nitems = 1\n'
    scene.write_text(text)
    assert load(str(scene)).patience("echo") == 60.0
    scene.write_text(text.replace("name = ", PATIENT))
    assert load(str(scene)).patience("echo") == 7.0


def test_a_class_may_have_a_patience(monkeypatch):
    monkeypatch.setattr(toys.Toy, "patience", 600.0, raising=False)
    assert find("toys:Toy").patience == 600.0
