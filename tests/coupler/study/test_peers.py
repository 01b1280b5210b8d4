"""A study beside another program: its measurements, kept runs, pictures and refusals."""

import json
import math
import os
import sys

import numpy as np
import pytest
from spring_scene import command, command_json, write
from toy_peer import CPU, REFINEMENTS, write_peer

from quintet.components.meshless_gas.exact.riemann import Side, solution
from quintet.coupler.measures.expectation import Expectation
from quintet.coupler.report.peer_tables import beside_table, beside_words
from quintet.coupler.scene.read import library, load
from quintet.coupler.study.peers.outputs import cpu_in, curve_in, version_in
from quintet.coupler.study.peers.peer import read_peers
from quintet.coupler.study.peers.process import executable
from quintet.coupler.study.peers.table import CpuTable, CurveTable, peers_of, read_peer
from quintet.interfaces.errors import SceneError
from quintet.scenarios.shock_tube.peers.openfoam import errors


def refusal(capsys, path, *arguments):
    """The message with which a study is refused."""
    assert command("study", path, "--out", path.parent / "all", *arguments) == 2
    assert not (path.parent / "all").exists()
    return capsys.readouterr().err


def test_a_program_is_measured_as_the_scene_is_and_runs_in_turns(tmp_path, capsys):
    _, content = command_json("study", write_peer(tmp_path), "--beside", "toy")
    (peer,) = content["peers"]
    assert (peer["name"], peer["program"], peer["version"]) == ("toy", "Toy", "7.1")
    assert peer["settings"] == "exact, but for its phase" and peer["inputs"][0].endswith("toy.txt")
    assert [row["label"] for row in peer["rows"]] == ["late", "later", "latest"]
    for row, phase in zip(peer["rows"], (0.01, 0.02, 0.04), strict=True):
        assert row["status"] == "done" and row["settings"] == {"phase": phase}
        assert row["errors"]["end"] == pytest.approx(abs(math.cos(10.0 + phase) - math.cos(10.0)))
        assert row["within"] == content["rows"][0]["within"] and not row["met"]
        assert row["cpu"] == 0.5 and 0.0 < row["cpu_process"] < row["wall"] + 0.1
        assert row["load"] >= 0.0 and row["cores"] == os.cpu_count() and row["memory"] > 1e6
    assert all(row["load"] >= 0.0 for row in content["rows"])
    text = capsys.readouterr().out
    places = [
        text.index(words)
        for words in ("0.02: done", "toy, late:", "toy, later:", "0.01: done", "toy, latest:")
    ]
    assert places == sorted(places) and "Toy 7.1: exact, but for its phase" in text
    names = {path.name for path in (tmp_path / "all" / "toy_late").iterdir()}
    assert {"peer.json", "peer.log", "curve.txt"} <= names and "large" not in names
    result = json.loads((tmp_path / "all" / "toy_late" / "peer.json").read_text())
    assert result["commands"] == [[sys.executable, "toy.py", "0.01"]]
    assert "curve.txt" in result["inputs"]["toy.py"]


def test_the_page_of_the_study_has_the_program(tmp_path):
    path = write_peer(tmp_path)
    command_json("study", path, "--beside", "toy")
    assert command("report", tmp_path / "all") == 0
    assert "Beside Toy 7.1" in (tmp_path / "all" / "report.html").read_text()


def test_with_keep_a_run_of_the_same_inputs_is_taken_over(tmp_path):
    path = write_peer(tmp_path)
    command_json("study", path, "--beside", "toy")
    place = tmp_path / "all" / "toy_late" / "peer.json"
    saved_time = place.stat().st_mtime_ns
    table = tmp_path / "peers" / "toy" / "peer.toml"
    table.write_text(table.read_text().replace("phase = 0.02", "phase = 0.03"))
    _, content = command_json("study", path, "--beside", "toy", "--keep")
    assert place.stat().st_mtime_ns == saved_time
    phases = [row["settings"]["phase"] for row in content["peers"][0]["rows"]]
    errors = [row["errors"]["end"] for row in content["peers"][0]["rows"]]
    assert phases == [0.01, 0.03, 0.04]
    assert errors[1] == pytest.approx(abs(math.cos(10.03) - math.cos(10.0)))


