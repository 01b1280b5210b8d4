"""A run that receives a signal ends in order; a run whose coupler is killed does not go on."""

import json
import os
import pty
import select
import signal
import time

import pytest
from started import Started, write_scene

from quintet.coupler.cli import main
from quintet.coupler.files.recording import Recording
from quintet.coupler.run import results
from quintet.coupler.run.snapshots import snapshots

OVER = [pytest.param("zenoh", marks=pytest.mark.zenoh), pytest.param("mpi", marks=pytest.mark.mpi)]
IN_TURN = {  # one transport by default, all of them under -m full
    default: [
        pytest.param(name, marks=[*marks, *([] if name == default else [pytest.mark.full])])
        for name, *marks in (("memory",), ("zenoh", pytest.mark.zenoh), ("mpi", pytest.mark.mpi))
    ]
    for default in ("memory", "zenoh")
}
SOON = 2.0 + 1.0  # s: the promise of the README, and 1 s for the other tests on the machine
LONG = 60.0  # s, of a window that nothing waits for
LOADED = 20.0  # s that a loaded machine may need for an immediate action; less than LONG


def running(folder, transport):
    """A run in the middle of its windows."""
    run = Started(write_scene(folder, transport, 1000.0, pong="pause = 1e-3"))
    run.wait_for_windows()
    return run


def interrupted(tmp_path, transport, number):
    """Interrupt a run in the middle of its windows; return it and the seconds until it ended."""
    if transport == "memory":  # its log is the terminal's
        run = Started(write_scene(tmp_path, transport, 1000.0, pong="pause = 1e-3"))
        run.wait_until(lambda: (run.folder / "recording.h5").is_file())
        time.sleep(1.5)
    else:
        run = running(tmp_path, transport)
    start = time.monotonic()
    if number == signal.SIGINT:  # a terminal sends it to all of the foreground
        os.killpg(run.process.pid, number)
    else:
        run.process.send_signal(number)
    run.out, run.err = run.process.communicate(timeout=30)
    seconds = time.monotonic() - start
    processes = run.processes()
    run.end()
    print(f"{transport} {number.name}: ended after {seconds:.2f} s")
    assert not processes
    return run, seconds


def check_interrupted(run, transport, number):
    """The run has ended in order, and has kept all of its windows."""
    assert run.process.returncode == 130
    results = run.results
    assert results["status"] == "interrupted" and results["windows"] >= 50
    assert "fault" not in results
    with Recording(run.folder) as recording:
        for name in ("ping", "pong"):
            assert len(recording.times(name)) == results["windows"] + 1
    assert not run.left_in_shared_memory()
    assert f"{number.name}: ending after this window" in run.err
    if transport != "memory":
        assert "finished" in (run.folder / "log" / "pong.log").read_text()


@pytest.mark.parametrize(
    ("transport", "number"),
    [
        ("memory", signal.SIGTERM),
        pytest.param("zenoh", signal.SIGINT, marks=pytest.mark.zenoh),
        pytest.param("mpi", signal.SIGTERM, marks=pytest.mark.mpi),
    ],
)
def test_an_interrupted_run_keeps_what_it_has(tmp_path, transport, number):
    run, seconds = interrupted(tmp_path, transport, number)
    assert seconds < LOADED
    check_interrupted(run, transport, number)


@pytest.mark.full
@pytest.mark.parametrize("transport", ["memory", *OVER])
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupted_run_ends_in_time(tmp_path, transport, number):
    run, seconds = interrupted(tmp_path, transport, number)
    assert seconds < SOON
    check_interrupted(run, transport, number)


@pytest.fixture
def interrupt_handler():
    """Interruptions raise `KeyboardInterrupt`: shells start background jobs that ignore them."""
    handler = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, handler)


@pytest.mark.usefixtures("interrupt_handler")
def test_an_interruption_while_pictures_are_drawn_keeps_the_results(tmp_path, monkeypatch, capsys):
    def interrupt(*_):
        os.kill(os.getpid(), signal.SIGINT)
        time.sleep(10.0)

    monkeypatch.setattr(results, "draw_run", interrupt)
    monkeypatch.setattr(results, "view_files", lambda _: [tmp_path])
    path = write_scene(tmp_path, end=0.01)
    with pytest.raises(SystemExit) as exit_info:
        main(["run", str(path), "--set", "output.pictures=[0.01]", "--out", str(tmp_path / "out")])
    screen = capsys.readouterr()
    assert exit_info.value.code == 130, "the exit status must be that of an interruption"
    assert "pictures left out" in screen.err and "Traceback" not in screen.err
    assert "toy: done, 10 windows" in screen.out
    run_results = json.loads((tmp_path / "out" / "results.json").read_text())
    assert run_results["status"] == "done" and run_results["windows"] == 10


@pytest.mark.zenoh
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_second_request_does_not_wait_for_the_window(tmp_path, number):
    """The first one alone would wait: the window has a minute left, and as much grace."""
    scene = write_scene(tmp_path, "zenoh", 1000.0, pong=f"pause = {LONG}")
    run = Started(scene, "--grace", str(LONG))
    run.wait_until(lambda: (run.folder / "recording.h5").is_file())
    time.sleep(0.5)
    start = time.monotonic()
    run.process.send_signal(number)
    assert any("ending after this window" in line for line in run.process.stderr)
    run.process.send_signal(number)
    run.process.communicate(timeout=LONG)
    assert run.process.returncode == 130 and time.monotonic() - start < LOADED
    assert run.results["status"] == "interrupted" and not run.processes()


