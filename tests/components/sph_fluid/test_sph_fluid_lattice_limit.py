"""Von Neumann's analysis of the fluid's lattice: known limits, and predictions in scenes."""

import tomllib
from pathlib import Path
from typing import Any

import pytest

from quintet.components.shared.smoothing.smoothing import STEEPEST
from quintet.components.sph_fluid.analysis.lattice_limit import growth, limit, scene_limit
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.interfaces.params import read

SCENES = Path(__file__).resolve().parents[3] / "scenarios"
PREDICTED = [
    (path.parent.name, table["name"], table["predicted"])
    for path in sorted(SCENES.glob("*/scene.toml"))
    for table in tomllib.loads(path.read_text("utf-8")).get("stability", [])
    if "lattice_limit.py" in table.get("source", "")
]
assert len(PREDICTED) > 10  # or the sources name the tool otherwise


def fluid(**keys: Any) -> SphFluidParams:
    """Return a small tank without viscosity, in two dimensions."""
    table = {
        "spacing": 0.1,
        "sound_speed": 40.0,
        "dimensions": 2,
        "kernel": "wendland",
        "smoothing": 2.0,
        "fluid": [{"shape": "box", "lowest": [0.0, 0.0, 0.0], "highest": [1.0, 0.1, 1.0]}],
        "viscosity": {"artificial": 0.0},
        "boundary": {"walls": {"lowest": [0.0, 0.0, 0.0], "highest": [1.0, 0.1, 1.5]}},
    }
    params, mistakes = read(SphFluidParams, table | keys, "water")
    assert params is not None, mistakes
    return params


def test_sound_alone_holds_to_that_of_the_steepest_wave_in_position_verlet() -> None:
    courant = limit(lambda c: fluid(integration="symplectic", courant=c), 1.0, 3.0)
    assert courant == pytest.approx(2.0 / STEEPEST["wendland"], rel=0.03)


def test_no_wave_grows_within_the_proven_limit_of_the_damper() -> None:
    assert growth(fluid(integration="symplectic", courant=3.0, acoustic_damper=0.5)) < 1.0 + 1e-9


@pytest.mark.parametrize(("scene", "name", "predicted"), PREDICTED)
def test_predictions_of_scenes_are_those_of_the_lattice(
    scene: str, name: str, predicted: float
) -> None:
    assert scene_limit(SCENES / scene / "scene.toml", name) == pytest.approx(predicted, rel=0.01)
