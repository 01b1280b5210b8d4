"""The runs of a sweep are jobs of a real SLURM; killed, a sweep finds them again."""

import json
import os
import signal
import subprocess
import sys
import time
from collections import Counter

import pytest
from slurm_cluster import Cluster, lacking
from spring_scene import write
from started import write_scene

QUINTET = [sys.executable, "-m", "quintet.coupler.cli", "sweep"]
SLURM = ("--engine", "slurm", "--sbatch=--time=00:05:00", "--out", "all")
STEP, STIFFNESS = "components.spring.step", "components.spring.stiffness"
pytestmark = [
    pytest.mark.full,
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


def begin(cluster, folder, scene, *arguments):
    """Start a sweep whose runs are jobs, in a session of its own."""
    command = [*QUINTET, str(scene), *SLURM, *arguments]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    return subprocess.Popen(
        command, env=cluster.env, cwd=folder, text=True, start_new_session=True, **pipes
    )


def events(folder):
    """Run and event of each line of the journal."""
    path = folder / "all" / "sweep.log"
    lines = path.read_text().splitlines() if path.is_file() else []
    return [tuple(line.split()[1:]) for line in lines]


def wait_for(condition, seconds=300.0):
    limit = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < limit, "it did not come to that"
        time.sleep(0.1)


def done_count(folder):
    return sum(event == "done" for _, event in events(folder))


def test_of_64_runs_at_most_one_is_repeated_for_each_kill(cluster, tmp_path):
    scene = write(tmp_path, within=1.0)
    steps = ",".join(f"{0.02 / (k + 1):.6g}" for k in range(8))
    stiffness = ",".join(str(100.0 + 5.0 * k) for k in range(8))
    options = ("--over", f"{STEP}={steps}", "--over", f"{STIFFNESS}={stiffness}")
    arguments = (*options, "--set", "end=0.25", "--jobs", "2")
    first = begin(cluster, tmp_path, scene, *arguments)
    wait_for(lambda: done_count(tmp_path) >= 5)
    os.killpg(first.pid, signal.SIGKILL)  # the sweep; its jobs stay
    first.communicate()
    second = begin(cluster, tmp_path, scene, *arguments)
    wait_for(lambda: done_count(tmp_path) >= 20)
    wait_for(lambda: len(cluster.jobs()) > 0)
    cluster.call("scancel", "--full", "--signal=KILL", cluster.jobs()[0])  # a run
    output, errors = second.communicate(timeout=900)
    assert second.returncode == 0, errors + output
    starts = Counter(run for run, event in events(tmp_path) if event in ("started", "resumed"))
    print(f"{len(starts)} runs, {starts.total()} starts, 2 kills")
    assert len(starts) == 64 and starts.total() <= 64 + 2, starts
    rows = json.loads((tmp_path / "all" / "sweep.json").read_text())["rows"]
    assert [row["status"] for row in rows] == 64 * ["done"]


def test_an_interrupted_sweep_ends_its_jobs_with_snapshots(cluster, tmp_path):
    scene = write_scene(tmp_path, end=0.6, pong="pause = 5e-3")
    options = ("--over", "components.ping.items=5")
    sweep = begin(cluster, tmp_path, scene, *options)
    wait_for(lambda: list(tmp_path.glob("all/*/recording.h5")))
    time.sleep(1.0)
    sweep.send_signal(signal.SIGINT)
    output, errors = sweep.communicate(timeout=90)
    assert sweep.returncode == 130, errors + output
    assert list(tmp_path.glob("all/*/snapshot-*.h5")) and not cluster.jobs()
    sweep = begin(cluster, tmp_path, scene, *options)
    output, errors = sweep.communicate(timeout=120)
    assert sweep.returncode == 0, errors + output
    assert [event for _, event in events(tmp_path)] == ["started", "interrupted", "resumed", "done"]


def test_what_sbatch_refuses_is_told(cluster, tmp_path):
    scene = write(tmp_path)
    options = ("--over", f"{STEP}=0.02", "--sbatch=--partition=none")
    sweep = begin(cluster, tmp_path, scene, *options)
    output, _ = sweep.communicate(timeout=60)
    assert sweep.returncode == 3 and "sbatch refused the run" in output
