"""Runs that are disturbed at random end with the bits of the undisturbed run, or with a cause."""

import os
import signal
from pathlib import Path

import pytest
from disturbed_runs import AS_UNDISTURBED, judge, left_by
from kills import Killed
from started import Started, same, write_scene

from quintet.coupler.scene.read import library

pytestmark = pytest.mark.zenoh
SMALL_DAM = Path(__file__).parents[2] / "scenarios/small_dam.toml"
SCENES = {  # arguments, and roughly how long a run takes [s]
    "hot_bar_coupled": (("--preset", "quick"), 12.0),
    "dam_break_cubes": (("--preset", "quick", "--set", "end=0.3"), 40.0),
}


@pytest.fixture(scope="module")
def toy(tmp_path_factory):
    """A scene of two toys, and an undisturbed run of it."""
    folder = tmp_path_factory.mktemp("toy")
    scene = write_scene(folder, "zenoh", 0.2, "pause = 5e-4", "pause = 5e-4\nseen = true")
    output = "\n[output]\ninterval = 0.02\nsnapshots = 0.05\n"
    scene.write_text(f"patience = 8.0\n{scene.read_text()}{output}")
    reference = Started(scene, out=folder / "alone")
    assert reference.wait() == 0, reference.err
    return scene, reference


def check(toy, folder, seed, *arguments):
    """A disturbed run ends as the rule allows, and reports the disturbances."""
    scene, reference = toy
    run = Started(scene, "--chaos", str(seed), *arguments, out=folder)
    verdict = judge(run, reference, 0, 5.0)
    assert verdict.right, (verdict, run.err)
    chaos = verdict.chaos
    assert chaos["seed"] == seed and chaos["planned"]
    assert all(text in run.err for text in (*chaos["planned"], *chaos["happened"]))


@pytest.mark.parametrize("seed", [2, 4, 10])  # a kill, lost messages and a full disk, a stop
def test_a_disturbed_run_has_the_same_bits_or_ends_with_a_cause(toy, tmp_path, seed):
    check(toy, tmp_path / "out", seed)


@pytest.mark.full
@pytest.mark.parametrize("seed", range(200))
def test_many_disturbed_runs_have_the_same_bits_or_end_with_a_cause(toy, tmp_path, seed):
    check(toy, tmp_path / "out", seed)


@pytest.mark.full
@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("transport", ["memory", pytest.param("mpi", marks=pytest.mark.mpi)])
def test_runs_over_other_transports_are_disturbed_too(toy, tmp_path, transport, seed):
    check(toy, tmp_path / "out", seed, "--transport", transport)


def test_a_run_over_memory_is_disturbed_too(toy, tmp_path):
    check(toy, tmp_path / "out", 1, "--transport", "memory")


@pytest.mark.parametrize("target", ["coupler", "host"])
def test_a_run_whose_coupler_or_host_is_killed_is_resumed_with_the_same_bits(toy, tmp_path, target):
    scene, reference = toy
    killed = Killed(scene, tmp_path / "out", ["--set", "restarts=2"], 1, 1, 3.0, target)
    assert judge(killed.run, reference, 0, 5.0).end == AS_UNDISTURBED, killed.told
    assert len(killed.lost()) == 1 and killed.told


def test_water_and_a_body_that_are_killed_at_once_go_on_with_the_same_bits(tmp_path):
    settings = ("--set", "end=0.06", "--set", "output.snapshots=0.02", "--transport", "zenoh")
    reference = Started(SMALL_DAM, *settings, out=tmp_path / "alone")
    assert reference.wait(300.0) == 0, reference.err
    run = Started(SMALL_DAM, "--set", "restarts=1", *settings, out=tmp_path / "killed")
    run.wait_until(lambda: list(run.folder.glob("snapshot-*.h5")))
    for name in ("water", "cube"):
        os.kill(run.pid_of(name), signal.SIGKILL)
    assert run.wait(120.0) == 0, run.err
    assert {"water", "cube"} <= run.results["notes"].keys()
    assert not left_by(run)
    assert same(run.folder, reference.folder)


@pytest.mark.full
@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("name", SCENES)
def test_scenes_among_kills_have_the_same_bits(tmp_path, name, seed):
    arguments, seconds = SCENES[name]
    scene, arguments = library()[name], ("--transport", "zenoh", *arguments)
    reference = Started(scene, *arguments, out=tmp_path / "alone")
    status = reference.wait(1200.0)
    assert status in (0, 1), reference.err
    settings = [*arguments, "--set", "restarts=6"]
    killed = Killed(scene, tmp_path / "killed", settings, seed, 3, seconds)
    verdict = judge(killed.run, reference, status, seconds)
    assert verdict.right and verdict.end == AS_UNDISTURBED, (verdict, killed.told)
