"""Scenes that links do not allow are refused as they are read, or before the first window."""

import json

import laboratory
import pytest
from started import write_scene

from quintet.coupler.cli import main
from quintet.interfaces.errors import SceneError

PLATE, GUST = {"kind": "toy_plates:Plate"}, {"kind": "toy_plates:Gust"}
TWO_PLATES = {"one": PLATE, "gust": GUST, "two": PLATE}
LINKS = [{"kind": "fsi", "between": ["gust", name]} for name in ("one", "two")]


@pytest.mark.parametrize("order", [["one", "gust", "two"], ["two", "gust", "one"]])
def test_a_serial_order_that_cannot_be_met_is_found_when_the_scene_is_read(tmp_path, order):
    words = r"the inputs of gust.surface must all come from components that step before it, or all"
    with pytest.raises(SceneError, match=words):
        laboratory.couple(
            laboratory.scene(tmp_path, TWO_PLATES, LINKS, end=0.1, window=0.02, order=order)
        )


@pytest.mark.parametrize("order", [["gust", "one", "two"], ["one", "two", "gust"]])
def test_orders_that_can_be_met_run(tmp_path, order):
    path = laboratory.scene(tmp_path, TWO_PLATES, LINKS, end=0.1, window=0.02, order=order)
    for account in laboratory.couple(path).coupling.ledger.accounts.values():
        assert account.momentum_residual <= 1e-12


def test_glue_into_a_group_is_refused(tmp_path):
    components = {"column": {"kind": "toy_chains:Column"}, "rods": {"kind": "toy_chains:Rods"}}
    link = {"kind": "glue", "name": "glue", "between": ["column", "rods"]}
    groups = {"one": {"members": ["column"]}}
    path = laboratory.scene(tmp_path, components, link, end=1.0, window=0.1, groups=groups)
    with pytest.raises(SceneError, match="both sides must make equal steps; one of them is in a g"):
        laboratory.couple(path)
    pair = {"pair": {"members": ["column", "rods"]}}
    laboratory.couple(
        laboratory.scene(tmp_path, components, link, end=1.0, window=0.3, groups=pair)
    )


def test_what_shows_when_ports_are_joined_is_refused_with_status_2(tmp_path, capsys, monkeypatch):
    """Bodies are smaller than the fluid's spacing; neither component alone knows it."""
    monkeypatch.chdir(tmp_path)
    components = {"gust": GUST, "balls": {"kind": "toy_bodies:Balls", "diameter": 0.01}}
    link = {"kind": "fsi", "between": ["gust", "balls"]}
    path = laboratory.scene(tmp_path, components, link, end=0.1, window=0.02)
    with pytest.raises(SystemExit) as error:
        main(["run", str(path), "--out", "out"])
    assert error.value.code == 2
    message = capsys.readouterr().err
    assert "a body must be at least 0.125 m across" in message and "Traceback" not in message
    assert json.loads((tmp_path / "out/results.json").read_text())["status"] == "refused"
    assert not (tmp_path / "out/recording.h5").exists()


def test_check_tells_how_long_windows_will_be_and_why(tmp_path, capsys):
    components = {"column": {"kind": "toy_chains:Column"}, "rods": {"kind": "toy_chains:Rods"}}
    link = {"kind": "glue", "name": "glue", "between": ["column", "rods"]}
    path = laboratory.scene(tmp_path, components, link, end=1.0)
    with pytest.raises(SystemExit):
        main(["check", str(path)])
    assert "run: column, rods; serial; windows follow the state" in capsys.readouterr().out


def test_a_path_beside_a_fluid_is_exchanged_as_often_as_the_fluid_needs(tmp_path):
    """A body that allows any step does not make one window of the whole run."""
    body = {"shape": "box", "lowest": [-0.15] * 3, "highest": [0.15] * 3}
    components = {
        "gust": {**GUST, "dt": 0.01},
        "path": {"kind": "prescribed", "bodies": [{**body, "frequency": 10.0}]},
    }
    link = {"kind": "fsi", "between": ["gust", "path"]}
    trace = laboratory.couple(laboratory.scene(tmp_path, components, link, end=0.5))
    assert len(trace.times) - 1 >= 50


PICKY = """
from toys import Toy
from quintet.interfaces.errors import SceneError
class {name}(Toy):
    '''Refuses its scene.'''
    def {method}:
        raise SceneError("items must be odd; found 4. Add one.")
"""


@pytest.mark.parametrize(
    ("transport", "method"),
    [
        ("memory", "__init__(self, params)"),
        ("memory", "bind(self, static, joined)"),
        pytest.param("zenoh", "__init__(self, params)", marks=pytest.mark.zenoh),
        pytest.param("zenoh", "describe(self)", marks=pytest.mark.zenoh),
    ],
)
def test_what_a_component_refuses_is_a_mistake_of_the_scene(tmp_path, transport, method, capfd):
    path = write_scene(tmp_path, transport, 0.01)
    name = f"Picky{transport}{method[:4].strip('_')}"
    (tmp_path / f"{name.lower()}.py").write_text(PICKY.format(name=name, method=method))
    text = path.read_text().replace("toys:Toy", f"{name.lower()}:{name}", 1)
    path.write_text(text)
    with pytest.raises(SystemExit) as error:
        main(["run", str(path), "--out", str(tmp_path / "out")])
    assert error.value.code == 2
    message = capfd.readouterr().err
    assert "components.ping: items must be odd; found 4. Add one." in message
    assert "Traceback" not in message


def test_an_item_that_is_not_there_is_told_before_the_first_window(tmp_path, capsys):
    """Items of bodies are checked with the scene, others as ports are joined."""
    path = write_scene(tmp_path, end=0.01)
    expect = """
[[expect]]
name = "e"
component = "pong"
field = "out.number"
item = 5
axis = 0
measure = "max"
value = 1.0
within = 0.1
unit = "m"
source = "none"
"""
    path.write_text(path.read_text() + expect)
    with pytest.raises(SystemExit) as error:
        main(["run", str(path), "--out", str(tmp_path / "out")])
    assert error.value.code == 2
    rule = "expectation e: item must be below 5, as many as pong has of out.number; found 5."
    assert rule in capsys.readouterr().err
    assert json.loads((tmp_path / "out/results.json").read_text())["windows"] == 0
    with pytest.raises(SystemExit) as error:
        main(["check", "dam_break_cubes", "--set", "expect.0.item=3"])
    assert error.value.code == 2
    assert "item must be below 3, as many as cubes has of motion.position; found 3." in (
        capsys.readouterr().err
    )


@pytest.mark.parametrize("command", [["study", "two_springs"], ["bench", "echo"]])
def test_a_file_for_results_that_cannot_be_written_is_told_at_once(tmp_path, capsys, command):
    rules = {
        tmp_path: "it must be a plain file",
        tmp_path / "none" / "found.json": "it must be a file that can be written",
    }
    for path, rule in rules.items():
        with pytest.raises(SystemExit) as error:
            main([*command, "--json", str(path)])
        assert error.value.code == 2
        assert f"--json {path}: {rule}" in capsys.readouterr().err


def test_an_endpoint_that_is_none_is_told_to_who_joins(capsys):
    with pytest.raises(SystemExit) as error:
        main(["join", "two_springs", "upper", "--at", "nowhere"])
    assert error.value.code == 2
    assert "--at endpoint 'nowhere': must be tcp/HOST:PORT on the" in capsys.readouterr().err
