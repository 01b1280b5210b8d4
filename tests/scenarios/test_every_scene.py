"""Every scene that comes with quintet, run as it stands, ends as its tables in README say."""

import json
import tomllib

import pytest

from quintet.coupler.cli import main
from quintet.coupler.scene.read import library, load, load_variants

# Expectations that are not met, and said so in README: all others are.
UNMET = {"dam_break_box": {"p3.arrival", "front.arrival"}}

CUBES = "dam_break_cubes quick"  # as it stands it takes ten minutes


@pytest.mark.full
@pytest.mark.parametrize("scene", [*sorted(set(library()) - {"dam_break_cubes"}), CUBES])
def test_a_scene_meets_what_its_tables_say(tmp_path, scene):
    name, _, preset = scene.partition(" ")
    chosen = ["--preset", preset] if preset else []
    with pytest.raises(SystemExit) as ended:
        main(["run", name, *chosen, "--out", str(tmp_path / name)])
    found = json.loads((tmp_path / name / "results.json").read_text())
    unmet = {one["name"] for one in found["expect"] if one["required"] and not one["met"]}
    assert unmet == UNMET.get(name, set())
    assert ended.value.code == (1 if unmet else 0)
    for link in found["ledger"]["links"]:
        assert link["momentum_residual"] <= 1e-12


@pytest.mark.full
@pytest.mark.parametrize("scene", sorted(library()))
def test_every_preset_of_a_scene_can_be_read_with_its_limits_and_studies(scene):
    presets = tomllib.loads(library()[scene].read_text()).get("presets", {})
    for preset in ("", *presets):
        assert load(scene, preset).file.name == scene


def test_a_preset_leaves_out_scans_that_judge_what_it_does_not_have():
    (_, plain), (scene, hot) = load_variants("blunt_sphere"), load_variants("blunt_sphere", "hot")
    judged = {name for scan in hot.scan for name in scan.judged}
    assert judged <= {expectation.name for expectation in scene.expect}
    assert len(hot.scan) < len(plain.scan)
