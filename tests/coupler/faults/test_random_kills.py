"""Components of real scenes, killed at random moments: the run ends with the same bits."""

import os
import signal
from pathlib import Path

import pytest
from random_kills import disturbed
from started import Started, same

from quintet.coupler.scene.read import library

pytestmark = pytest.mark.zenoh
SMALL_DAM = Path(__file__).parents[2] / "scenarios/small_dam.toml"
SCENES = {  # arguments, and roughly how long a run takes [s]
    "hot_bar_coupled": (("--preset", "quick"), 12.0),
    "dam_break_cubes": (("--preset", "quick", "--set", "end=0.3"), 40.0),
}


def check_killed(scene, folder, seed, kills, seconds, *arguments):
    """A run among kills has the bits of one without."""
    alone = Started(scene, "--transport", "zenoh", *arguments, out=folder / "alone")
    status = alone.wait(1200.0)
    assert status in (0, 1), alone.err
    run, moments = disturbed(scene, folder / "killed", seed, kills, seconds, *arguments)
    assert run.wait(1200.0) == status, run.err
    assert not run.left_processes() and not run.left_in_shared_memory()
    assert same(run.folder, alone.folder), moments


def test_water_and_a_body_that_are_killed_at_once_go_on_with_the_same_bits(tmp_path):
    settings = ("--set", "end=0.06", "--set", "output.snapshots=0.02", "--transport", "zenoh")
    alone = Started(SMALL_DAM, *settings, out=tmp_path / "alone")
    assert alone.wait(300.0) == 0, alone.err
    run = Started(SMALL_DAM, "--set", "restarts=1", *settings, out=tmp_path / "killed")
    run.wait_until(lambda: list(run.folder.glob("snapshot-*.h5")))
    for name in ("water", "cube"):
        os.kill(run.pid_of(name), signal.SIGKILL)
    assert run.wait(120.0) == 0, run.err
    assert {"water", "cube"} <= run.results["notes"].keys()
    assert not run.left_processes() and not run.left_in_shared_memory()
    assert same(run.folder, alone.folder)


@pytest.mark.full
@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("name", SCENES)
def test_scenes_among_kills_have_the_same_bits(tmp_path, name, seed):
    arguments, seconds = SCENES[name]
    check_killed(library()[name], tmp_path, seed, 3, seconds, *arguments)
