"""Lines over MPI: the same bytes as in memory, large messages whole, no waiting in the library."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from quintet.interfaces.lines.memory import MemoryLine

pytestmark = pytest.mark.mpi
MPIEXEC = Path(sys.executable).with_name("mpiexec")

# Rank 1 sends, rank 0 writes down the frames that came, and what waiting for them cost it.
RANKS = """
import sys, time
import numpy as np
from mpi4py import MPI
from quintet.interfaces.lines.mpi import MpiLine, self_check
self_check(2)
rank = MPI.COMM_WORLD.rank
line = MpiLine("r1", "coupler", "other", 1 - rank)
sizes = (0, 1, 1000, 200_000)
if rank == 1:
    random = np.random.default_rng(0)
    for size in sizes:
        fields = {"surface.position": random.random((size, 3)), "n": np.arange(size)}
        line.send({"order": "advance", "window": size}, fields)
    line.receive(60.0)
    time.sleep(1.0)
    line.send({"order": "late"}, {})
else:
    for number in range(len(sizes)):
        frame = None
        while frame is None:
            frame = line._poll()
        with open(f"{sys.argv[1]}/{number}", "wb") as file:
            file.write(bytes(frame))
    line._received = len(sizes)
    line.send({"order": "go on"}, {})
    began = time.process_time()
    assert line.receive(10.0).order == "late"
    spent = time.process_time() - began
    with open(f"{sys.argv[1]}/spent", "w") as file:
        file.write(str(spent))
"""


@pytest.fixture(scope="module")
def carried(tmp_path_factory):
    folder = tmp_path_factory.mktemp("frames")
    program = folder / "ranks.py"
    program.write_text(RANKS)
    launcher = str(MPIEXEC) if MPIEXEC.exists() else "mpiexec"
    command = [launcher, "-n", "2", sys.executable, "-m", "mpi4py", str(program), str(folder)]
    process = subprocess.run(command, timeout=60, capture_output=True, text=True)
    assert process.returncode == 0, process.stderr
    return folder


def test_memory_and_mpi_carry_the_same_bytes(carried):
    memory, frames = MemoryLine("r1", "coupler"), []
    put = memory._put
    memory._put = lambda frame: frames.append(bytes(frame)) or put(frame)
    random = np.random.default_rng(0)
    for number, size in enumerate((0, 1, 1000, 200_000)):
        fields = {"surface.position": random.random((size, 3)), "n": np.arange(size)}
        memory.send({"order": "advance", "window": size}, fields)
        assert (carried / str(number)).read_bytes() == frames[number]


def test_a_waiting_rank_leaves_the_processor_to_others(carried):
    assert float((carried / "spent").read_text()) < 0.25  # s, of a wait of one second


def test_a_launcher_of_another_library_is_refused():
    code = "from quintet.interfaces.lines import mpi; mpi.self_check(3)"
    process = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, timeout=30
    )
    assert process.returncode == 1
    assert (
        "MPI started 1 ranks where 3 were launched: the launcher and the library" in process.stderr
    )
