"""Every scene that comes with quintet, run as it stands, ends as its tables in README say."""

import json
import tomllib

import pytest

from quintet.coupler.cli import main
from quintet.coupler.scene.read import library, load, load_variants

# Expectations that are not met, and said so in README: all others are.
UNMET = {
    "dam_break_box": {"p3.arrival", "front.arrival"},
    "dam_break_box quick": {"p1.arrival", "p3.arrival", "front.arrival"},
    "dam_break_cubes open": {"top_cube.fall", "top_cube.x_moving"},
    "dam_break_front smooth": {"front.martin_moyce", "front.koshizuka_oka"},
}

LONGEST = 5.0  # minutes that a variant may take to be run here


def variants():
    """Yield names, or names and presets, of scenes that state a short enough run time."""
    for name, path in sorted(library().items()):
        scene = tomllib.loads(path.read_text())
        for preset, changes in {"": {}, **scene.get("presets", {})}.items():
            if changes.get("minutes", scene["minutes"]) <= LONGEST:
                yield f"{name} {preset}".strip()


@pytest.mark.full
@pytest.mark.parametrize("variant", [*variants()])
def test_a_scene_meets_what_its_tables_say_without_a_warning(tmp_path, variant):
    name, _, preset = variant.partition(" ")
    chosen = ["--preset", preset] if preset else []
    with pytest.raises(SystemExit) as ended:
        main(["run", name, *chosen, "--out", str(tmp_path / name)])
    results = json.loads((tmp_path / name / "results.json").read_text())
    unmet = {row["name"] for row in results["expect"] if row["required"] and not row["met"]}
    assert unmet == UNMET.get(variant, set())
    assert ended.value.code == (1 if unmet else 0)
    assert results["warnings"] == []
    for link in results["ledger"]["links"]:
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


def test_every_expectation_says_of_what_kind_its_reference_is_and_how_it_was_read():
    kinds = {"exact", "experiment", "other code", "own finest run"}
    for name, path in sorted(library().items()):
        scene = tomllib.loads(path.read_text())
        tables = [scene, *scene.get("presets", {}).values()]
        for expectation in (row for table in tables for row in table.get("expect", ())):
            assert expectation.get("reference_kind") in kinds, f"{name}: {expectation['name']}"
            assert expectation.get("read_from"), f"{name}: {expectation['name']}"
