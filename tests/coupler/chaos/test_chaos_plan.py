"""The choices of a seed, and the effect of each disturbance by itself."""

import errno
import subprocess
import sys
import time

import psutil
import pytest
from spring_scene import command, write

from quintet.coupler.chaos.full_disk import FullDisk
from quintet.coupler.chaos.plan import EVERYWHERE, FRAMES, KINDS, PROCESSES, Fault, choose
from quintet.coupler.chaos.processes import Signals
from quintet.coupler.chaos.wire import disturbed
from quintet.coupler.files.disk import Writing, write_whole
from quintet.coupler.files.table_file import TableFile
from quintet.coupler.launch.process_probe import ProcessProbe
from quintet.interfaces.errors import DiskError

RANKS = {"water": 2, "cubes": 1}
SEEDS = range(300)


def faults_of(transport, **keys):
    """All disturbances of many seeds."""
    return [fault for seed in SEEDS for fault in choose(seed, transport, RANKS, **keys)]


def test_a_seed_chooses_the_same_places_again_and_another_seed_others():
    assert all(choose(seed, "zenoh", RANKS) == choose(seed, "zenoh", RANKS) for seed in SEEDS)
    assert len({tuple(choose(seed, "zenoh", RANKS)) for seed in SEEDS}) == len(SEEDS)


@pytest.mark.parametrize("transport", KINDS)
def test_every_kind_that_makes_sense_over_a_transport_is_chosen_and_no_other(transport):
    assert {fault.kind for fault in faults_of(transport)} == set(KINDS[transport])
    assert not set(KINDS["memory"]) & {*PROCESSES, *FRAMES}
    assert not set(KINDS["mpi"]) & set(FRAMES)


def test_every_rank_of_a_component_is_disturbed():
    ranks = {fault.rank for fault in faults_of("mpi") if fault.component == "water"}
    assert ranks == {-1, 0, 1}  # -1: not one of its processes
    assert {fault.rank for fault in faults_of("mpi") if fault.component == "cubes"} == {-1}


def test_processes_that_the_run_does_not_start_are_left_alone():
    kinds = {f.kind for f in faults_of("zenoh", elsewhere=["cubes"]) if f.component == "cubes"}
    assert kinds == {*FRAMES, *EVERYWHERE} - {"full disk"}


def test_a_dropped_frame_does_not_arrive_and_a_duplicate_arrives_again():
    frame = bytes(range(64))
    assert disturbed(frame, None) == [frame]
    assert disturbed(frame, Fault("drop", "water")) == []
    assert disturbed(frame, Fault("duplicate", "water", amount=3.0)) == [frame] * 3


@pytest.mark.parametrize("place", [0.0, 0.3, 0.9999])
def test_just_one_bit_of_a_corrupted_frame_differs(place):
    frame = bytes(range(64))
    (arrived,) = disturbed(frame, Fault("corrupt", "water", amount=place))
    differ = [a ^ b for a, b in zip(arrived, frame, strict=True)]
    assert sum(bits.bit_count() for bits in differ) == 1
    assert [bool(bits) for bits in differ].index(True) == int(64 * place)


def test_a_full_disk_refuses_as_many_pieces_as_it_was_told_to_and_leaves_files_whole(tmp_path):
    messages = []
    disk = FullDisk(messages.append)
    table = TableFile(tmp_path / "ledger.csv")
    try:
        table.write([1, 2])
        table.flush()
        disk.fill(2)
        table.write([3, 4])
        with pytest.raises(DiskError, match=r"ledger\.csv: it cannot be written, as the disk at"):
            table.flush()
        with pytest.raises(DiskError, match="is full") as error_info:
            write_whole(tmp_path / "scene.toml", "name")
        assert error_info.value.__cause__.errno == errno.ENOSPC
        write_whole(tmp_path / "scene.toml", "name")
    finally:
        disk.close()
    assert Writing.begin(tmp_path) is None
    assert (tmp_path / "ledger.csv").read_text().split() == ["1,2"]
    assert messages == [f"the disk is full for {name}" for name in ("ledger.csv", "scene.toml")]


def test_a_process_that_is_slowed_down_is_not_taken_for_one_that_was_stopped():
    process = subprocess.Popen([sys.executable, "-c", "while True: pass"])
    try:
        probe, signals = ProcessProbe("water", process.pid, process), Signals()
        signals.slow(process.pid, 1.0)
        limit, states = time.monotonic() + 0.8, []
        while time.monotonic() < limit:
            states.append(probe.stopped())
            time.sleep(0.05)
        assert not any(states)
        signals.close()
        assert psutil.Process(process.pid).status() != psutil.STATUS_STOPPED
    finally:
        process.kill()
        process.wait()


def await_status(process, stopped):
    """Wait until a process is stopped, or goes on."""
    limit = time.monotonic() + 20.0
    while (psutil.Process(process.pid).status() == psutil.STATUS_STOPPED) != stopped:
        assert time.monotonic() < limit
        time.sleep(0.01)


def test_a_process_that_is_stopped_for_a_while_goes_on():
    process = subprocess.Popen([sys.executable, "-c", "while True: pass"])
    try:
        Signals().stop(process.pid, 1.0)
        await_status(process, True)
        await_status(process, False)
    finally:
        process.kill()
        process.wait()


def test_a_seed_that_is_no_number_is_refused(tmp_path, capsys):
    assert command("run", write(tmp_path), "--chaos", "many") == 2
    assert "must be a whole number, 0 or more; found 'many'" in capsys.readouterr().err
