"""With more time after SIGTERM, a run finishes its window and leaves a snapshot of it."""

import signal
import time

import pytest
from started import Started, write_scene


@pytest.mark.zenoh
@pytest.mark.parametrize(("arguments", "has_snapshot"), [((), False), (("--grace", "20"), True)])
def test_a_long_window_ends_in_a_snapshot_if_it_is_given_time(tmp_path, arguments, has_snapshot):
    """Without more grace, the run waits at most 0.7 s of a window of 2.5 s."""
    scene = write_scene(tmp_path, "zenoh", 1.0, pong="pause = 2.5\ntalks = true")
    run = Started(scene, *arguments)
    log = run.folder / "log/pong.log"
    run.wait_until(lambda: log.exists() and "a step" in log.read_text())
    time.sleep(0.5)  # the second window is under way
    run.process.send_signal(signal.SIGTERM)
    assert run.wait() == 130
    assert bool(list(run.folder.glob("snapshot-*.h5"))) == has_snapshot
    assert run.results["status"] == "interrupted"


@pytest.mark.parametrize("text", ["-1", "nan", "inf", "soon"])
def test_only_seconds_are_accepted(tmp_path, text):
    run = Started(write_scene(tmp_path), f"--grace={text}")
    assert run.wait() == 2
    assert f"argument --grace: must be seconds, 0 or more; found '{text}'" in run.err
