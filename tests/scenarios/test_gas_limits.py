"""Limits of stability of gas and of bodies in it lie where theory predicts them."""

import json
import tomllib
from pathlib import Path

import pytest

from quintet.coupler.cli import main
from quintet.scenarios.shock_layer_particle.window_limit import growth, longest

SCENES = Path(__file__).resolve().parents[2] / "scenarios"
# Number of the limit among those of its scene, and between what shares of the prediction it lies.
LIMITS = {
    "shock_tube": (0, 0.95, 1.15),
    "vortex": (0, 0.95, 1.15),
    "wedge": (0, 0.9, 1.1),
    "couette": (0, 0.95, 1.1),
    "flat_plate": (0, 0.9, 1.1),
    "blunt_sphere": (0, 0.9, 1.1),
    "blunt_sphere with friction": (1, 0.95, 1.1),
    "moving_sphere": (0, 0.95, 1.15),
    "moving_sphere between cuts": (1, 0.85, 1.15),
    "shock_layer_particle": (0, 0.95, 1.15),
    "dusty_shock": (0, 0.9, 1.1),
}


@pytest.mark.full
@pytest.mark.parametrize("name", LIMITS)
def test_limits_are_found_where_theory_predicts_them(name: str, tmp_path: Path) -> None:
    number, lowest, highest = LIMITS[name]
    scene = name.split()[0]
    tables = tomllib.loads((SCENES / scene / "scene.toml").read_text())["stability"]
    other_limits = [k for k in range(len(tables)) if k != number]
    words = ["stability", scene, "--out", str(tmp_path / "runs"), "--json", str(tmp_path / "found")]
    for k in other_limits:  # their two ends alone
        words += ["--set", f"stability.{k}.accuracy=0.5"]
    with pytest.raises(SystemExit) as ended:
        main(words)
    assert ended.value.code == 0
    limits = json.loads((tmp_path / "found").read_text())["limits"]
    matching = [limit for limit in limits if limit["name"] == tables[number]["name"]]
    assert matching and all(lowest < limit["ratio"] < highest for limit in matching), matching


def test_a_light_sphere_bears_windows_of_twice_its_radius_over_sound_times_its_density() -> None:
    assert [longest(ratio) for ratio in (0.05, 0.1, 0.2)] == pytest.approx(
        [0.1, 0.2, 0.4], rel=5e-3
    )
    assert longest(0.51) == float("inf")
    assert growth(0.39, 0.2) <= 1.0 < growth(0.42, 0.2)
