"""A sweep runs each combination once, also after interruptions."""

import csv
import json
import os
import signal
import subprocess
import sys
import time
from collections import Counter
from concurrent.futures import ProcessPoolExecutor

import pytest
from spring_scene import command, command_json, write
from started import write_scene

import quintet
from quintet.coupler.scene.read import load
from quintet.coupler.scene.sweep_axes import values_of
from quintet.coupler.study.run_hash import run_hash

STEP, STIFFNESS = "components.spring.step", "components.spring.stiffness"
OVER = ("--over", f"{STEP}=0.02,0.01", "--over", f"{STIFFNESS}=100,50.0")


def journal(folder):
    """Lines of the journal of a sweep: run and event."""
    path = folder / "sweep.log"
    lines = path.read_text().splitlines() if path.is_file() else []
    return [tuple(line.split()[1:]) for line in lines]


def starts(folder):
    """How often each run was started or resumed."""
    return Counter(run for run, event in journal(folder) if event in ("started", "resumed"))


def begin(path, *arguments):
    """Start a sweep in a process of its own, in a session of its own."""
    line = [sys.executable, "-m", "quintet.coupler.cli", "sweep", str(path), *arguments]
    line += ["--out", str(path.parent / "all")]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    return subprocess.Popen(line, text=True, start_new_session=True, **pipes)


def wait_for(condition, seconds=60.0):
    limit = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < limit, "it did not come to that"
        time.sleep(0.01)