def wait_for_the_end(run, start):
    while run.processes():
        assert time.monotonic() - start < LOADED, "components outlived their coupler"
        time.sleep(0.02)
    return time.monotonic() - start


@pytest.mark.zenoh
def test_components_end_when_their_coupler_is_killed(tmp_path):
    run = running(tmp_path, "zenoh")
    start = time.monotonic()
    run.process.kill()
    try:
        print(f"zenoh: ended {wait_for_the_end(run, start):.2f} s after the coupler")
    finally:
        run.end()
        run.process.communicate()
    assert run.results["fault"]["component"] == "coupler", "its companion has written it down"
    assert not run.left_in_shared_memory()


@pytest.mark.mpi
@pytest.mark.parametrize("victim", ["the process that started the job", "the coupler's rank"])
def test_an_mpi_job_ends_when_its_coupler_is_killed(tmp_path, victim):
    run = running(tmp_path, "mpi")
    start = time.monotonic()
    if "rank" in victim:
        note = (run.folder / "log" / "mpi.json").read_text()
        os.kill(int(note.partition('"coupler": ')[2].partition(",")[0]), signal.SIGKILL)
    else:
        run.process.kill()
    try:
        print(f"mpi: ended {wait_for_the_end(run, start):.2f} s after {victim}")
        err = run.process.communicate(timeout=10)[1]
    finally:
        run.end()
    if "rank" in victim:
        assert run.process.returncode == 3
        assert "quintet: the coupler was killed by signal 9 (SIGKILL)" in err
        assert run.results["fault"]["component"] == "coupler"
    else:
        assert run.results["status"] == "interrupted"
    assert not run.left_in_shared_memory()


@pytest.mark.parametrize("transport", IN_TURN["memory"])
def test_a_run_whose_terminal_is_closed_leaves_a_snapshot(tmp_path, transport):
    path = write_scene(tmp_path, transport, 1000.0, pong="pause = 1e-3")
    out, command = tmp_path / "out", Started.command(path)
    pid, terminal = pty.fork()
    if not pid:
        signal.signal(
            signal.SIGHUP, signal.SIG_DFL
        )  # under nohup it is ignored, and that is passed on
        os.execv(command[0], [*command, "--out", str(out)])
    read_until(terminal, lambda: (out / "recording.h5").is_file())
    start = time.monotonic()
    read_until(terminal, lambda: time.monotonic() > start + 1.0)
    os.close(terminal)
    assert status_within(20.0, pid) == 130
    run_results = json.loads((out / "results.json").read_text())
    assert run_results["status"] == "interrupted" and "--resume" in run_results["resume"]
    assert [path.name for path in snapshots(out)] == [f"snapshot-{run_results['windows']}.h5"]


@pytest.mark.parametrize("transport", IN_TURN["zenoh"])
def test_a_run_under_nohup_goes_on_without_its_terminal(tmp_path, transport):
    path = write_scene(tmp_path, transport, 1000.0, pong="pause = 1e-3")
    handler = signal.signal(signal.SIGHUP, signal.SIG_IGN)  # as nohup does; children inherit it
    try:
        run = Started(path)
    finally:
        signal.signal(signal.SIGHUP, handler)
    run.wait_until(lambda: (run.folder / "recording.h5").is_file())
    os.killpg(run.process.pid, signal.SIGHUP)
    time.sleep(1.0)
    assert run.process.poll() is None
    run.process.send_signal(signal.SIGTERM)
    run.process.communicate(timeout=30)
    run.end()
    assert run.process.returncode == 130 and "fault" not in run.results


def status_within(seconds, pid):
    """Exit status of a child that ends soon; it is killed if it does not."""
    limit = time.monotonic() + seconds
    while time.monotonic() < limit:
        ended_pid, status = os.waitpid(pid, os.WNOHANG)
        if ended_pid:
            return os.waitstatus_to_exitcode(status)
        time.sleep(0.05)
    os.kill(pid, signal.SIGKILL)
    os.waitpid(pid, 0)
    raise AssertionError(f"still running {seconds:g} s later")


def read_until(terminal, condition):
    """Read the output on a terminal until a condition holds."""
    limit = time.monotonic() + 60.0
    while not condition():
        assert time.monotonic() < limit
        if select.select([terminal], [], [], 0.05)[0]:
            os.read(terminal, 1 << 12)


@pytest.mark.full
@pytest.mark.parametrize("transport", ["memory", *OVER])
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("delay", [0.0, 0.05, 0.1, 0.2, 0.3, 0.5, 0.8, 1.2])
def test_a_signal_in_any_phase_leaves_results_and_nothing_else(tmp_path, transport, number, delay):
    """Building, starting, joining, the first window; the delay counts from the new folder."""
    run = Started(write_scene(tmp_path, transport, 1000.0, pong="pause = 1e-3"))
    run.wait_until((run.folder / "scene.toml").is_file)
    time.sleep(delay)
    os.killpg(run.process.pid, number) if number == signal.SIGINT else run.process.terminate()
    run.out, run.err = run.process.communicate(timeout=30)
    processes, shared = run.left_processes(5.0), run.left_in_shared_memory()
    run.end()
    assert not processes and not shared
    assert run.process.returncode in (130, -number), "the latter before signals are handled"
    assert "Traceback" not in run.err
    if run.process.returncode == 130 and "quintet: interrupted" not in run.err:
        assert run.results["status"] == "interrupted"
