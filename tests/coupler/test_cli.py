"""Every command does its documented work, and ends with its documented status."""

import io
import json

import pytest
from rich.console import Console
from started import Started, write_scene

import quintet
from quintet.coupler.cli import main, parser
from quintet.coupler.scene.listing import print_list
from quintet.coupler.scene.read import library, load
from quintet.interfaces.lines.endpoint import free_port

EXPECT = """
[[expect]]
name = "number"
component = "pong"
field = "out.number"
axis = 0
measure = "at"
begin = 0.02
value = {value}
within = 0.5
unit = "m"
source = "none"
"""
OVER = [pytest.param("zenoh", marks=pytest.mark.zenoh), pytest.param("mpi", marks=pytest.mark.mpi)]


def status(*arguments):
    with pytest.raises(SystemExit) as exit_info:
        main([str(argument) for argument in arguments])
    return exit_info.value.code


@pytest.fixture
def run_folder(tmp_path, capsys):
    """A finished run in memory."""
    path = write_scene(tmp_path, end=0.02)
    assert status("run", path, "--out", tmp_path / "out") == 0
    capsys.readouterr()
    return tmp_path / "out"


def test_list_names_every_scene_with_its_presets(capsys):
    assert status("list", "--json") == 0
    rows = {row["scene"]: row for row in json.loads(capsys.readouterr().out)}
    assert rows.keys() == library().keys()
    assert all(row["components"] and row["presets"] for row in rows.values())
    assert status("list") == 0
    table = capsys.readouterr().out
    assert all(name in table for name in rows)


@pytest.mark.parametrize("command", [["list"], ["check", "dam_break_cubes"]])
def test_no_line_is_wrapped_into_a_pipe(capsys, monkeypatch, command):
    monkeypatch.setenv("COLUMNS", "40")
    assert status(*command) == 0
    lines = capsys.readouterr().out.splitlines()
    rows = len(library()) if command == ["list"] else len(load(command[1]).expect) + 12
    lines = [line for line in lines if command != ["list"] or (line.split()[:1] and "(" in line)]
    assert len(lines) == rows and max(map(len, lines)) > 80


def test_list_groups_scenes_by_kinds_and_keeps_their_names_in_a_narrow_terminal():
    rows = [
        {"scene": "a_long_name_of_a_scene", "title": "Water " * 20, "components": ["w: fluid"],
         "presets": {"(none)": 2.0, "quick": 0.5}},
        {"scene": "gate", "title": "A gate", "components": ["g: plate", "w: fluid"],
         "presets": {"(none)": 0.0}},
    ]  # fmt: skip
    screen = Console(width=60, file=io.StringIO())
    print_list(rows, screen)
    lines = screen.file.getvalue().splitlines()
    assert max(map(len, lines)) <= 60 and lines.count("fluid") == 1
    assert any(line.startswith("a_long_name_of_a_scene ") for line in lines)
    assert lines[-2:][0].strip() == "fluid and plate" and lines[-1].split()[0] == "gate"
    assert "(2 min); presets quick (0.5)" in " ".join(" ".join(lines).split())


def test_every_option_has_a_help_text():
    (commands,) = (action for action in parser()._actions if action.choices)
    for name, command in commands.choices.items():
        options = [action for action in command._actions if action.option_strings]
        assert [action.dest for action in options if not action.help] == [], name


def test_the_version_is_that_of_the_package(capsys):
    assert status("--version") == 0
    assert capsys.readouterr().out == f"quintet {quintet.__version__}\n"


def test_check_prints_the_plan_and_starts_nothing(tmp_path, capsys):
    assert status("check", "--import", write_scene(tmp_path, "zenoh", end=0.02)) == 0
    output = " ".join(capsys.readouterr().out.split())
    for words in (
        "0.02 s over zenoh; 3 processes, the coupler one of them",
        "run: ping, pong; serial; 20 windows of 0.001 s",
        "ping takes in (number [m], push [N, impulse]); gives out (number [m], push [N, impulse])",
        "link ping-pong: ping -> pong",
        "link ping-pong: pong -> ping",
    ):
        assert words in output
    assert {path.name for path in tmp_path.iterdir()} <= {"scene.toml", "toys.py", "__pycache__"}


@pytest.mark.parametrize(("value", "expected"), [("0.1", 0), ("9.0", 1)])
def test_run_tells_whether_expectations_were_met(tmp_path, capsys, value, expected):
    path = write_scene(tmp_path, end=0.02)
    path.write_text(path.read_text() + EXPECT.format(value=value))
    assert status("run", path, "--out", tmp_path / "out") == expected
    results = json.loads((tmp_path / "out" / "results.json").read_text())
    assert results["status"] == "done" and results["windows"] == 20
    assert results["expect"][0]["met"] is (expected == 0)
    assert ("not met" in capsys.readouterr().out) is (expected == 1)


def test_an_item_that_no_component_has_is_refused_as_ports_are_joined(tmp_path, capsys):
    path = write_scene(tmp_path, end=0.02)
    path.write_text(path.read_text() + EXPECT.format(value="0.1") + "item = 99\n")
    assert status("run", path, "--out", tmp_path / "out") == 2
    sentence = "item must be below 5, as many as pong has of out.number; found 99. Correct it."
    assert sentence in capsys.readouterr().err


