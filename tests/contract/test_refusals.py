"""What links do not allow is refused as the scene is read, or before the first window."""

import json

import laboratory
import pytest

from quintet.coupler.cli import main
from quintet.interfaces.errors import SceneError

PLATE, GUST = {"kind": "toy_plates:Plate"}, {"kind": "toy_plates:Gust"}
TWO_PLATES = {"one": PLATE, "gust": GUST, "two": PLATE}
LINKS = [{"kind": "fsi", "between": ["gust", name]} for name in ("one", "two")]


@pytest.mark.parametrize("order", [["one", "gust", "two"], ["two", "gust", "one"]])
def test_a_serial_order_that_cannot_be_met_is_found_when_the_scene_is_read(tmp_path, order):
    words = r"what gust takes in surface must all come from components that step before it, or all"
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
    both = {"pair": {"members": ["column", "rods"]}}
    laboratory.couple(
        laboratory.scene(tmp_path, components, link, end=1.0, window=0.3, groups=both)
    )


def test_what_shows_when_ports_are_joined_is_refused_with_status_2(tmp_path, capsys, monkeypatch):
    """Bodies smaller than the spacing at which the fluid wants them: known to neither alone."""
    monkeypatch.chdir(tmp_path)
    components = {"gust": GUST, "balls": {"kind": "toy_bodies:Balls", "diameter": 0.01}}
    link = {"kind": "fsi", "between": ["gust", "balls"]}
    path = laboratory.scene(tmp_path, components, link, end=0.1, window=0.02)
    with pytest.raises(SystemExit) as ended:
        main(["run", str(path), "--out", "out"])
    assert ended.value.code == 2
    said = capsys.readouterr().err
    assert "a body must be at least 0.125 m across" in said and "Traceback" not in said
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
    body = {"shape": "box", "size": [0.3, 0.3, 0.3], "position": [0.0, 0.0, 0.0]}
    components = {
        "gust": {**GUST, "dt": 0.01},
        "path": {"kind": "prescribed", "bodies": [{**body, "frequency": 10.0}]},
    }
    link = {"kind": "fsi", "between": ["gust", "path"]}
    trace = laboratory.couple(laboratory.scene(tmp_path, components, link, end=0.5))
    assert len(trace.times) - 1 >= 50
