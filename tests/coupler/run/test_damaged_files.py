"""Every reader of a run's file notices damage, or reads the file as it was written."""

import json
import os
import shutil

import numpy as np
import pytest
from started import Started, same, write_scene
from test_folder import status

import quintet
from quintet.coupler.files.vtkhdf import VtkHdf, resume
from quintet.coupler.report import show
from quintet.coupler.run import snapshots

RESUMED = ("ledger.csv", "recording.h5", "ping.vtkhdf")


@pytest.fixture(scope="module")
def run_folder(tmp_path_factory):
    """The folder of a run."""
    folder = tmp_path_factory.mktemp("ended")
    path = write_scene(folder, end=0.02)
    assert status("run", path, "--out", folder / "out", "--set", "output.totals=0.005") == 0
    return folder / "out"


@pytest.fixture(scope="module")
def run_folders(tmp_path_factory):
    """Folders of a run that was killed when it had two snapshots, and of a whole run."""
    folder = tmp_path_factory.mktemp("killed")
    settings = ("--set", "output.snapshots=0.02", "--set", "output.interval=0.01")
    path = write_scene(folder, "memory", 0.2, pong="pause = 3e-3")
    run = Started(path, *settings)
    run.wait_until(lambda: len(snapshots.snapshots(run.folder)) == snapshots.KEPT)
    run.process.kill()
    run.wait()
    assert status("run", path, *settings, "--out", folder / "whole") == 0
    return run.folder, folder / "whole"


def flips(path, count):
    """Flip bits of a file one by one."""
    data, random = path.read_bytes(), np.random.default_rng(count)
    for bit in random.integers(8 * len(data), size=count):
        flipped_data = bytearray(data)
        flipped_data[bit // 8] ^= 1 << int(bit % 8)
        path.write_bytes(flipped_data)
        yield
    path.write_bytes(data)


def test_results_that_were_changed_are_refused_or_the_same(run_folder, tmp_path):
    out = shutil.copytree(run_folder, tmp_path / "out")
    original, refusals = show.results(out), 0
    del original["checksums"]
    for _ in flips(out / "results.json", 300):
        try:
            results = show.results(out)
            assert {key: results[key] for key in original} == original
        except quintet.SceneError:
            refusals += 1
    assert refusals > 200


@pytest.mark.parametrize("name", ["ledger.csv", "scene.toml"])
def test_what_python_reads_of_a_run_is_as_it_was_written(run_folder, tmp_path, name):
    out = shutil.copytree(run_folder, tmp_path / "out")
    run = quintet.load(out)
    assert run.ledger and run.scene
    for _ in flips(out / name, 30):
        with pytest.raises(quintet.SceneError, match=name):
            _ = run.ledger if name == "ledger.csv" else run.scene


def test_results_of_before_are_read(run_folder, tmp_path):
    out = shutil.copytree(run_folder, tmp_path / "out")
    results = json.loads((out / "results.json").read_text())
    del results["checksums"]
    (out / "results.json").write_text(json.dumps(results))
    assert quintet.load(out).ledger and quintet.load(out).ok


def test_a_ledger_that_was_changed_is_not_gone_on_with(run_folders, tmp_path, capsys):
    copy = shutil.copytree(run_folders[0], tmp_path / "again")
    size = snapshots.file_sizes(snapshots.latest(copy))[0]
    data = bytearray((copy / "ledger.csv").read_bytes())
    data[size // 2] ^= 1
    (copy / "ledger.csv").write_bytes(data)
    assert status("run", "--resume", copy) == 2
    assert "ledger.csv: its first" in capsys.readouterr().err


def test_a_recording_that_was_changed_is_not_gone_on_with(run_folders, tmp_path, capsys):
    copy = shutil.copytree(run_folders[0], tmp_path / "again")
    path = copy / "recording.h5"
    os.truncate(path, path.stat().st_size // 2)
    assert status("run", "--resume", copy) == 2
    message = capsys.readouterr().err
    assert "not a whole recording" in message and "Traceback" not in message


def test_a_run_goes_on_with_files_that_are_whole(run_folders, tmp_path):
    copy = shutil.copytree(run_folders[0], tmp_path / "again")
    assert status("run", "--resume", copy) == 0
    assert same(run_folders[1], copy)


def test_views_that_were_changed_are_not_gone_on_with(tmp_path):
    path, copy = tmp_path / "a.vtkhdf", tmp_path / "b.vtkhdf"
    random = np.random.default_rng(1)
    file = VtkHdf(path, {"speed": "m/s"}, "toy")
    for k in range(3):
        file.append(0.1 * k, {"points": random.normal(size=(40, 3)), "speed": random.random(40)})
    file.close()
    check, refusals = file.check, 0
    shutil.copy(path, copy)
    resumed_file = resume(copy, 1.0, check)
    assert resumed_file.check == check
    resumed_file.close()
    shutil.copy(path, copy)
    for _ in flips(copy, 20):
        try:
            resume(copy, 1.0, check).close()
        except quintet.SceneError as error:
            refusals += 1
            assert str(copy) in str(error)
    with pytest.raises(quintet.SceneError, match="must be as the run wrote them"):
        resume(path, 0.1, check)