def test_results_have_all_that_they_promise(run_folder):
    results = json.loads((run_folder / "results.json").read_text())
    for key in ("scene", "preset", "transport", "status", "windows", "time", "expect", "command"):
        assert key in results
    assert results["time"] == pytest.approx(0.02)
    assert {"links", "energy_balance"} <= results["ledger"].keys()
    assert results["ledger"]["links"][0]["momentum_residual"] < 1e-13
    assert {"wall", "compile", "components", "exchange", "mapping"} <= results["timing"].keys()
    assert results["timing"]["components"]["ping"]["steps"] == 20
    assert {"cpu", "cores", "versions"} <= results["machine"].keys()


def test_a_run_can_be_run_again_from_the_scene_that_it_left(run_folder, tmp_path):
    (tmp_path / "again.toml").write_text((run_folder / "scene.toml").read_text())
    assert status("run", tmp_path / "again.toml", "--out", tmp_path / "again") == 0
    assert status("diff", run_folder, tmp_path / "again") == 0


def test_a_second_run_into_a_folder_replaces_the_first_and_nothing_else(run_folder, tmp_path):
    (run_folder / "notes.txt").write_text("mine")
    assert (
        status("run", tmp_path / "scene.toml", "--out", run_folder, "--force", "--set", "end=0.005")
        == 0
    )
    assert (run_folder / "notes.txt").read_text() == "mine"
    assert json.loads((run_folder / "results.json").read_text())["windows"] == 5


def test_show_tells_what_happened(run_folder, capsys):
    assert status("show", run_folder) == 0
    output = capsys.readouterr().out
    assert "toy: done, 20 windows to t = 0.02 s over memory" in output and "ping-pong" in output
    assert status("show", run_folder, "--json") == 0
    assert json.loads(capsys.readouterr().out)["status"] == "done"


def test_show_and_diff_refuse_what_is_no_run(tmp_path, capsys):
    assert status("show", tmp_path) == 2
    assert "it has no results.json. Run a scene into it first." in capsys.readouterr().err
    assert status("diff", tmp_path, tmp_path) == 2
    assert "there is no such file. Run the scene first." in capsys.readouterr().err


def test_diff_finds_the_first_difference(run_folder, tmp_path, capsys):
    folder = tmp_path / "other"
    settings = ("--set", "components.pong.items=5", "--set", "components.pong.substeps=2")
    assert status("run", tmp_path / "scene.toml", "--out", folder, *settings) == 0
    capsys.readouterr()
    assert status("diff", run_folder, folder) == 1
    assert capsys.readouterr().out.startswith("window 1 (t = 0.001 s): pong.out.")
    assert status("diff", run_folder, run_folder) == 0
    assert "the same, bit for bit" in capsys.readouterr().out


@pytest.mark.parametrize("transport", OVER)
@pytest.mark.parametrize("scheme", ["serial", "parallel"])
def test_every_transport_gives_the_same_bits(tmp_path, capsys, transport, scheme):
    path = write_scene(tmp_path, end=0.2, ping="substeps = 7", pong="substeps = 3")
    settings = ("--set", f"scheme={scheme}")
    assert status("run", path, "--out", tmp_path / "memory", *settings) == 0
    run = Started(path, *settings, "--transport", transport)
    assert run.wait() == 0, run.err
    assert run.results["transport"] == transport
    assert status("diff", tmp_path / "memory", run.folder) == 0
    # The output is the same too, except for clock times.
    assert f"toy: done, 200 windows to t = 0.2 s over {transport}" in run.out


def test_a_replayed_component_gives_the_same_bits(run_folder, tmp_path, capsys):
    path = tmp_path / "scene.toml"
    swap = ("--swap", f"ping=replay@{run_folder}")
    settings = ("--set", 'links.0.pairs=[["ping.out", "pong.in"]]')
    settings += ("--set", 'output.fields=["pong.out.number"]')  # no link reads it any more
    assert status("run", path, "--out", tmp_path / "again", *swap, *settings) == 0
    results = json.loads((tmp_path / "again" / "results.json").read_text())
    assert results["status"] == "done"
    from quintet.coupler.files.recording import Recording

    with Recording(run_folder) as original, Recording(tmp_path / "again") as replayed:
        gap = original.field("pong", "out.number") - replayed.field("pong", "out.number")
    assert abs(gap).max() < 1e-15


def test_no_command_and_no_such_command_are_bad_input(capsys):
    assert status() == 2
    assert status("simulate") == 2
    assert "invalid choice" in capsys.readouterr().err


@pytest.mark.zenoh
def test_a_run_over_mutual_tls_gives_the_same_bits(tmp_path, certificates, capsys):
    path = write_scene(tmp_path, "zenoh", end=0.05)
    assert status("run", path, "--transport", "memory", "--out", tmp_path / "memory") == 0
    ours = certificates[0]
    files = json.dumps([ours.authority, ours.certificate, ours.key])
    run = Started(path, "--set", f"tls={files}", "--set", f'endpoint="tls/localhost:{free_port()}"')
    assert run.wait() == 0, run.err
    assert status("diff", tmp_path / "memory", run.folder) == 0


def test_an_error_of_quintet_itself_is_not_taken_for_an_unmet_expectation(monkeypatch, capsys):
    def fail(*_):
        raise ZeroDivisionError("a defect")

    monkeypatch.setattr("quintet.coupler.scene.listing.print_list", fail)
    assert status("list") == 3
    assert "ZeroDivisionError: a defect" in capsys.readouterr().err
