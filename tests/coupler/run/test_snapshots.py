"""A run that goes on from a snapshot ends with the bits of one that was never disturbed."""

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from started import Started, same, write_scene

from quintet.coupler.cli import main
from quintet.coupler.files import vtkhdf_reader
from quintet.coupler.files.disk import seal
from quintet.coupler.files.states import states_of
from quintet.coupler.files.vtkhdf import VtkHdf
from quintet.coupler.run import output, snapshots
from quintet.coupler.run.simulate import make_folder, simulate
from quintet.coupler.scene.read import load

SMALL_DAM = Path(__file__).parents[2] / "scenarios/small_dam.toml"
OVER = [pytest.param("zenoh", marks=pytest.mark.zenoh), pytest.param("mpi", marks=pytest.mark.mpi)]


def status(*arguments):
    with pytest.raises(SystemExit) as exit_info:
        main([str(argument) for argument in arguments])
    return exit_info.value.code


@pytest.fixture
def run_and_resume(tmp_path, monkeypatch):
    """Run a scene to its end with snapshots kept; once more from the last of them."""

    def run(scene, *settings):
        monkeypatch.setattr(snapshots, "remove", lambda paths: None)
        loaded_scene = load(str(scene), settings=settings, transport="memory")
        first, resumed = tmp_path / "first", tmp_path / "again"
        make_folder(loaded_scene, first)
        exit_status = simulate(loaded_scene, first)
        shutil.copytree(first, resumed)
        snapshot = snapshots.latest(resumed)
        assert 0 < snapshots.window_of(snapshot)
        assert simulate(load(str(scene), settings=settings), resumed, snapshot) == exit_status
        return first, resumed, snapshots.window_of(snapshot)

    return run


@pytest.mark.parametrize("scheme", ["serial", "parallel"])
def test_toys_go_on_from_a_snapshot_with_the_same_bits(tmp_path, run_and_resume, scheme):
    path = write_scene(tmp_path, end=0.1, ping="substeps = 7", pong="substeps = 3")
    output = ("output.snapshots=0.03", "output.totals=0.004", f'scheme="{scheme}"')
    first, resumed, window = run_and_resume(path, *output)
    assert window == 90 and same(first, resumed)


def test_an_iterated_run_goes_on_from_a_snapshot_with_the_same_bits(run_and_resume):
    first, resumed, window = run_and_resume("two_springs", "output.snapshots=0.08", "end=0.1")
    assert window == 40 and same(first, resumed)


def test_water_and_a_body_go_on_from_a_snapshot_with_the_same_bits(run_and_resume):
    output = ("end=0.03", "output.interval=0.01", "output.snapshots=0.012")
    first, resumed, window = run_and_resume(SMALL_DAM, *output)
    assert window == 24 and same(first, resumed)
    assert len(vtkhdf_reader.times(resumed / "water.vtkhdf")) == 4


@pytest.mark.full
def test_a_ball_on_glued_particles_goes_on_from_a_snapshot_with_the_same_bits(run_and_resume):
    path = SMALL_DAM.parents[2] / "scenarios/al_ball_7400_glued/scene.toml"
    settings = ("output.snapshots=3e-7", "end=5e-7")
    first, resumed, window = run_and_resume(path, *settings)
    assert 0 < window and same(first, resumed)


@pytest.mark.parametrize(
    "transport",
    ["memory", OVER[0], pytest.param("mpi", marks=[pytest.mark.mpi, pytest.mark.full])],
)
def test_an_interrupted_run_goes_on_with_the_same_bits(tmp_path, capsys, transport):
    path = write_scene(tmp_path, transport, 0.3, pong="pause = 3e-3")
    run = Started(path)
    run.wait_until(lambda: (run.folder / "recording.h5").is_file())
    run.process.send_signal(signal.SIGINT)
    assert run.wait() == 130
    assert "to go on: quintet run --resume" in run.err
    assert run.results["windows"] < 300 and "--resume" in run.results["resume"]
    assert status("run", "--resume", run.folder) == 0
    assert not snapshots.snapshots(run.folder) and "resume" not in run.results
    undisturbed = tmp_path / "undisturbed"
    assert status("run", path, "--transport", "memory", "--out", undisturbed) == 0
    assert same(undisturbed, run.folder)


