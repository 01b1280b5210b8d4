"""A component of several MPI ranks gives the bits of one, over every line."""

import signal
import subprocess
import sys
import time

import pytest
from chain_scene import write
from rank_rows import start
from started import Started

from quintet.coupler.cli import main
from quintet.coupler.report.diff import compare
from quintet.coupler.scene.read import load
from quintet.interfaces.errors import SceneError
from quintet.interfaces.lines.endpoint import free_port

OVER = [pytest.param("zenoh", marks=pytest.mark.zenoh), pytest.param("mpi", marks=pytest.mark.mpi)]


def run(path, *arguments):
    started = Started(path, *arguments)
    started.out, started.err = started.process.communicate(timeout=60)
    return started


@pytest.fixture(scope="module")
def of_one_rank(tmp_path_factory):
    started = run(write(tmp_path_factory.mktemp("one") / "run", "memory", 1))
    assert started.process.returncode == 0, started.err
    return started.folder


@pytest.mark.parametrize("ranks", [2, 3])
@pytest.mark.parametrize("transport", OVER)
def test_several_ranks_give_the_bits_of_one(tmp_path, of_one_rank, transport, ranks):
    chain_run = run(write(tmp_path / "run", transport, ranks))
    assert chain_run.process.returncode == 0, chain_run.err
    assert compare(of_one_rank, chain_run.folder) is None
    assert f"chain (toy_ranks:Chain, {ranks} ranks)" in chain_run.out
    usage = chain_run.results["timing"]["components"]
    assert usage["chain"]["memory"] > 0.7 * ranks * usage["pusher"]["memory"], "of all ranks"
    assert usage["chain"]["cpu"] > 0.0
    assert (
        not chain_run.left_processes(5.0)
        and (chain_run.folder / "log" / "chain.rank1.log").exists()
    )


@pytest.mark.parametrize("transport", OVER)
def test_ranks_that_get_only_the_rows_they_need_give_the_same_bits(tmp_path, transport):
    folders = []
    for name, ranks, all_rows in (("all", 2, True), ("own", 2, False), ("three", 3, False)):
        started = start(tmp_path / name, 1000, ranks, all_rows, transport, windows=8)
        assert started.wait() in (0, 1), started.err  # 1: such loads want shorter windows
        folders.append(started.folder)
    assert compare(folders[0], folders[1]) is None and compare(folders[0], folders[2]) is None


@pytest.mark.mpi
@pytest.mark.parametrize(("ranks_before", "ranks_after"), [(3, 1), (1, 2)])
def test_a_snapshot_of_any_number_of_ranks_goes_on_with_any_other(
    tmp_path, of_one_rank, ranks_before, ranks_after
):
    chain_run = Started(write(tmp_path / "run", "mpi", ranks_before, keys="pause = 5e-3"))
    chain_run.wait_until(lambda: list(chain_run.folder.glob("snapshot-*")))
    chain_run.process.terminate()
    chain_run.process.communicate(timeout=30)
    assert chain_run.process.returncode == 130
    scene = write(tmp_path / "run", "mpi", ranks_after, keys="pause = 5e-3")
    with pytest.raises(SystemExit) as exit_info:
        main(["run", str(scene), "--resume", str(chain_run.folder)])
    assert exit_info.value.code == 0
    assert compare(of_one_rank, chain_run.folder) is None


@pytest.mark.zenoh
def test_ranks_join_by_hand(tmp_path, of_one_rank):
    port, path = free_port(), write(tmp_path / "run", "zenoh", 2)
    endpoint = f"tcp/127.0.0.1:{port}"
    chain_run = Started(path, "--set", f'endpoint="{endpoint}"', "--elsewhere", "chain")
    command = [
        sys.executable,
        "-m",
        "quintet.coupler.cli",
        "join",
        str(path),
        "chain",
        "--at",
        endpoint,
    ]
    result = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert result.returncode == 0, result.stderr
    assert chain_run.wait() == 0, chain_run.err
    assert compare(of_one_rank, chain_run.folder) is None


def test_a_kind_that_computes_on_one_rank_refuses_more(tmp_path):
    path = write(tmp_path / "run", "mpi", 2)
    path.write_text(path.read_text().replace("toy_ranks:Chain", "toy_ranks:Pusher"))
    with pytest.raises(SceneError, match="ranks must be 1, for kind toy_ranks:Pusher computes"):
        load(str(path))


def test_memory_refuses_several_ranks(tmp_path):
    with pytest.raises(SceneError, match="ranks must be 1 over the transport memory"):
        load(str(write(tmp_path / "run", "memory", 2)))


@pytest.mark.zenoh
def test_ranks_that_are_killed_as_they_start_leave_nothing(tmp_path):
    """They have not reported their shared files yet."""
    scene = write(tmp_path / "run", "zenoh", 3)
    for n in range(4):
        started = Started(scene, out=tmp_path / f"out{n}")
        log = started.folder / "log" / "chain.log"
        started.wait_until(lambda log=log: log.is_file() and "process" in log.read_text())
        time.sleep(0.1 * n)
        started.process.send_signal(signal.SIGINT)
        started.out, started.err = started.process.communicate(timeout=30)
        assert not started.left_processes(5.0) and not started.left_in_shared_memory()
