"""A run's files that were changed are noticed by all that read them back, or read as they were."""

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
def ended(tmp_path_factory):
    """The folder of a run."""
    folder = tmp_path_factory.mktemp("ended")
    path = write_scene(folder, end=0.02)
    assert status("run", path, "--out", folder / "out", "--set", "output.totals=0.005") == 0
    return folder / "out"


@pytest.fixture(scope="module")
def killed(tmp_path_factory):
    """A run that was killed when it had two snapshots, and one that was not."""
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
    for number in random.integers(8 * len(data), size=count):
        changed = bytearray(data)
        changed[number // 8] ^= 1 << int(number % 8)
        path.write_bytes(changed)
        yield
    path.write_bytes(data)


def test_results_that_were_changed_are_refused_or_the_same(ended, tmp_path):
    out = shutil.copytree(ended, tmp_path / "out")
    before, refused = show.results(out), 0
    del before["checksums"]
    for _ in flips(out / "results.json", 300):
        try:
            found = show.results(out)
            assert {key: found[key] for key in before} == before
        except quintet.SceneError:
            refused += 1
    assert refused > 200


@pytest.mark.parametrize("name", ["ledger.csv", "scene.toml"])
def test_what_python_reads_of_a_run_is_as_it_was_written(ended, tmp_path, name):
    out = shutil.copytree(ended, tmp_path / "out")
    run = quintet.load(out)
    assert run.ledger and run.scene
    for _ in flips(out / name, 30):
        with pytest.raises(quintet.SceneError, match=name):
            _ = run.ledger if name == "ledger.csv" else run.scene


def test_results_of_before_are_read(ended, tmp_path):
    out = shutil.copytree(ended, tmp_path / "out")
    found = json.loads((out / "results.json").read_text())
    del found["checksums"]
    (out / "results.json").write_text(json.dumps(found))
    assert quintet.load(out).ledger and quintet.load(out).ok


def test_a_ledger_that_was_changed_is_not_gone_on_with(killed, tmp_path, capsys):
    again = shutil.copytree(killed[0], tmp_path / "again")
    size = snapshots.file_sizes(snapshots.latest(again))[0]
    data = bytearray((again / "ledger.csv").read_bytes())
    data[size // 2] ^= 1
    (again / "ledger.csv").write_bytes(data)
    assert status("run", "--resume", again) == 2
    assert "ledger.csv: its first" in capsys.readouterr().err


def test_a_recording_that_was_changed_is_not_gone_on_with(killed, tmp_path, capsys):
    again = shutil.copytree(killed[0], tmp_path / "again")
    path = again / "recording.h5"
    os.truncate(path, path.stat().st_size // 2)
    assert status("run", "--resume", again) == 2
    said = capsys.readouterr().err
    assert "not a whole recording" in said and "Traceback" not in said


def test_a_run_goes_on_with_files_that_are_whole(killed, tmp_path):
    again = shutil.copytree(killed[0], tmp_path / "again")
    assert status("run", "--resume", again) == 0
    assert same(killed[1], again)


def test_views_that_were_changed_are_not_gone_on_with(tmp_path):
    path, again = tmp_path / "a.vtkhdf", tmp_path / "b.vtkhdf"
    random = np.random.default_rng(1)
    file = VtkHdf(path, {"speed": "m/s"}, "toy")
    for k in range(3):
        file.append(0.1 * k, {"points": random.normal(size=(40, 3)), "speed": random.random(40)})
    file.close()
    check, refused = file.check, 0
    shutil.copy(path, again)
    made = resume(again, 1.0, check)
    assert made.check == check
    made.close()
    shutil.copy(path, again)
    for _ in flips(again, 20):
        try:
            resume(again, 1.0, check).close()
        except quintet.SceneError as error:
            refused += 1
            assert str(again) in str(error)
    with pytest.raises(quintet.SceneError, match="must be as the run wrote them"):
        resume(path, 0.1, check)