@pytest.mark.parametrize(
    ("change", "code", "state", "cause"),
    [
        (("", ""), "sys.exit(3)", "failed", "exit status 3"),
        (("minutes = 1", "minutes = 0.03"), "time.sleep(60)", "stalled", "exit status -9"),
        (("curve.txt", "other.txt"), "", "failed", "other.txt: the program must write it"),
        (("'seconds (", "'minutes ("), "", "failed", "cpu.seconds: the program must print"),
    ],
)
def test_a_run_that_fails_is_told_and_the_others_count(tmp_path, change, code, state, cause):
    path = write_peer(tmp_path, change, code)
    status, content = command_json("study", path, "--beside", "toy")
    assert status == 3 and all(row["status"] == "done" for row in content["rows"])
    row = content["peers"][0]["rows"][0]
    assert row["status"] == state and cause in row["cause"] and row["errors"] == {}


def test_a_program_that_is_not_there_is_refused_with_what_to_do(tmp_path, capsys):
    path = write_peer(tmp_path, ('["@python@", "toy.py"', '["no-such-program", "toy.py"'))
    text = refusal(capsys, path, "--beside", "toy")
    assert "Toy must be installed; there is no program no-such-program" in text
    assert "Install it: pip install toy" in text
    assert "--beside tow is not known. Did you mean toy?" in refusal(
        capsys, path, "--beside", "tow"
    )
    message = refusal(capsys, path, "--beside", "toy", "--set", "end=0.5")
    assert "--beside takes no --set" in message and "Remove it" in message
    assert command("study", "--all", "--beside", "toy") == 2
    assert "study --all takes no --beside" in capsys.readouterr().err


def test_a_scene_without_inputs_of_programs_says_where_they_belong(tmp_path, capsys):
    text = refusal(capsys, write(tmp_path, REFINEMENTS), "--beside", "toy")
    assert "this scene has no inputs of other programs. Put them into peers/toy" in text


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (("phase = 0.02", "other = 0.02"), "run later: values must have phase. Add them."),
        (("'Version (\\S+)'", "'Version \\S+'"), "version must have one group"),
        (("'Version (\\S+)'", "'Version ((\\S+)'"), "version must be a regular expression"),
        (('= "toy.txt"', '= "toy.f"'), "inputs: file toy.f must lie beside it"),
        (('"toy.py" = ', '"../toy.py" = '), "../toy.py must be a place in the folder of the run"),
        (("axis = 0", "axis = 1"), "is measured by no expectation of the scene"),
        (('"curve.txt"', '"a/curve.txt"'), "file must be a name without folders"),
        (('"later"', '"late"'), "labels must differ"),
        (('"@python@", "toy.py", "@phase@"', ""), "a command must have a word"),
        (
            ("[cpu]", "[cpu]\npercent = '(.)'\nwall = true"),
            "cpu: with percent the time is CPU time",
        ),
        (("program =", "programme ="), "programme"),
    ],
)
def test_mistakes_of_a_table_are_told(tmp_path, capsys, change, sentence):
    text = refusal(capsys, write_peer(tmp_path, change), "--beside", "toy")
    assert sentence in text and "peers/toy/peer.toml: " in text


