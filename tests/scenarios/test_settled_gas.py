"""A gas gives `settled` only if the scene has a table `steady`."""

from pathlib import Path

import pytest

from quintet.coupler.scene.read import load
from quintet.interfaces.errors import SceneError

COUETTE = Path(__file__).parents[2] / "scenarios" / "couette" / "scene.toml"
REFUSAL = "gas.body.settled is not given with these settings. Give the gas a table steady."
EXPECT = """
[[expect]]
name = "settles"
component = "gas"
field = "body.settled"
measure = "max"
value = 1.0
within = 0.1
unit = "1"
source = "it is to settle"
"""


def _scene(folder: Path, without: str, adds: str = "") -> str:
    """Write the scene without expectations, `steady` and lines that begin with some words."""
    lines = COUETTE.read_text().split("[[expect]]")[0].splitlines()
    remaining = [line for line in lines if not line.startswith(("steady =", *without.split()))]
    path = folder / "scene.toml"
    path.write_text("\n".join(remaining) + adds)
    return str(path)


def test_an_output_that_nothing_judges_is_refused_with_what_to_set(tmp_path: Path) -> None:
    with pytest.raises(SceneError) as error:
        load(_scene(tmp_path, ""))
    assert f"output.fields: {REFUSAL}" in str(error.value)


def test_an_expectation_of_what_nothing_judges_is_refused_with_what_to_set(tmp_path: Path) -> None:
    with pytest.raises(SceneError) as error:
        load(_scene(tmp_path, "fields", EXPECT))
    assert f"expectation settles: field {REFUSAL}" in str(error.value)


def test_a_scene_that_says_when_a_flow_has_settled_is_read() -> None:
    assert "settled" in str(load("couette").components["gas"].gives)
