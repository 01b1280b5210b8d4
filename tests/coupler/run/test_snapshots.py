"""A run that goes on from a snapshot ends with the bits of one that was never disturbed."""

import json
import os
import shutil
import signal
from pathlib import Path

import pytest
from started import Started, write_scene

from quintet.coupler.cli import main
from quintet.coupler.files import vtkhdf_reader
from quintet.coupler.report.diff import compare
from quintet.coupler.run import snapshots
from quintet.coupler.run.simulate import make_folder, simulate
from quintet.coupler.scene.read import load

SMALL_DAM = Path(__file__).parents[2] / "scenarios/small_dam.toml"
OVER = [pytest.param("zenoh", marks=pytest.mark.zenoh), pytest.param("mpi", marks=pytest.mark.mpi)]


def status(*arguments):
    with pytest.raises(SystemExit) as ended:
        main([str(one) for one in arguments])
    return ended.value.code


def same(one, other):
    """Whether two runs left the same, but for the times of the clock."""
    assert compare(one, other) is None
    assert (one / "ledger.csv").read_bytes() == (other / "ledger.csv").read_bytes()
    found = [json.loads((folder / "results.json").read_text()) for folder in (one, other)]
    for key in ("status", "windows", "time", "expect", "ledger"):
        assert found[0][key] == found[1][key], key
    for path in one.glob("*.vtkhdf"):
        times = vtkhdf_reader.times(path)
        assert list(times) == list(vtkhdf_reader.times(other / path.name))
        for k in range(len(times)):
            views = [vtkhdf_reader.read_step(run / path.name, k)[1] for run in (one, other)]
            assert all((views[0][key] == views[1][key]).all() for key in views[0])
    return True


@pytest.fixture
def gone_on(tmp_path, monkeypatch):
    """Run a scene to its end with snapshots kept; once more from the last of them."""

    def run(scene, *settings):
        monkeypatch.setattr(snapshots, "remove", lambda paths: None)
        made = load(str(scene), settings=settings, transport="memory")
        first, again = tmp_path / "first", tmp_path / "again"
        make_folder(made, first)
        done = simulate(made, first)
        shutil.copytree(first, again)
        snapshot = snapshots.latest(again)
        assert 0 < snapshots.window_of(snapshot)
        assert simulate(load(str(scene), settings=settings), again, snapshot) == done
        return first, again, snapshots.window_of(snapshot)

    return run


@pytest.mark.parametrize("scheme", ["serial", "parallel"])
def test_toys_go_on_from_a_snapshot_with_the_same_bits(tmp_path, gone_on, scheme):
    path = write_scene(tmp_path, end=0.1, ping="substeps = 7", pong="substeps = 3")
    output = ("output.snapshots=0.03", "output.totals=0.004", f'scheme="{scheme}"')
    first, again, window = gone_on(path, *output)
    assert window == 90 and same(first, again)


def test_an_iterated_run_goes_on_from_a_snapshot_with_the_same_bits(gone_on):
    first, again, window = gone_on("two_springs", "output.snapshots=0.08", "end=0.1")
    assert window == 40 and same(first, again)


def test_water_and_a_body_go_on_from_a_snapshot_with_the_same_bits(gone_on):
    output = ("end=0.03", "output.interval=0.01", "output.snapshots=0.012")
    first, again, window = gone_on(SMALL_DAM, *output)
    assert window == 24 and same(first, again)
    assert len(vtkhdf_reader.times(again / "water.vtkhdf")) == 4


@pytest.mark.parametrize("transport", ["memory", *OVER])
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
    # As it was asked for, or named again; over any transport.
    again = ("run", path, "--set", "output.snapshots=0.01", "--transport", "memory")
    assert status(*again, "--resume", run.folder) == 0
    assert status(*again, "--out", tmp_path / "undisturbed") == 0
    assert same(tmp_path / "undisturbed", run.folder)


def test_what_cannot_go_on_is_refused(tmp_path, capsys):
    path = write_scene(tmp_path, end=0.01)
    out = tmp_path / "out"
    assert status("run") == 2
    assert "run needs a scene, or --resume DIR. Give one." in capsys.readouterr().err
    assert status("run", path, "--out", out) == 0
    assert status("run", "--resume", out) == 2
    assert f"--resume {out}: it has no snapshot." in capsys.readouterr().err
    (out / "snapshot-5.h5").write_bytes(b"")
    assert status("run", path, "--resume", out, "--set", "end=0.02") == 2
    assert "the scene must be the one that began; end has changed." in capsys.readouterr().err
    assert status("run", path, "--resume", out, "--out", out) == 2
    assert "Remove --out." in capsys.readouterr().err