@pytest.mark.parametrize(
    ("change", "cost", "words"),
    [
        (("", ""), "cpu", "CPU time, time steps"),
        (("[cpu]", "[cpu]\nwall = true"), "wall", "wall time, time steps"),
        ((CPU, ""), "process", "CPU time, whole process"),
    ],
)
def test_the_table_says_which_time_stands_for_the_cost(tmp_path, change, cost, words):
    (peer,) = read_peers(["toy"], load(str(write_peer(tmp_path, change))))
    state = {"label": "a", "status": "done", "met": True, "units": {}, "errors": {}}
    state |= {"load": 1.0, "cores": 96}
    run = {**state, "cpu": 0.5, "cpu_process": 0.75}
    summary, rows = peer.summary([{**run, "version": "7.1"}]), [{**state, "cpu": 0.25}]
    assert summary["cost"] == cost
    table = beside_table(summary, rows)
    heads, of_quintet, of_program = (list(column.cells) for column in table.columns)
    costs = {h: (q, p) for h, q, p in zip(heads, of_quintet, of_program, strict=True) if "[s]" in h}
    by_kind = {
        "cpu": {"CPU time, time steps [s]": ("0.25", "0.5")},
        "wall": {
            "CPU time, time steps [s]": ("0.25", "-"),
            "wall time, time steps [s]": ("-", "0.5"),
        },
        "process": {"CPU time, time steps [s]": ("0.25", "-")},
    }
    assert costs == {**by_kind[cost], "CPU time, whole process [s]": ("-", "0.75")}
    sentences = beside_words(summary, rows)
    assert any(words in sentence for sentence in sentences) == (cost != "cpu")
    assert sentences[-1] == "load of the machine as runs began: 1.0 to 1.0 on 96 cores"


LAMMPS = """LAMMPS (29 Aug 2024)
Loop time of 2.5 on 1 procs for 1000 steps with 12 atoms
80.0% CPU use with 1 MPI tasks x 1 OpenMP threads
Section |  min time  |  avg time  |  max time  |%varavg| %total
Pair    | 1.0        | 1.0        | 1.0        |   0.0 |100.00
Output  | 0.5        | 0.5        | 0.5        |   0.0 |100.00
"""


def test_the_time_of_steps_is_read_from_what_programs_print():
    table = read_peer(*case("dam_break_front", "lammps"))[1]
    assert cpu_in(LAMMPS, table.cpu) == pytest.approx(0.8 * 2.0)
    assert version_in(LAMMPS, table.version) == "29 Aug 2024"
    steps = "".join(f"ExecutionTime = {time} s  ClockTime = 9 s\n" for time in (0.5, 0.75, 1.5))
    clock = CpuTable(seconds=r"ExecutionTime = (\S+) s", repeats="clock")
    assert cpu_in(steps, clock) == 1.0
    with pytest.raises(SceneError, match=r"cpu.seconds: its group must be a number"):
        cpu_in("seconds: many", CpuTable(seconds=r"seconds: (\S+)"))
    assert version_in("nothing", r"Version (\S+)") == ""


def test_several_times_count_as_the_table_says():
    table = read_peer(*case("dam_break_front", "lammps"))[1]
    twice = LAMMPS + LAMMPS.replace("of 2.5", "of 10.5").replace("80.0%", "50.0%")
    total = {"without": table.cpu.without, "percent": table.cpu.percent, "repeats": "total"}
    times = CpuTable(seconds=table.cpu.seconds, **total)
    assert cpu_in(twice, times) == pytest.approx(0.8 * 2.0 + 0.5 * 10.0)
    assert cpu_in(LAMMPS, times) == pytest.approx(0.8 * 2.0)
    with pytest.raises(SceneError, match=r"output has 2. Say repeats = .total. where they add up"):
        cpu_in(twice, table.cpu)
    with pytest.raises(SceneError, match=r"repeats = .clock.: the program must print two times"):
        cpu_in("t 1", CpuTable(seconds=r"t (\S+)", repeats="clock"))
    with pytest.raises(SceneError, match=r"cpu.percent: .* the seconds, 2 times; found 1"):
        cpu_in(twice.replace("50.0%", "half"), times)


