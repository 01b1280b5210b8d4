"""Thousands of windows, a pause in the middle: every answer belongs to its own request."""

import subprocess
import sys
from pathlib import Path

import pytest

SCENE = """
name = "echo"
end = 1.0
transport = "{transport}"
[components.echo]
kind = "echo"
items = 50
"""
COUPLER = """
import sys, threading, time
from pathlib import Path
import numpy as np
from quintet.coupler.launch.connect import connect
from quintet.coupler.launch.watchdog import Watchdog
from quintet.coupler.run.signals import StopRequest
from quintet.coupler.scene.read import load
folder, count = Path(sys.argv[1]), int(sys.argv[2])
connection = connect(load(str(folder / "scene.toml")), folder, Watchdog(StopRequest()))
part = connection.participants["echo"]
part.call("describe")
part.bind({}, works=[], joined=["passed", "returned"], wanted=["returned.value"])
value = np.zeros(part.give()["returned.value"].shape)
part.call("prime", {"passed.value": value})
for window in range(count):
    value[:] = window + 1.0
    part.start(1.0, {"passed.value": value}, ["passed.value"])
    if window == count // 2:
        time.sleep(8.0)  # the answer lies there for longer than a silent component may take
    returned = part.finish().fields["returned.value"]
    assert (returned == window + 0.5).all() or (returned == window + 1.0).all(), window
threads = [thread.name for thread in threading.enumerate() if thread.daemon]
connection.close(True)
assert threads == ["watchdog"], threads  # one of a library may abort the process as Python ends
(folder / "done").write_text(str(part.timing.steps))
"""
COMPONENT = ["quintet.interfaces.serving.process", "echo", "--name", "echo", "--mpi"]
OVER = [pytest.param("zenoh", marks=pytest.mark.zenoh), pytest.param("mpi", marks=pytest.mark.mpi)]


@pytest.mark.slow
@pytest.mark.parametrize("count", [2_000, pytest.param(10_000, marks=pytest.mark.full)])
@pytest.mark.parametrize("transport", OVER)
def test_no_window_is_lost_when_the_coupler_pauses(tmp_path, transport, count):
    (tmp_path / "scene.toml").write_text(SCENE.format(transport=transport))
    (tmp_path / "log").mkdir()
    (tmp_path / "coupler.py").write_text(COUPLER)
    command = [str(tmp_path / "coupler.py"), str(tmp_path), str(count)]
    if transport == "zenoh":
        command = [sys.executable, *command]
    else:
        installed = Path(sys.executable).with_name("mpiexec")
        launcher = str(installed) if installed.exists() else "mpiexec"
        python = ["-n", "1", sys.executable, "-m", "mpi4py"]
        command = [launcher, *python, *command, ":", *python, "-m", *COMPONENT]
    result = subprocess.run(command, timeout=90, capture_output=True, text=True)
    assert result.returncode == 0, result.stdout + result.stderr
    assert (tmp_path / "done").read_text() == str(count)
