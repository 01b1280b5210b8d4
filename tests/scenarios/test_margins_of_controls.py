"""Every tolerance of every scene rejects a wrong setting, by `quintet controls --all`."""

import json
import re
import tomllib
from pathlib import Path

import pytest

from quintet.coupler.report.control_tables import markdown
from quintet.coupler.scene.read import library

SCENARIOS = Path(__file__).parents[2] / "scenarios"
TABLE = re.compile(r"<!-- controls -->\n(.*?)\n<!-- end of controls -->", re.DOTALL)


@pytest.fixture(scope="module")
def scenes():
    """Rows of `quintet controls --all --json scenarios/controls.json`, by scene."""
    content = json.loads((SCENARIOS / "controls.json").read_text())
    return {scene["scene"]: scene["rows"] for scene in content}


@pytest.mark.parametrize("name", sorted(library()))
def test_every_expectation_has_a_control_that_its_tolerance_rejects(scenes, name):
    scene = tomllib.loads(library()[name].read_text())
    expected = {expectation["name"]: expectation for expectation in scene["expect"]}
    controls = {(c["name"], rejected) for c in scene["control"] for rejected in c["rejects"]}
    assert {rejected for _, rejected in controls} == set(expected)
    rows = scenes[name]
    assert {(row["control"], row["expectation"]) for row in rows} == controls
    for row in rows:
        expectation = expected[row["expectation"]]
        assert row["verdict"] == "rejected" and row["within"] == expectation["within"], row
        assert row["reference"] == expectation.get("value", row["reference"]), row
        assert abs(row["value"] - row["reference"]) > row["within"], row
        assert row["base_margin"] is None or row["base_margin"] <= 1.0, row


def test_the_table_of_margins_is_that_of_the_runs(scenes):
    place = TABLE.search((SCENARIOS / "README.md").read_text())
    rows = [{"scene": name, "rows": rows} for name, rows in scenes.items()]
    assert place and place[1].strip() == "\n".join(markdown(rows))
