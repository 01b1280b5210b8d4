"""Of components that end one after another in one MPI job, the first to die is named."""

import os
import subprocess
import sys

import pytest

from quintet.coupler.coupling.participant import ComponentFailed, Participant
from quintet.coupler.launch.process_probe import ProcessProbe
from quintet.coupler.launch.ranks_probe import RanksProbe
from quintet.coupler.launch.watchdog import Watchdog
from quintet.coupler.run.signals import StopRequest
from quintet.interfaces.lines.memory import MemoryLine


@pytest.fixture
def ended_pid():
    """Number of a process that has ended."""
    process = subprocess.Popen([sys.executable, "-c", ""])
    process.wait()
    return process.pid


@pytest.fixture
def watchdog():
    watchdog = Watchdog(StopRequest(), in_main_thread=False)
    yield watchdog
    watchdog.close()


def watch(watchdog, name, probe):
    """Watch a component; return a function that asks why it does not answer."""
    participant = Participant(name, MemoryLine("", name))
    watchdog.add(participant, probe, 60.0)
    return participant.line.watch


def test_who_was_killed_with_the_job_is_not_blamed(watchdog, ended_pid, tmp_path):
    files = [tmp_path / f"chain.rank{rank}" for rank in (0, 1)]
    files[1].write_text("0")  # the launcher kills the others, which write nothing
    ask = watch(
        watchdog, "pusher", ProcessProbe("pusher", ended_pid, exit_file=tmp_path / "pusher")
    )
    ranks = [
        ProcessProbe(f"rank {k} on vm", ended_pid, exit_file=file) for k, file in enumerate(files)
    ]
    watch(watchdog, "chain", RanksProbe("chain", ranks=ranks))
    with pytest.raises(
        ComponentFailed, match=r"rank 1 on vm: process.* ended by itself"
    ) as error_info:
        ask()
    assert error_info.value.component == "chain"


def test_who_died_alone_is_blamed(watchdog, ended_pid, tmp_path):
    (tmp_path / "pusher").write_text("137")
    ask = watch(
        watchdog, "pusher", ProcessProbe("pusher", ended_pid, exit_file=tmp_path / "pusher")
    )
    watch(watchdog, "chain", ProcessProbe("chain", os.getpid()))
    assert "was killed by signal 9 (SIGKILL)" in ask()
