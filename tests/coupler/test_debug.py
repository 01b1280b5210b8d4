"""One component of a run under a debugger: with the inputs, and to the bits, of the run."""

import io
import json
import shutil
import subprocess
import sys

import pytest
import toys
from started import TOYS, write_scene

from quintet.coupler.cli import main
from quintet.coupler.files.run_files import FAILED_ORDERS
from quintet.coupler.run import failed_orders
from quintet.coupler.run.run_scene import run_scene
from quintet.coupler.scene.read import load

FAULTS = TOYS.with_name("toy_faults.py")
SERIAL, PARALLEL = 'scheme = "serial"', 'scheme = "parallel"'
ITERATED = 'scheme = "iterated"\niteration = { tolerance = 1e-6 }'
COMPUTES = "only {} computes"


def debug(folder, component, *arguments):
    """Debug a component with commands; return the exit status."""
    with pytest.raises(SystemExit) as exit_info:
        main(["debug", str(folder), "--component", component, *map(str, arguments)])
    return exit_info.value.code


@pytest.fixture
def run(tmp_path, monkeypatch, capsys):
    """Run two toys, of which one may fail in window 60; return the folder."""

    def run(coupling=SERIAL, cause="exception", fails="pong", *settings, status=3, more=""):
        fault = f'fails_at = {60 * 3}\nfails_by = "{cause}"\nmoment = "{tmp_path}/moment"'
        toys = {"ping": "substeps = 3", "pong": "substeps = 3"}
        if fails:
            toys[fails] += f"\n{fault}"
        scene = write_scene(tmp_path, "memory", 0.1, **toys)
        text = f"{coupling}\n{scene.read_text()}{more}"
        if fails:
            head, table, tail = text.partition(f"[components.{fails}]")
            text = head + table + tail.replace("toys:Toy", "toy_faults:Faulty", 1)
        scene.write_text(text)
        shutil.copy(FAULTS, tmp_path / "toy_faults.py")
        plan = load(str(scene), settings=["output.snapshots=0.025", *settings])
        folder, exit_status = run_scene(plan, tmp_path / "out")
        assert exit_status == status
        capsys.readouterr()
        return folder

    return run


@pytest.mark.parametrize("coupling", [SERIAL, PARALLEL])
@pytest.mark.parametrize("component", ["ping", "pong"])
def test_the_window_that_failed_has_the_inputs_of_the_run(run, capsys, coupling, component):
    folder = run(coupling)
    assert debug(folder, component, "--commands", "p self.steps; p self.time") == 0
    output = capsys.readouterr().out
    assert "from snapshot-50.h5, 10 windows are repeated" in output
    assert COMPUTES.format(component) in output
    assert "window 60 reached; outputs until here have the bits of the run (10 windows" in output
    code = "toy_faults.py" if component == "pong" else "toys.py"
    assert "(Pdb) p self.steps\n180\n" in output and code in output and "step()" in output
    if component == "pong":
        assert "pong failed in window 60: ArithmeticError: asked to raise, as in the run" in output
    else:
        assert "window 60 is done; the run has no outputs of it" in output


def test_every_window_before_it_is_reached_with_the_bits_of_the_run(run, capsys):
    folder = run(PARALLEL)
    for window in (0, 24, 25, 26, 59):
        assert debug(folder, "pong", "--window", window, "--commands", "continue") == 0
        output = capsys.readouterr().out
        start = f"from snapshot-{window // 25 * 25}.h5" if window >= 25 else "from the start"
        assert f"pong, window {window} of" in output and start in output
        assert f"window {window} reached; outputs until here have the bits of the run" in output
        assert f"window {window} is done; its outputs have the bits of the run" in output


def test_a_run_that_ended_well_is_debugged_from_its_start(run, capsys):
    folder = run(fails="", status=0)
    assert not (folder / FAILED_ORDERS).exists()
    assert debug(folder, "ping", "--commands", "c") == 0
    output = capsys.readouterr().out
    assert "ping, window 99 of" in output and "from the start, 99 windows are repeated" in output
    assert "window 99 is done; its outputs have the bits of the run" in output


@pytest.mark.parametrize("fails", ["ping", "pong"])
def test_windows_that_were_repeated_are_computed_once_more(run, capsys, fails):
    folder = run(ITERATED, fails=fails)
    window = json.loads((folder / "results.json").read_text())["fault"]["window"]
    assert debug(folder, fails, "--commands", "p self.steps") == 0
    output = capsys.readouterr().out
    assert "all components compute once to find the inputs" in output
    assert f"window {window} reached; outputs until here have the bits of the run" in output
    assert "asked to raise, as in the run" in output


def test_a_value_that_is_not_finite_is_found_as_in_the_run(run, capsys):
    folder = run(cause="NaN")
    assert debug(folder, "pong", "--commands", "c") == 0
    output = capsys.readouterr().out
    assert "what it gave: every number of out.number must be finite; item 0" in output
    assert "as in the run" in output


def test_a_changed_component_is_told_from_that_of_the_run(run, capsys, monkeypatch):
    folder = run()
    step = toys.Toy.step
    monkeypatch.setattr(toys.Toy, "step", lambda self, dt: step(self, dt * (1.0 + 1e-12)))
    assert debug(folder, "ping", "--window", 40, "--commands", "c") == 1
    output = capsys.readouterr().out
    differ = "window 40 reached; outputs until here differ from those of the run: window 25, out."
    assert differ in output


def test_only_the_last_window_under_way_is_kept_of_a_failure(run):
    folder = run()
    orders = failed_orders.read(folder)
    assert {name: order.header["window"] for name, order in orders.items()} == {
        "ping": 60,
        "pong": 60,
    }
    content = bytearray((folder / FAILED_ORDERS).read_bytes())
    content[len(content) // 2] ^= 1
    (folder / FAILED_ORDERS).write_bytes(content)
    assert failed_orders.read(folder) == {}


def test_what_cannot_be_debugged_is_refused(run, capsys):
    folder = run()
    for arguments, message in (
        (["--window", 61], "--window must be at most 60: the recording has nothing of ping in"),
        (["--window", -1], "--window must be a number from 0; found -1"),
        (["--component", "pog"], "--component pog is not known. Did you mean pong?"),
        (["--debugger", "no-such-program"], "--debugger no-such-program: it cannot be started"),
    ):
        assert debug(folder, "ping", "--commands", "c", *arguments) == 2
        assert message in capsys.readouterr().err


def test_without_a_terminal_commands_are_needed(run, capsys, monkeypatch):
    folder = run()
    monkeypatch.setattr(sys, "stdin", io.StringIO())
    assert debug(folder, "ping") == 2
    assert "debug needs a terminal, for its commands; standard input is none" in (
        capsys.readouterr().err
    )


def test_the_folder_stays_as_it_is(run):
    folder = run()
    files = {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}
    debug(folder, "pong", "--window", 30, "--commands", "c")
    assert {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()} == files


def test_another_program_may_run_the_repetition(run, tmp_path):
    folder = run(cause="NaN")
    command = [sys.executable, "-m", "quintet.coupler.cli", "debug", str(folder)]
    command += ["--component", "pong", "--debugger", "env CALLED=1"]
    result = subprocess.run(command, capture_output=True, text=True, timeout=60, cwd=tmp_path)
    assert result.returncode == 0, result.stderr
    assert (
        "pong failed in window 60: what it gave" in result.stdout and "(Pdb)" not in result.stdout
    )
