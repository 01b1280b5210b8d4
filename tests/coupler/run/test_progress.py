"""A run reports its progress from its first second on, and the time it still needs."""

import faulthandler
import subprocess
import sys
import threading
import time

import pytest
from started import Started, write_scene

from quintet.coupler.cli import main
from quintet.coupler.run.progress import Pace, Reading, details, time_left
from quintet.coupler.run.start_report import last_line
from quintet.interfaces.lines.process_status import running
from quintet.interfaces.serving.notices import listen, notice


def paced(readings, start=100.0):
    """The pace of readings at each of these seconds."""
    pace = Pace()
    for seconds, reading in readings:
        pace.add(reading, start + seconds)
    return pace


def test_time_left_follows_from_the_last_seconds_and_not_from_the_first_window():
    # 60 s of compilation, then 0.1 s for each window of 1 ms.
    pace = paced([(60.0 + 0.1 * k, Reading(k, 1e-3 * k)) for k in range(1, 101)])
    assert pace.left(1.8) == pytest.approx(170.0)
    assert pace.windows == pytest.approx(10.0)
    assert time_left(pace, 1.8) == "3 min left" and time_left(pace, 0.3) == "20 s left"


def test_what_became_slower_counts_after_a_while():
    fast = [(0.01 * k, Reading(k, 1e-3 * k)) for k in range(1, 1001)]
    slow = [(10.0 + 0.1 * k, Reading(1000 + k, 1.0 + 1e-3 * k)) for k in range(1, 401)]
    assert paced(fast + slow).left(1.8) == pytest.approx(40.0)


def test_nobody_tells_the_time_left_of_the_first_window():
    pace = paced([(0.0, Reading(1, 1e-3))])
    assert time_left(pace, 1.0) == ""
    assert details(Reading(1, 1e-3), pace) == ["window 1"]


def test_who_computes_and_how_often_windows_are_repeated_is_told():
    begin = Reading(1, 1e-3, 0.0, {"water": 50.0, "cubes": 20.0}, 0)
    end = Reading(101, 0.101, 1e-16, {"water": 59.0, "cubes": 20.5}, 250)
    texts = details(end, paced([(0.0, begin), (10.0, end)]))
    assert texts[1:] == [
        "10 windows/s",
        "water computes 90%",
        "cubes computes 5%",
        "windows repeated 2.5 times",
        "momentum residual 1e-16",
    ]


def test_the_last_line_of_a_log_says_what_a_component_is_at(tmp_path):
    log = tmp_path / "water.log"
    assert last_line(log) == "starting"
    log.write_text("water: a fluid, process 1\ncompiling pair_rates\n\n")
    assert last_line(log) == "compiling pair_rates"


def test_neither_a_stack_nor_a_former_log_is_what_a_component_does(tmp_path):
    log = tmp_path / "water.log"
    log.write_text("water: finished\n")
    former_size = log.stat().st_size
    assert last_line(log, former_size) == "starting"
    with open(log, "a") as file:
        file.write("building\n")
        faulthandler.dump_traceback(file)
    assert last_line(log, former_size) == "building"


def test_a_run_without_links_has_no_residual():
    assert details(Reading(3, 0.1), Pace()) == ["window 3"]
    assert details(Reading(3, 0.1, 0.0), Pace()) == ["window 3", "momentum residual 0e+00"]


def test_a_reader_that_leaves_silences_the_screen_and_the_run_goes_on(tmp_path):
    run = Started(write_scene(tmp_path, end=0.3))
    run.process.stdout.readline()
    run.process.stdout.close()
    run.process.stdout = None
    assert run.wait() == 0, run.err
    assert run.results["status"] == "done" and "Broken pipe" not in run.err


def test_notices_are_heard_by_who_listens_and_by_nobody_else():
    notices = []
    listen(notices.append)
    notice("compiling step")
    listen(None)
    notice("building")
    assert notices == ["compiling step"]


def test_the_first_word_of_a_run_names_what_runs(tmp_path, capsys):
    path = write_scene(tmp_path, end=0.005)
    with pytest.raises(SystemExit):
        main(["run", str(path), "--out", str(tmp_path / "out")])
    lines = capsys.readouterr().out.splitlines()
    messages = [line for line in lines if "is code: importing" not in line]  # once in a process
    assert messages[0].startswith("toy: ping (toys:Toy), pong (toys:Toy) over memory, into ")
    assert any(line.startswith("t = 0.001 of 0.005 s, window 1,") for line in messages)


SLOW = """
import time
from quintet.interfaces.serving.notices import notice
from toys import Toy
class Slow(Toy):
    '''Takes long before its first step.'''
    compiles = True
    def __init__(self, params):
        super().__init__(params)
        time.sleep(0.5)
    def take(self, fields):
        assert fields["in.number"].shape == (5, 3)
        super().take(fields)
    def step(self, dt):
        if self.compiles:
            self.compiles = False
            notice("reading the mesh")
            time.sleep(3.0)
        super().step(dt)
"""


@pytest.mark.parametrize("transport", ["memory", pytest.param("zenoh", marks=pytest.mark.zenoh)])
def test_what_takes_long_before_the_first_window_is_on_the_screen(tmp_path, transport):
    path = write_scene(tmp_path, transport, 0.02)
    (tmp_path / "slow.py").write_text(SLOW)
    path.write_text(path.read_text().replace("toys:Toy", "slow:Slow"))
    run = Started(path)
    assert run.wait() == 0, run.err
    assert "reading the mesh" in run.out.split("window 1,")[0]
    timing = run.results["timing"]
    builds = 2 if transport == "memory" else 1  # processes of their own prepare side by side
    assert 1.0 <= timing["build"] < 3.0, "of both"
    for times in timing["components"].values():
        assert times["build"] >= 0.5 and times["wait"] <= timing["wall"] - 3.5
    assert 3.0 * builds <= timing["compile"] and timing["wall"] >= 3.0 * builds


@pytest.mark.zenoh
def test_a_component_that_joins_by_hand_is_told_how(tmp_path):
    path = write_scene(tmp_path, "zenoh", 0.02)
    run = Started(path, "--elsewhere", "pong", "--set", "window=2e-3")
    lines, awaited = [], threading.Event()

    def read():
        for line in run.process.stdout:
            lines.append(line)
            if "awaited" in line:
                awaited.set()

    reader = threading.Thread(target=read)
    reader.start()
    try:
        assert awaited.wait(30.0)
        command = next(line for line in lines if "awaited" in line).partition(": ")[2].split()
        assert command[:2] == ["quintet", "join"] and "window=2e-3" in command
        start = time.monotonic()
        join_command = [sys.executable, "-m", "quintet.coupler.cli", *command[1:]]
        subprocess.run(join_command, check=True, cwd=tmp_path, capture_output=True, timeout=60)
        while running(run.process.pid) and time.monotonic() - start < 60.0:
            time.sleep(0.05)
    finally:
        run.end()
        reader.join()
        run.process.wait()
        run.process.stderr.close()
        run.process.stdout.close()
    assert run.results["status"] == "done" and run.results["windows"] == 10
