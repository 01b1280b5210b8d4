"""A trace has the form that viewers read, times each component's computing, and changes no bit."""

import json
import subprocess
import sys
from collections import Counter, defaultdict

import pytest
from spring_scene import command
from started import Started, same, write_scene

from quintet.coupler.files import trace_table
from quintet.coupler.run import trace_log

PARTS = {"step", "wait", "exchange", "compile", "build"}
TRANSPORTS = (
    "memory",
    pytest.param("zenoh", marks=pytest.mark.zenoh),
    pytest.param("mpi", marks=pytest.mark.mpi),
)


def events_of(path):
    """Events of a file, which must have the form of complete events, counters and names."""
    content = json.loads(path.read_text())
    for event in content["traceEvents"]:
        assert event["ph"] in ("X", "C", "M") and event["name"]
        assert type(event["pid"]) is int and type(event["tid"]) is int
        assert type(event["ts"]) is float and event["ts"] >= 0.0
        assert event["ph"] != "X" or (type(event["dur"]) is float and event["dur"] >= 0.0)
        assert event["ph"] != "C" or all(type(v) in (int, float) for v in event["args"].values())
    return content["traceEvents"]


def tracks_of(events):
    """Slices of each track by its name; they are in order, and each lies within one before it."""
    names = {e["tid"]: e["args"]["name"] for e in events if e["name"] == "thread_name"}
    tracks, open_slices = defaultdict(list), defaultdict(list)
    times = [event["ts"] for event in events if event["ph"] != "M"]
    assert times == sorted(times)
    for event in events:
        if event["ph"] != "X":
            continue
        outer = open_slices[event["tid"]]
        while outer and outer[-1] <= event["ts"] + 1e-3:  # µs, rounding of a double
            outer.pop()
        assert not outer or event["ts"] + event["dur"] <= outer[-1] + 1e-3, event
        outer.append(event["ts"] + event["dur"])
        tracks[names[event["tid"]]].append(event)
    return tracks


def run_with_trace(scene, *arguments):
    """Run a scene with its trace; return the folder, and the slices of each track."""
    traced_run = Started(scene, "--trace", *arguments)
    assert traced_run.wait() == 0, traced_run.err
    assert command("trace", traced_run.folder) == 0
    return traced_run.folder, tracks_of(events_of(traced_run.folder / "trace.json"))


@pytest.mark.parametrize("transport", TRANSPORTS)
def test_each_window_of_each_component_is_a_slice_as_long_as_it_computed(tmp_path, transport):
    scene = write_scene(tmp_path, transport, 0.02, pong="pause = 2e-3")
    folder, tracks = run_with_trace(scene)
    assert tracks.keys() == {"coupler", "ping", "pong"}
    timing = json.loads((folder / "results.json").read_text())["timing"]["components"]
    for name in ("ping", "pong"):
        steps = [event for event in tracks[name] if event["name"] == "step"]
        assert [event["args"]["window"] for event in steps] == list(range(20))
        seconds = sum(event["dur"] for event in steps) / 1e6
        assert seconds == pytest.approx(timing[name]["compute"], rel=1e-3)
        assert {event["cat"] for event in tracks[name]} >= PARTS
    windows = [event for event in tracks["coupler"] if event["cat"] == "window"]
    assert [event["args"]["window"] for event in windows] == list(range(20))
    assert sum(event["args"]["length [s]"] for event in windows) == pytest.approx(0.02)
    counts = Counter(event["name"] for event in tracks["coupler"])
    assert counts["mapping"] >= 20 and counts["wait for pong"] >= 20
    waits = [e["dur"] for e in tracks["coupler"] if e["name"] == "wait for pong"]
    assert sum(waits) > 20 * 2e3, "µs, of its pauses"


@pytest.mark.parametrize("scheme", ["parallel", "iterated"])
def test_slices_of_all_schemes_are_nested(tmp_path, scheme):
    scene = write_scene(tmp_path, end=0.01)
    folder, tracks = run_with_trace(scene, "--set", f"scheme={scheme}")
    repetitions = json.loads((folder / "results.json").read_text())["repetitions"]
    window_repetitions = [
        e["args"]["repetitions"] for e in tracks["coupler"] if e["cat"] == "window"
    ]
    assert sum(window_repetitions) == repetitions and (repetitions > 0) == (scheme == "iterated")
    steps = [event for event in tracks["pong"] if event["name"] == "step"]
    assert len(steps) == 10 + repetitions


