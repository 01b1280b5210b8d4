"""Settings from safe to absurd: no result is silently wrong, and none is a false alarm."""

import json
from pathlib import Path

import pytest

from quintet.coupler.cli import main

CASES = [
    pytest.param("ball_on_floor.toml", name, marks=pytest.mark.slow)
    for name in (
        "fixed step", "longest step", "stiffness", "restitution", "impact speed",
        "steps per contact",
    )
]  # fmt: skip
CASES += [pytest.param("newtons_cradle", name, marks=pytest.mark.slow) for name in
          ("step", "window", "courant")]  # fmt: skip
# Of each kind of link; of the two springs each scheme and each setting once.
CASES += [pytest.param("two_springs", name, marks=pytest.mark.slow) for name in
          ("window, iterated", "stiffness, serial")]  # fmt: skip
CASES += [pytest.param("two_springs", name, marks=pytest.mark.full) for name in
          ("window, serial", "stiffness, iterated")]  # fmt: skip
CASES += [pytest.param("floating_square", name, marks=pytest.mark.full) for name in
          ("window", "density")]  # fmt: skip
CASES += [pytest.param("dust_in_stream", "window", marks=pytest.mark.full)]
CASES += [pytest.param("glued_bar", name, marks=pytest.mark.full) for name in
          ("window", "substeps")]  # fmt: skip
CASES += [pytest.param(scene, name, marks=pytest.mark.full) for scene in ("shock_tube", "wedge")
          for name in ("neighbours", "jitter", "Courant number")]  # fmt: skip


@pytest.mark.parametrize(("scene", "scan"), CASES)
def test_no_wrong_result_is_silent(scene: str, scan: str, tmp_path: Path) -> None:
    file = str(Path(__file__).with_name(scene)) if scene.endswith(".toml") else scene
    words = ["scan", file, "--name", scan, "--out", str(tmp_path / "runs")]
    with pytest.raises(SystemExit) as ended:
        main([*words, "--json", str(tmp_path / "found.json")])
    (result,) = json.loads((tmp_path / "found.json").read_text())["scans"]
    verdicts = [row["verdict"] for row in result["rows"]]
    assert ended.value.code == 0 and "SILENT" not in verdicts
    assert verdicts[0] == "right" and "false alarm" not in verdicts


@pytest.mark.full
@pytest.mark.parametrize(
    ("scene", "scan", "right"),
    [("water_on_plate", "window", 3), ("hot_bar_coupled", "relaxation", 2)],
)
def test_nothing_is_silent_where_only_the_way_to_rest_is_wrong(
    scene: str, scan: str, right: int, tmp_path: Path
) -> None:
    """Long windows or swings are warned of, although means at rest may be right."""
    words = ["scan", scene, "--name", scan, "--out", str(tmp_path / "runs")]
    with pytest.raises(SystemExit) as ended:
        main([*words, "--json", str(tmp_path / "found.json")])
    (result,) = json.loads((tmp_path / "found.json").read_text())["scans"]
    verdicts = [row["verdict"] for row in result["rows"]]
    assert ended.value.code == 0 and "SILENT" not in verdicts
    assert verdicts[:right] == ["right"] * right and "right" not in verdicts[right:]