@pytest.mark.slow
def test_a_sweep_runs_the_product_of_the_values_once(tmp_path, capsys):
    path = write(tmp_path)
    status, report = command_json("sweep", path, *OVER)
    out = tmp_path / "all"
    assert status == 0 and report["over"] == {STEP: [0.02, 0.01], STIFFNESS: [100, 50.0]}
    settings = [tuple(row["settings"].values()) for row in report["rows"]]
    assert settings == [(0.02, 100), (0.02, 50.0), (0.01, 100), (0.01, 50.0)]
    assert len({row["run"] for row in report["rows"]}) == 4
    for row in report["rows"]:
        run = quintet.load(out / row["run"])
        assert run.scene["components"]["spring"]["step"] == row["settings"][STEP]
        assert row["values"]["end"] == run.expectations["end"]["value"]
        assert row["cpu"] > 0.0 and row["wall"] > 0.0
    with open(out / "sweep.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["end [m]"]) for row in rows] == [r["values"]["end"] for r in report["rows"]]
    assert [row["status"] for row in rows] == 4 * ["done"] and rows[0][STIFFNESS] == "100"
    assert (out / "sweep.png").read_bytes().startswith(b"\x89PNG")
    assert "4 of 4 runs" in capsys.readouterr().out

    arguments = (*OVER[:-1], f"{STIFFNESS}=50,100,25")  # of three values two are there
    status, report = command_json("sweep", path, *arguments)
    assert [row["kept"] for row in report["rows"]] == [True, True, False, True, True, False]
    assert sorted(starts(out).values()) == 6 * [1]
    assert "4 found complete" in capsys.readouterr().out
    assert {row["run"] for row in report["rows"]} == set(starts(out))


def test_values_are_those_of_toml_or_words():
    assert values_of("1,2.5,1e-3") == (1, 2.5, 1e-3)
    assert values_of("serial,parallel") == ("serial", "parallel")
    assert values_of('"a,b",true') == ("a,b", True)
    assert values_of("[0.0, 1.0],[2.0, 3.0]") == ([0.0, 1.0], [2.0, 3.0])


WRONG = {
    "no key": ((), "sweep needs a key to vary. Give --over KEY=VALUE,VALUE."),
    "no values": (("window",), "--over needs KEY=VALUE,VALUE; found 'window'."),
    "empty": (("window=",), "--over window: there must be values"),
    "empty value": (("window=1e-3,,2e-3",), "--over window: there is no value"),
    "half a list": ((f"{STEP}=[1,2",), f"--over {STEP}: it must be one value of TOML"),
    "a key twice": (("end=1", "end=2"), "--over end: a key must be given once; found it 2 times."),
    "a value twice": (("end=1,2,1",), "--over end: a value must be given once; found 1 twice."),
    "unknown key": (
        ("components.spring.stp=1.0,2.0", "end=1.0,2.0"),
        "components.spring.stp is not known. Did you mean step? (in all 4 combinations)",
    ),
    "a value": (
        (f"{STEP}=0.02,-1.0", "end=1.0"),
        f"scene.toml: {STEP} should be greater than 0; found -1.0. Correct it. (with {STEP}=-1.0, "
        "end=1.0)",
    ),
    "a value in several": (
        (f"{STEP}=0.02,-1.0", "end=1.0,2.0,3.0"),
        f"Correct it. (with {STEP}=-1.0, end=1.0 and 2 more of 6 combinations)",
    ),
    "the same run": (("end=1,1.0",), "sweep: end=1 and end=1.0 are the same run. Remove one"),
    "too many": (
        (f"end={','.join(map(str, range(1, 400)))}", f"{STEP}={','.join(map(str, range(1, 400)))}"),
        "sweep: there must be at most 100000 runs; found 159201. Leave some out.",
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", WRONG)
def test_wrong_keys_and_values_are_refused_before_anything_starts(tmp_path, capsys, case):
    texts, sentence = WRONG[case]
    arguments = [argument for text in texts for argument in ("--over", text)]
    assert command("sweep", write(tmp_path), *arguments, "--out", tmp_path / "all") == 2
    assert sentence in capsys.readouterr().err
    assert not (tmp_path / "all").exists()


def test_folders_of_others_are_left_alone(tmp_path, capsys):
    path = write(tmp_path)
    (tmp_path / "all").mkdir()
    (tmp_path / "all" / "letter.txt").write_text("mine")
    assert command("sweep", path, *OVER, "--out", tmp_path / "all") == 2
    assert "holds files that no run left (letter.txt)" in capsys.readouterr().err
    assert command("sweep", path, *OVER, "--jobs", 0, "--out", tmp_path / "new") == 2
    assert "--jobs must be 1 or more" in capsys.readouterr().err


@pytest.mark.slow
def test_of_a_sweep_that_is_killed_only_the_runs_under_way_are_repeated(tmp_path):
    path = write(tmp_path)
    arguments = ("--over", f"{STEP}=0.02,0.01,0.005,0.004,0.0025,0.002", "--jobs", "2")
    first = begin(path, *arguments)
    done = lambda: sum(event == "done" for _, event in journal(tmp_path / "all"))  # noqa: E731
    wait_for(lambda: done() >= 2)
    os.killpg(first.pid, signal.SIGKILL)
    first.communicate()
    assert done() < 6
    second = begin(path, *arguments)
    output, errors = second.communicate(timeout=100)
    assert second.returncode == 0, errors
    run_starts = starts(tmp_path / "all")
    assert len(run_starts) == 6 and run_starts.total() <= 6 + 2, journal(tmp_path / "all")
    assert "6 of 6 runs" in output and not list((tmp_path / "all").glob("*.lock.lock"))


@pytest.mark.slow
def test_two_sweeps_at_once_share_the_runs(tmp_path):
    path = write(tmp_path)
    processes = [begin(path, *OVER, "--jobs", "1") for _ in range(2)]
    for process in processes:
        output, errors = process.communicate(timeout=100)
        assert process.returncode == 0, errors
        assert "4 of 4 runs" in output
    assert sorted(starts(tmp_path / "all").values()) == 4 * [1]


@pytest.mark.slow
def test_an_interrupted_run_goes_on_from_its_snapshot(tmp_path):
    path = write_scene(tmp_path, end=0.3, pong="pause = 5e-3")
    arguments = ("--over", "components.ping.items=5")
    first = begin(path, *arguments)
    out = tmp_path / "all"
    wait_for(lambda: list(out.glob("*/recording.h5")))
    time.sleep(0.3)
    first.send_signal(signal.SIGINT)
    output, _ = first.communicate(timeout=30)
    assert first.returncode == 130 and "interrupted" in output
    second = begin(path, *arguments)
    output, errors = second.communicate(timeout=60)
    assert second.returncode == 0, errors
    events = [event for _, event in journal(out)]
    assert events == ["started", "interrupted", "resumed", "done"]
    (run,) = out.glob("*/results.json")
    assert json.loads(run.read_text())["windows"] == 300


@pytest.mark.slow
def test_runs_that_fail_are_told_and_tried_again_by_the_next_start(tmp_path, capsys):
    path = write_scene(tmp_path, end=0.01, pong="fails_at = 3")
    arguments = ("--over", "components.pong.fails_by=raise,kill", "--retry", "1")
    for number in (1, 2):
        status, report = command_json("sweep", path, *arguments)
        assert status == 3 and [row["status"] for row in report["rows"]] == 2 * ["failed"]
        assert "asked to raise" in report["rows"][0]["cause"]
        output = capsys.readouterr().out
        assert "2 runs failed: the same command tries them again" in output
        error_starts, kill_starts = (starts(tmp_path / "all")[row["run"]] for row in report["rows"])
        assert error_starts == number, "an error would come again"
        assert kill_starts == 2 * number, "a process that was killed from outside is tried again"


@pytest.mark.slow
def test_a_sweep_from_python_takes_any_executor(tmp_path):
    path = write(tmp_path)
    with ProcessPoolExecutor(2) as executor:
        sweep = quintet.sweep(path, {STEP: [0.02, 0.01]}, out=tmp_path / "all", executor=executor)
    assert sweep.ok and [row["status"] for row in sweep.rows] == 2 * ["done"]
    second_sweep = quintet.sweep(path, {STEP: [0.02, 0.01]}, out=tmp_path / "all")
    assert [row["kept"] for row in second_sweep.rows] == [True, True]
    with pytest.raises(quintet.SceneError, match="there must be a list of values"):
        quintet.sweep(path, {STEP: 0.02})


@pytest.mark.slow
def test_results_that_were_changed_are_made_again(tmp_path):
    path = write(tmp_path)
    _, report = command_json("sweep", path, "--over", f"{STEP}=0.02")
    folder = tmp_path / "all" / report["rows"][0]["run"]
    results = folder / "results.json"
    results.write_text(results.read_text().replace('"met": false', '"met": true'))
    _, report = command_json("sweep", path, "--over", f"{STEP}=0.02")
    assert not report["rows"][0]["kept"] and starts(folder.parent)[folder.name] == 2
    assert '"met": false' in results.read_text()


def test_the_hash_is_of_all_that_results_depend_on(tmp_path):
    path = write(tmp_path, 'title = "as before"\n' and "")
    plain_hash = run_hash(load(str(path)))
    text = path.read_text()
    assert run_hash(load(str(path), "", [f"{STEP}=0.01"])) != plain_hash
    assert run_hash(load(str(path), "", [f"{STIFFNESS}=100"])) == plain_hash, "100 is 100.0"
    path.write_text(f'title = "a title changes nothing"\n{text}')
    assert run_hash(load(str(path))) == plain_hash
    path.write_text(text)
    code = tmp_path / "toy_spring.py"
    code.write_text(f"import own_numbers\n{code.read_text()}")
    own_import_hash = run_hash(load(str(path)))
    assert own_import_hash != plain_hash
    (tmp_path / "own_numbers.py").write_text("NUMBER = 1\n")
    imported_hash = run_hash(load(str(path)))
    assert imported_hash != own_import_hash, "code that the kind's module imports counts too"
    (tmp_path / "elsewhere").mkdir()
    for file in ("scene.toml", "toy_spring.py", "own_numbers.py"):
        (tmp_path / "elsewhere" / file).write_bytes((tmp_path / file).read_bytes())
    assert run_hash(load(str(tmp_path / "elsewhere" / "scene.toml"))) == imported_hash