@pytest.mark.zenoh
def test_a_run_whose_component_was_killed_goes_on_from_its_last_snapshot(tmp_path, capsys):
    path = write_scene(tmp_path, "zenoh", 0.2, pong="pause = 3e-3")
    run = Started(path, "--set", "output.snapshots=0.01")
    run.wait_until(lambda: len(snapshots.snapshots(run.folder)) == snapshots.KEPT)
    os.kill(run.pid_of("pong"), signal.SIGKILL)
    assert run.wait() == 3
    assert run.results["status"] == "failed" and "--resume" in run.results["resume"]
    assert len(snapshots.snapshots(run.folder)) == snapshots.KEPT
    # With the scene as it began; over any transport.
    arguments = ("run", path, "--set", "output.snapshots=0.01", "--transport", "memory")
    assert status(*arguments, "--resume", run.folder) == 0
    assert status(*arguments, "--out", tmp_path / "undisturbed") == 0
    assert same(tmp_path / "undisturbed", run.folder)


KILLED_WHILE_IT_DRAWS = """
import os, signal
from quintet.coupler.cli import main
from quintet.coupler.run import results

results.draw = lambda *_: os.kill(os.getpid(), signal.SIGKILL)
main()
"""


def test_a_run_killed_while_it_draws_goes_on_from_its_last_snapshot(tmp_path, capsys):
    path = write_scene(tmp_path, end=0.2)
    arguments = ["run", path, "--set", "output.snapshots=0.06", "--out"]
    killed, undisturbed = tmp_path / "killed", tmp_path / "undisturbed"
    program = [sys.executable, "-c", KILLED_WHILE_IT_DRAWS, *map(str, arguments), killed]
    assert subprocess.run(program, capture_output=True, timeout=100).returncode == -signal.SIGKILL
    assert status("run", "--resume", killed) == 0
    assert not snapshots.snapshots(killed)
    assert status(*arguments, undisturbed) == 0
    assert same(undisturbed, killed)


@pytest.mark.parametrize(("pause", "has_snapshot"), [(0.4, True), (0.0, False)])
def test_long_windows_are_kept_often(tmp_path, monkeypatch, pause, has_snapshot):
    """They may not end in time when a run is interrupted."""
    monkeypatch.setattr(output, "OFTEN", 0.0)
    path = write_scene(tmp_path, end=1.0, pong=f"pause = {pause}\nfails_at = 3")
    assert status("run", path, "--out", tmp_path / "out") == 3
    assert bool(snapshots.snapshots(tmp_path / "out")) == has_snapshot


@pytest.mark.zenoh
def test_what_an_interruption_loses_is_said(tmp_path):
    run = Started(write_scene(tmp_path, "zenoh", 100.0, pong="pause = 2.5\ntalks = true"))
    log = run.folder / "log" / "pong.log"
    run.wait_until(lambda: log.is_file() and "a step" in log.read_text())
    time.sleep(0.2)
    run.process.send_signal(signal.SIGINT)
    assert run.wait() == 130
    assert "it cannot go on: it was ended before its first snapshot" in run.err


def test_what_cannot_go_on_is_refused(tmp_path, capsys):
    path = write_scene(tmp_path, end=0.01)
    out = tmp_path / "out"
    assert status("run") == 2
    assert "run needs a scene, or --resume DIR. Give one." in capsys.readouterr().err
    assert status("run", path, "--out", out) == 0
    assert status("run", "--resume", out) == 2
    assert f"--resume {out}: it has no snapshot." in capsys.readouterr().err
    (out / "snapshot-5.h5").write_bytes(b"")
    seal(out / "snapshot-5.h5")
    assert status("run", path, "--resume", out, "--set", "end=0.02") == 2
    assert "the scene must be the one that began; end has changed." in capsys.readouterr().err
    assert status("run", path, "--resume", out, "--out", out) == 2
    assert "Remove --out." in capsys.readouterr().err


@pytest.fixture(scope="module")
def run_folders(tmp_path_factory):
    """Folders of a run that was killed when it had two snapshots, and of a whole run."""
    folder = tmp_path_factory.mktemp("killed")
    path = write_scene(folder, "memory", 0.2, pong="pause = 3e-3")
    run = Started(path, "--set", "output.snapshots=0.02")
    run.wait_until(lambda: len(snapshots.snapshots(run.folder)) == snapshots.KEPT)
    run.process.kill()
    run.wait()
    assert status("run", path, "--set", "output.snapshots=0.02", "--out", folder / "whole") == 0
    return run.folder, folder / "whole"


