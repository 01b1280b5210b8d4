"""The table of limits in README is that of the limits that are kept beside the scenes."""

import json
from pathlib import Path

import pytest

from quintet.coupler.report.marked_place import LIMITS
from quintet.coupler.report.stability_tables import markdown
from quintet.coupler.scene.read import library, load_variants

FOLDER = Path(__file__).resolve().parents[2] / "scenarios"
SCENES = json.loads((FOLDER / "stability.json").read_text())


def test_the_table_is_what_was_found():
    assert LIMITS.read(FOLDER / "README.md") == "\n".join(markdown(SCENES))


def test_scenes_come_with_quintet_and_once():
    names = [scene["scene"] for scene in SCENES]
    assert names == sorted(set(names)) and set(names) <= set(library())


@pytest.mark.parametrize("scene", SCENES, ids=lambda scene: scene["scene"])
def test_limits_are_predicted_as_they_are_now(scene):
    limits = load_variants(scene["scene"])[1].stability
    current = [
        (limit.name, value, limit.predicted(number))
        for limit in limits
        for number, value in enumerate(limit.others())
    ]
    recorded = [
        (limit["name"], next(iter((limit["against"] or {}).values()), None), limit["predicted"])
        for limit in scene["limits"]
    ]
    assert recorded == current
