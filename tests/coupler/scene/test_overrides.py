"""Settings on a scene come back unchanged, whatever their names and values."""

import tomllib
from pathlib import Path

import numpy as np
import pytest

from quintet.coupler.cli import main
from quintet.coupler.scene.overrides import assignments, put_set
from quintet.interfaces.errors import SceneError

VALUES = (
    True,
    0.1,
    float("inf"),
    'quotes " and \\ and\ttabs, \x7f and \u2028',
    [[1.0, 2.0], []],
    {"a key with . and é and 😀": [1, {"deep": "x\ny"}], "": {}},
)


@pytest.mark.parametrize("value", VALUES, ids=repr)
def test_a_setting_is_read_back_as_it_was_given(value):
    (line,) = assignments({"key": value})
    table = {}
    assert put_set(table, line) == [] and table == {"key": value}
    assert "\n" not in line


def test_settings_may_be_arrays_and_paths():
    settings = {"a": np.float64(0.1), "b": np.eye(2), "c": (Path("x"), np.int64(3))}
    table = {}
    assert not [mistake for line in assignments(settings) for mistake in put_set(table, line)]
    assert table == {"a": 0.1, "b": [[1.0, 0.0], [0.0, 1.0]], "c": ["x", 3]}


def test_a_setting_that_toml_does_not_have_is_refused():
    with pytest.raises(SceneError, match="end: a setting must be a value of TOML; found None"):
        assignments({"end": None})


def test_the_scene_that_a_run_leaves_is_the_one_that_ran(tmp_path):
    path = tmp_path / "scene.toml"
    scene = (
        'name = "odd"\nend = 0.01\ntransport = "memory"\ntitle = "é \\u007F"\n'
        '[components.one]\nkind = "echo"\n[stand_ins.one."a.b \\U0001F600"]\nx = [{ y = 1 }, {}]\n'
    )
    path.write_text(scene, encoding="utf-8")
    with pytest.raises(SystemExit) as exit_info:
        main(["run", str(path), "--out", str(tmp_path / "out")])
    assert exit_info.value.code == 0
    table = tomllib.loads((tmp_path / "out" / "scene.toml").read_text(encoding="utf-8"))
    assert table == tomllib.loads(scene)