def test_a_trace_changes_no_result_and_none_is_left_without(tmp_path):
    scene = write_scene(tmp_path, end=0.05)
    reference = Started(scene, out=tmp_path / "plain")
    assert reference.wait() == 0
    folder, _ = run_with_trace(scene)
    assert same(reference.folder, folder)
    assert (folder / "trace.csv").is_file() and not (reference.folder / "trace.csv").exists()


def test_a_run_without_trace_loads_none_of_it(tmp_path):
    scene = write_scene(tmp_path, end=0.01)
    program = "import sys; from quintet.coupler.cli import main\ntry: main()\n"
    program += "finally: print('quintet.coupler.run.trace_log' in sys.modules)"
    for options, answer in (((), "False"), (("--trace",), "True")):
        out = ("--out", str(tmp_path / answer))
        line = [sys.executable, "-c", program, "run", str(scene), *out, *options]
        result = subprocess.run(line, capture_output=True, text=True)
        assert result.returncode == 0 and result.stdout.split()[-1] == answer, result.stderr


def test_a_resumed_run_goes_on_with_its_trace(tmp_path):
    scene = write_scene(tmp_path, end=1.0, pong="pause = 2e-3")
    traced_run = Started(scene, "--trace")
    traced_run.wait_until(lambda: (traced_run.folder / "trace.csv").is_file()
                       and (traced_run.folder / "trace.csv").stat().st_size > 20_000)  # fmt: skip
    traced_run.process.terminate()
    assert traced_run.wait() == 130
    with open(traced_run.folder / "trace.csv", "a") as file:
        file.write("pong,adv")  # as by a full disk, or a kill
    resumed_run = Started(scene, out=traced_run.folder, resumes=True)
    assert resumed_run.wait() == 0
    assert command("trace", traced_run.folder) == 0
    tracks = tracks_of(events_of(traced_run.folder / "trace.json"))
    windows = [e["args"]["window"] for e in tracks["coupler"] if e["cat"] == "window"]
    assert windows == list(range(1000))


def test_the_file_is_limited_and_its_end_told(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(trace_table, "LIMIT", 50_000)
    monkeypatch.setattr(trace_log, "LIMIT", 50_000)
    scene = write_scene(tmp_path, end=1.0)
    assert command("run", scene, "--trace", "--out", tmp_path / "out") == 0
    assert (tmp_path / "out/trace.csv").stat().st_size < 50_000 + 2 * (1 << 14)
    assert command("trace", tmp_path / "out") == 0
    assert "the trace ends before the run: trace.csv is limited" in capsys.readouterr().err
    assert tracks_of(events_of(tmp_path / "out/trace.json"))


def test_wrong_input_is_told(tmp_path, capsys):
    scene = write_scene(tmp_path, end=0.01)
    out = tmp_path / "out"
    assert command("run", scene, "--out", out) == 0
    assert command("trace", out) == 2
    message = (
        "it must have a trace (trace.csv); this run was made without. Run the scene again with"
    )
    assert message in capsys.readouterr().err
    assert command("trace", tmp_path / "none") == 2
    assert "it must be the folder of a run; it is not" in capsys.readouterr().err
    assert command("run", "--resume", out, "--trace") == 2
    assert "--trace is for the start of a run" in capsys.readouterr().err
    assert command("trace", out, "--out", tmp_path / "a.html") == 2
    assert "must end with one of .json; found .html" in capsys.readouterr().err
    (out / "trace.csv").write_text("a,b\n")
    assert command("trace", out) == 2
    assert "it must begin with the columns who,what" in capsys.readouterr().err
    (out / "trace.csv").write_text(",".join(trace_table.COLUMNS) + "\nping,give,1,x\n")
    assert command("trace", out) == 2
    assert "line 2 must have 10 cells, the last 8 numbers; found" in capsys.readouterr().err
