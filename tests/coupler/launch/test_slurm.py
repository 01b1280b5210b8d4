"""A scene runs as jobs of a real SLURM, on two nodes, as far as its limits of time."""

import os
import re
import shutil
import subprocess
import sys
import time

import pytest
from chain_scene import write as write_chain
from slurm_cluster import Cluster, lacking
from started import write_scene

from quintet.coupler.report.diff import compare
from quintet.coupler.report.show import results

QUINTET = [sys.executable, "-m", "quintet.coupler.cli"]
OUT = ("--out", "run", "--submit")
MAIN = ("dam_break_cubes", "--preset", "quick", "--set", "end=0.7")
pytestmark = [
    pytest.mark.full,
    pytest.mark.mpi,
    pytest.mark.skipif(
        bool(lacking()),
        reason=f"SLURM is not installed here: no {', '.join(lacking())} "
        "(Debian: apt-get install slurm-wlm munge)",
    ),
]


@pytest.fixture(scope="module")
def cluster(tmp_path_factory):
    slurm = Cluster(tmp_path_factory.mktemp("slurm"))
    try:
        yield slurm
    finally:
        slurm.close()


def _launch(cluster, folder, *arguments, limit="00:10:00"):
    options = ("--slurm", "--nodes", "2", "--time", limit, "--margin", "10")
    output = cluster.call(*QUINTET, "launch", *map(str, arguments), *options, *OUT, cwd=folder)
    assert "Submitted batch job" in output, output


def _output(folder):
    """The output of all jobs, one after the other."""
    jobs = sorted(folder.glob("*-*.out"), key=lambda path: int(path.stem.rpartition("-")[2]))
    return "".join(path.read_text() for path in jobs)


def _wait_for_windows(folder):
    limit = time.monotonic() + 60.0
    while not (folder / "run/log/reached").exists() or "window" not in _output(folder):
        assert time.monotonic() < limit, _output(folder)
        time.sleep(0.2)


def test_the_main_job_goes_on_in_further_jobs_to_the_same_bits(cluster, tmp_path):
    reference = tmp_path / "undisturbed"
    subprocess.run([*QUINTET, "run", *MAIN, "--out", str(reference)], capture_output=True)
    _launch(cluster, tmp_path, *MAIN, limit="00:01:00")
    cluster.wait(900.0)
    output = _output(tmp_path)
    windows = re.findall(r"ended in snapshot-(\d+)\.h5; submitted again", output)
    assert windows and list(map(int, windows)) == sorted(set(map(int, windows))), output
    assert output.count("quintet launch: the run is done") == 1, output
    assert results(tmp_path / "run")["status"] == "done"
    assert compare(reference, tmp_path / "run") is None
    assert not list((tmp_path / "run/log").glob("*.exit"))


def test_a_failed_run_is_reported_and_not_submitted_again(cluster, tmp_path):
    scene = write_scene(tmp_path, "mpi", 0.1, pong="fails_at = 50")
    _launch(cluster, tmp_path, scene)
    cluster.wait(120.0)
    output = _output(tmp_path)
    assert "pong failed in window" in output and "not submitted again" in output
    assert "the run failed with status" in output and "Submitted batch" not in output
    assert results(tmp_path / "run")["fault"]["component"] == "pong"


def test_a_killed_coupler_leaves_results_and_its_ranks_are_ended(cluster, tmp_path):
    scene = write_scene(tmp_path, "mpi", 1000.0, pong="pause = 1e-3")
    _launch(cluster, tmp_path, scene)
    _wait_for_windows(tmp_path)
    job = cluster.jobs()[0]
    coupler = re.search(r'"coupler": (\d+)', (tmp_path / "run/log/mpi.json").read_text())[1]
    subprocess.run(["kill", "-KILL", coupler])
    cluster.wait(150.0)
    assert results(tmp_path / "run")["fault"]["component"] == "coupler"
    output = _output(tmp_path)
    assert "the run failed with status 137" in output and job in output


def test_a_component_that_is_killed_on_the_other_node_is_named(cluster, tmp_path):
    """Ping is placed on the second node: only the file with its exit status reports its end."""
    scene = write_scene(tmp_path, "mpi", 1000.0, pong="pause = 1e-3")
    _launch(cluster, tmp_path, scene)
    _wait_for_windows(tmp_path)
    log = (tmp_path / "run/log/ping.log").read_text()
    subprocess.run(["kill", "-KILL", re.search(r"process (\d+)", log)[1]])
    start = time.monotonic()
    while "ping failed in window" not in _output(tmp_path):
        assert time.monotonic() < start + 10.0, _output(tmp_path)
        time.sleep(0.1)
    cluster.wait(100.0)
    subject = "its process, not on the coupler's host," if cluster.other_host else "process"
    fault = results(tmp_path / "run")["fault"]
    assert fault["component"] == "ping" and "by signal 9 (SIGKILL)" in fault["cause"]
    assert subject in fault["cause"]


def test_a_component_of_two_ranks_on_two_nodes_gives_the_bits_of_one(cluster, tmp_path):
    scene = write_chain(tmp_path / "alone", "memory", 1)
    subprocess.run([*QUINTET, "run", str(scene), "--out", str(tmp_path / "one")], check=True)
    _launch(cluster, tmp_path, write_chain(tmp_path / "chain", "mpi", 2))
    cluster.wait(100.0)
    assert results(tmp_path / "run")["status"] == "done", _output(tmp_path)
    assert compare(tmp_path / "one", tmp_path / "run") is None
    assert not list((tmp_path / "run/log").glob("*.exit*"))


def test_a_rank_that_is_killed_on_the_other_node_is_named(cluster, tmp_path):
    scene = write_chain(tmp_path / "chain", "mpi", 2, end=1000.0, keys="pause = 1e-3")
    _launch(cluster, tmp_path, scene)
    _wait_for_windows(tmp_path)
    log = (tmp_path / "run/log/chain.rank1.log").read_text()
    subprocess.run(["kill", "-KILL", re.search(r"process (\d+)", log)[1]])
    cluster.wait(100.0)
    fault = results(tmp_path / "run")["fault"]
    host = "n2" if cluster.other_host else os.uname().nodename
    assert fault["component"] == "chain" and fault["cause"].startswith(f"rank 1 on {host}: ")
    assert "by signal 9 (SIGKILL)" in fault["cause"], fault


def test_who_cancels_a_job_gets_a_snapshot_and_no_other_job(cluster, tmp_path):
    scene = write_scene(tmp_path, "mpi", 1000.0, pong="pause = 1e-3")
    _launch(cluster, tmp_path, scene)
    _wait_for_windows(tmp_path)
    cluster.call("scancel", cluster.jobs()[0])
    cluster.wait(60.0)
    assert results(tmp_path / "run")["status"] == "interrupted"
    assert list((tmp_path / "run").glob("snapshot-*.h5"))
    assert "Submitted batch" not in _output(tmp_path)


def test_a_job_without_progress_is_the_last(cluster, tmp_path):
    """A window that takes longer than a job would be submitted again for ever."""
    scene = write_scene(tmp_path, "mpi", 1000.0, pong="pause = 200.0")
    _launch(cluster, tmp_path, scene, limit="00:01:00")
    cluster.wait(200.0)
    output = _output(tmp_path)
    assert "no snapshot was written in this job" in output and "Submitted batch" not in output
    shutil.rmtree(tmp_path / "run")