def flip_a_bit(path, place=0.5):
    data = bytearray(path.read_bytes())
    data[int(place * (len(data) - 1))] ^= 0x10
    path.write_bytes(data)


DAMAGES = {
    "cut": lambda path: os.truncate(path, path.stat().st_size - 1000),
    "empty": lambda path: os.truncate(path, 0),
    "bit": flip_a_bit,
    "last bit": lambda path: flip_a_bit(path, 1.0),
}


@pytest.mark.parametrize("damage", DAMAGES)
def test_a_snapshot_that_was_changed_is_named_and_the_one_before_is_used(
    tmp_path, run_folders, damage, capfd
):
    copy, whole = tmp_path / "again", run_folders[1]
    shutil.copytree(run_folders[0], copy)
    previous, last = snapshots.snapshots(copy)
    DAMAGES[damage](last)
    assert status("run", "--resume", copy) == 0
    assert (
        f"quintet: {last.name} is incomplete or was changed: its checksum differs. The run goes on "
        f"from {previous.name}.\n"
    ) in capfd.readouterr().err
    assert same(whole, copy) and not snapshots.snapshots(copy)


def test_a_run_that_cannot_go_on_has_come_as_far_as_its_snapshot(tmp_path, monkeypatch, capsys):
    path, out = write_scene(tmp_path, end=0.01), tmp_path / "out"
    monkeypatch.setattr(output.OutputWriter, "wants_end", lambda writer: writer.done >= 6)
    assert status("run", path, "--out", out) == 130
    assert snapshots.window_of(snapshots.latest(out)) == 6
    (out / "recording.h5").write_bytes(b"")
    capsys.readouterr()
    assert status("run", "--resume", out) == 2
    results = json.loads((out / "results.json").read_text())
    assert (results["windows"], results["time"]) == (6, pytest.approx(6e-3))
    assert "are computed again" not in capsys.readouterr().err


def test_a_run_whose_snapshots_were_all_changed_is_refused(tmp_path, run_folders, capsys):
    copy = tmp_path / "again"
    shutil.copytree(run_folders[0], copy)
    for path in snapshots.snapshots(copy):
        flip_a_bit(path)
    assert status("run", "--resume", copy) == 2
    message = capsys.readouterr().err
    assert message.count("is incomplete or was changed: its checksum differs.") == snapshots.KEPT


def test_a_file_that_is_too_short_for_the_snapshot_is_refused(tmp_path, run_folders, capsys):
    copy = tmp_path / "again"
    shutil.copytree(run_folders[0], copy)
    os.truncate(copy / "ledger.csv", 10)
    assert status("run", "--resume", copy) == 2
    assert "bytes to go on; found 10. Run the scene again." in capsys.readouterr().err


def test_copies_that_a_user_has_named_stay(tmp_path):
    path, folder = write_scene(tmp_path, end=0.1), tmp_path / "out"
    arguments = ("run", path, "--set", "output.snapshots=0.03", "--out", folder)
    assert status(*arguments) == 0
    copies = [folder / f"snapshot-{name}.h5" for name in ("before-the-crash", "kept-7", "30.old")]
    for copy in copies:
        copy.write_text("mine")
    assert status(*arguments, "--force") == 0
    assert [copy.read_text() for copy in copies] == ["mine"] * 3
    assert not snapshots.snapshots(folder) and not states_of(folder)


@pytest.mark.parametrize("seen", [(), (2.0, 3.0)])
def test_views_that_begin_after_a_snapshot_begin_again(tmp_path, seen):
    path = tmp_path / "ping.vtkhdf"
    file = VtkHdf(path)
    for when in seen:
        file.append(when, {"points": np.zeros((2, 3))})
    file.close()
    writer = output.OutputWriter.__new__(output.OutputWriter)
    settings = SimpleNamespace(output=SimpleNamespace(record=False))
    writer.scene = SimpleNamespace(components=["ping"], file=settings)
    writer.folder, writer._began, writer._view_checks, writer._files = tmp_path, 1.0, {}, {}
    writer._go_on()
    assert not path.exists() and not writer._files
