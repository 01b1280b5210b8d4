"""The fastest mode of a structure: a known one, and predictions of limits in scenes."""

import math
import tomllib
from pathlib import Path

import pytest

from quintet.components.fe_plate.analysis.longest_step import greatest_frequency, structure_of
from quintet.components.fe_plate.component import FePlate
from quintet.components.fe_plate.meshes.params import Part
from quintet.components.fe_plate.meshes.selections import Fixed
from quintet.components.fe_plate.params import FePlateParams
from quintet.components.shared.materials.params import Material

SCENES = Path(__file__).resolve().parents[3] / "scenarios"
LIMITS = [
    (path.parent.name, table["name"], number, predicted, table["parameter"])
    for path in sorted(SCENES.glob("*/scene.toml"))
    for table in tomllib.loads(path.read_text("utf-8")).get("stability", [])
    if "longest_step.py of fe_plate" in table.get("source", "")
    for number, predicted in enumerate(
        table["predicted"] if isinstance(table["predicted"], list) else [table["predicted"]]
    )
]
STEPS = [limit for limit in LIMITS if limit[4] == "window" or limit[4].endswith(".courant")]
assert len(STEPS) > 8  # or the sources name the tool otherwise
STEEL = Material(density=7800.0, youngs_modulus=2e11, poissons_ratio=0.3)
EDGE = 0.01  # m


@pytest.mark.parametrize("integration", ["reduced", "full"])
def test_of_a_row_that_moves_along_itself_it_is_the_time_of_sound_through_an_element(
    integration: str,
) -> None:
    length = 8 * EDGE
    part = Part(
        lowest=(0.0, 0.0, 0.0), highest=(length, EDGE, EDGE), elements=(8, 1, 1), material=STEEL
    )
    guide = Fixed(lowest=(0.0, 0.0, 0.0), highest=(length, EDGE, EDGE), directions=("y", "z"))
    row = FePlate(
        FePlateParams(
            parts=(part,), fixed=(guide,), integration=integration, viscosity_linear=0.0,
            viscosity_quadratic=0.0,
        )
    )  # fmt: skip
    position = row.state.position.copy()
    c = math.sqrt((STEEL.bulk + 4.0 / 3.0 * STEEL.shear) / STEEL.density)
    assert 2.0 / greatest_frequency(row) == pytest.approx(EDGE / c, rel=1e-5)
    assert (row.state.position == position).all() and not row.state.velocity.any()


@pytest.mark.parametrize(("scene", "name", "number", "predicted", "parameter"), STEPS)
def test_predictions_of_scenes_are_those_of_their_meshes(
    scene: str, name: str, number: int, predicted: float, parameter: str
) -> None:
    structure = structure_of(SCENES / scene / "scene.toml", name, number)
    step = 2.0 / greatest_frequency(structure)
    unit = 1.0 if parameter == "window" else structure.bound
    assert step / unit == pytest.approx(predicted, rel=2e-3)


def test_a_rim_is_as_stiff_as_a_window_with_its_viscosity_allows() -> None:
    """ξ = C₁ l ω/4c does not depend on the stiffness, and ω² is proportional to it."""
    structure = structure_of(SCENES / "al_ball_7400_glued" / "scene.toml", "stiffness of the rim")
    ω = greatest_frequency(structure)
    table = tomllib.loads((SCENES / "al_ball_7400_glued" / "scene.toml").read_text("utf-8"))
    (limit,) = table["stability"]
    keys = limit["settings"]["components.rim.parts.0.material"]
    rim = Material(**keys)
    c = math.sqrt((rim.bulk + 4.0 / 3.0 * rim.shear) / rim.density)
    linear = table["components"]["rim"].get("viscosity_linear", FePlateParams.viscosity_linear)
    ξ = linear * structure.built.shortest * ω / (4.0 * c)
    longest = 2.0 / ω * (math.sqrt(1.0 + ξ * ξ) - ξ)
    allowed = keys["youngs_modulus"] * (longest / limit["settings"]["window"]) ** 2
    assert allowed == pytest.approx(limit["predicted"], rel=0.01)