def test_curves_are_read_from_columns_among_other_lines(tmp_path):
    path = tmp_path / "out.log"
    table = CurveTable(component="a", field="b.c", file="out.log", time=1, value=2)
    path.write_text("Step Time v\n0 0 1.5\n1 0.5 2.5 9\nWARNING: 3\n2 1.0\n3 nan 2\n4 2,3\nend\n")
    times, values = curve_in(path, table)
    assert times.tolist() == [0.0, 0.5, 2.0] and values.tolist() == [1.5, 2.5, 3.0]
    path.write_text("0 0 1\n1 0 2\n")
    with pytest.raises(SceneError, match="times in column 1 must increase"):
        curve_in(path, table)
    path.write_text("0 0 1\n")
    with pytest.raises(SceneError, match="two rows or more of 3 numbers; found 1"):
        curve_in(path, table)


def test_an_output_serves_the_expectations_of_its_field():
    table = CurveTable(component="a", field="b.c", item=2, axis=0, file="x")
    target = {"component": "a", "field": "b.c", "item": 2, "axis": 0}
    limits = {
        "name": "n",
        "measure": "max",
        "value": 1.0,
        "within": 1.0,
        "unit": "m",
        "source": "s",
    }
    assert table.serves(Expectation(**target, **limits))
    assert not table.serves(Expectation(**{**target, "item": 1}, **limits))


def test_the_tube_of_openfoam_has_the_exact_solution_of_the_component():
    x, time = (np.arange(997) + 0.5) / 997, errors.END
    states = solution(
        Side(*errors.LEFT), Side(*errors.RIGHT), errors.GAMMA, (x - errors.DIAPHRAGM) / time
    )
    density, pressure = errors.exact(x, time)
    np.testing.assert_allclose(density, states[:, 0], rtol=1e-9)
    np.testing.assert_allclose(pressure, states[:, 2], rtol=1e-9)


def test_fields_of_openfoam_are_read(tmp_path):
    head = "FoamFile { class volScalarField; }\ndimensions [0 0 0 1 0 0 0];\ninternalField "
    (tmp_path / "T").write_text(head + "uniform 1.5;\nboundaryField { }")
    assert errors.field(tmp_path, "T", 3).tolist() == [1.5, 1.5, 1.5]
    (tmp_path / "T").write_text(
        head + "nonuniform List<scalar> \n3\n(\n1\n2e-1\n3\n)\n;\nboundaryField { }"
    )
    assert errors.field(tmp_path, "T", 3).tolist() == [1.0, 0.2, 3.0]
    (tmp_path / "U").write_text(
        head + "nonuniform List<vector> 2((1 0 0)\n(-2 0 3));\nboundaryField { }"
    )
    assert errors.field(tmp_path, "U", 2).tolist() == [[1.0, 0.0, 0.0], [-2.0, 0.0, 3.0]]


def case(scene, name):
    loaded = load(scene)
    return loaded.folder, name, loaded.expect


CASES = [(scene, name) for scene, path in library().items() for name in peers_of(path.parent)]


@pytest.mark.parametrize(("scene", "name"), CASES)
def test_inputs_beside_scenes_are_sound(scene, name):
    folder, table = read_peer(*case(scene, name))
    assert folder.name == name and len(table.run) >= 2


LONG = ("settling_packing",)  # half a minute
RUN = [pytest.param(*c, marks=[pytest.mark.full] if c[0] in LONG else []) for c in CASES]


@pytest.mark.parametrize(("scene", "name"), RUN)
def test_programs_that_are_installed_solve_the_coarsest_case(scene, name, tmp_path):
    table = read_peer(*case(scene, name))[1]
    if missing := [c[0] for c in table.commands if c[0][0] != "@" and not executable(c[0])]:
        pytest.skip(f"{missing[0]} is not installed")
    (peer,) = read_peers([name], load(scene))
    row = peer.row(peer.runs[0], tmp_path, lambda: False, False)
    assert row["status"] == "done", row["cause"]
    assert row["version"] and row["cpu"] > 0.0 and row["cpu_process"] > 0.0
    assert max(filter(None, row["relative"].values())) < 0.2
