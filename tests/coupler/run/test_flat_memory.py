"""Memory does not grow with the number of windows."""

import ctypes
import gc
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from started import write_scene

from quintet.coupler.files.recording import Instant, Recorder
from quintet.interfaces.component import Field, Port

WINDOWS = 5000
MOST = 60  # bytes in each window; HDF5's own list of chunks grows by some 25
MOST_OF_RUN = 100  # over zenoh it grows by some 60
PORT = Port("out", (Field("number", (3,), "m"), Field("push", (3,), "N", "impulse")))
RUN = """
import ctypes, gc, os, sys
import psutil
from quintet.coupler.cli import main
from quintet.coupler.run.output import OutputWriter
plain = OutputWriter.end_window
def held(pid):
    with open(f"/proc/{pid}/smaps_rollup") as file:
        return next(1024 * int(line.split()[1]) for line in file if line.startswith("Pss_Anon"))
def end_window(self, coupling):
    plain(self, coupling)
    if coupling.windows.done in (1000, 1000 + WINDOWS):
        gc.collect()
        ctypes.CDLL(None).malloc_trim(0)
        pids = [os.getpid(), *(process.pid for process in psutil.Process().children())]
        print("HELD", *map(held, pids), flush=True)
OutputWriter.end_window = end_window
sys.argv = ["quintet", "run", sys.argv[1], "--out", sys.argv[2]]
main()
"""


def process_memory():
    """Memory of this process alone [bytes]."""
    gc.collect()
    ctypes.CDLL(None).malloc_trim(0)
    lines = Path("/proc/self/smaps_rollup").read_text().splitlines()
    return next(1024 * int(line.split()[1]) for line in lines if line.startswith("Pss_Anon"))


def test_a_recording_is_not_kept_in_memory(tmp_path):
    fields = {"out.number": np.zeros((5, 3)), "out.push": np.zeros((5, 3))}
    with Recorder(tmp_path / "recording.h5", "run", "scene") as recorder:
        names = ("ping", "pong")
        for name in names:
            recorder.component(name, (PORT,), {})
        memory_at_start = 0
        for window in range(1000 + WINDOWS):
            if window == 1000:
                memory_at_start = process_memory()
            for name in names:
                recorder.add(name, Instant(1e-3 * window, window), fields)
        growth = (process_memory() - memory_at_start) / WINDOWS
    assert growth < MOST


@pytest.mark.slow
@pytest.mark.parametrize(
    "transport", ["memory", pytest.param("zenoh", marks=[pytest.mark.zenoh, pytest.mark.full])]
)
def test_a_run_holds_as_much_after_thousands_of_windows(tmp_path, transport):
    scene = write_scene(tmp_path, transport, 1e-3 * (1001 + WINDOWS))
    code = RUN.replace("WINDOWS", str(WINDOWS))
    result = subprocess.run(
        [sys.executable, "-c", code, str(scene), str(tmp_path / "out")],
        capture_output=True,
        text=True,
        timeout=200,
    )
    assert result.returncode == 0, result.stderr
    first, last = (
        list(map(int, line.split()[1:])) for line in result.stdout.splitlines() if "HELD" in line
    )
    growths = [(after - before) / WINDOWS for before, after in zip(first, last, strict=True)]
    assert len(growths) == (4 if transport == "zenoh" else 2)  # including the companion process
    assert max(growths) < MOST_OF_RUN, growths
