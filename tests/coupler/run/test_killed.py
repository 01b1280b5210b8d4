"""A run whose own process is killed leaves its results, and the command that resumes it."""

import json
import os
import signal
from pathlib import Path

import pytest
from started import Started, write_scene

from quintet.coupler.launch.mpi_job import LAUNCHER_FILE, find_launcher

CASES = [
    pytest.param("zenoh", "starter", marks=pytest.mark.zenoh),
    pytest.param("mpi", "starter", marks=pytest.mark.mpi),
    pytest.param("mpi", "coupler", marks=pytest.mark.mpi),
]


def _open_launcher_files(run):
    """Temporary files of the MPI launcher that processes of a run have open."""
    links = (link for pid in run.processes() for link in Path(f"/proc/{pid}/fd").glob("*"))
    paths = (link.readlink() for link in links if link.is_symlink())
    return {path for path in paths if path.name.startswith(LAUNCHER_FILE)}


def _is_hydra():
    return "-disable-auto-cleanup" in find_launcher()


@pytest.mark.parametrize(("transport", "victim"), CASES)
def test_a_killed_coupler_leaves_results_and_the_way_to_resume(tmp_path, transport, victim):
    scene = write_scene(tmp_path, transport, 1000.0, pong="pause = 1e-3")
    run = Started(scene, "--set", "output.snapshots=0.02")
    run.wait_for_windows()
    run.wait_until(lambda: list(run.folder.glob("snapshot-*.h5")))
    pid = run.process.pid
    if victim == "coupler":
        pid = json.loads((run.folder / "log" / "mpi.json").read_text())["coupler"]
    launcher_files = _open_launcher_files(run)
    assert bool(launcher_files) == (transport == "mpi") or not _is_hydra()
    os.kill(pid, signal.SIGKILL)
    run.out, run.err = run.process.communicate(timeout=30)
    processes, shared = run.left_processes(5.0), run.left_in_shared_memory()
    run.end()
    assert not processes and not shared
    assert not launcher_files or not launcher_files & set(Path("/tmp").glob("hydra_hwloc*"))
    results = json.loads((run.folder / "results.json").read_text())
    assert results["windows"] >= 20 and results["time"] == pytest.approx(1e-3 * results["windows"])
    assert results["resume"].startswith("quintet run --resume")
    assert "to go on: quintet run --resume" in run.err
    if victim == "starter" and transport == "mpi":  # the coupler's rank is alive, and ends in order
        assert results["status"] == "interrupted"
        return
    assert results["status"] == "failed" and results["fault"]["component"] == "coupler"
    message = "killed by signal 9 (SIGKILL)" if victim == "coupler" else "it was killed"
    assert message in results["fault"]["cause"] and message in run.err


@pytest.mark.zenoh
def test_no_companion_is_left_after_a_run(tmp_path):
    run = Started(write_scene(tmp_path, "zenoh", 0.01))
    assert run.wait() == 0 and not run.left_processes()
    results = json.loads((run.folder / "results.json").read_text())
    assert results["status"] == "done", "its companion wrote nothing"
