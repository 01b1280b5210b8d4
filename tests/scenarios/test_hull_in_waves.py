"""A hull in waves: it floats beside a piston at rest, and answers waves as linear theory says."""

import math
import textwrap
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import trimesh

import quintet
from quintet.components.sph_fluid.setup.wave_theory import wave_number
from quintet.coupler.files.recording import Recording
from quintet.coupler.scene.read import load
from quintet.scenarios.floating_hull import hull
from quintet.scenarios.hull_in_waves import response

Run = Callable[..., dict]
BESIDE_PISTON = str(Path(__file__).parent / "float_beside_piston.toml")
SPACING = 0.02  # m, of that scene


def test_a_float_stays_at_its_draught_beside_a_piston_at_rest(run_scene: Run) -> None:
    run = run_scene(BESIDE_PISTON)
    assert run["status"] == "done" and not run["warnings"]
    (link,) = run["ledger"]["links"]
    assert link["momentum_residual"] < 1e-12
    with Recording(run["folder"]) as recording:
        position = recording.field("float", "motion.position")[:, 0]
        late = recording.times("float") > 0.2
    draught = 0.28 - position[late, 2]  # m: half of the edge above its centre at the level, 0.2 m
    assert draught.mean() == pytest.approx(0.08, abs=0.5 * SPACING)
    assert position[late, 0].mean() == pytest.approx(0.3, abs=0.5 * SPACING)


def test_references_are_of_this_scene_and_tend_to_one_in_long_waves() -> None:
    scene = load("hull_in_waves")
    height, heave, pitch = scene.expect
    k = response.wave_number(2.0 * math.pi / response.PERIOD)
    assert k == pytest.approx(wave_number(2.0 * math.pi / response.PERIOD, response.DEPTH, 9.81))
    assert height.waves is not None
    assert height.waves.length == pytest.approx(2.0 * math.pi / k, rel=1e-4)
    amplitude = 0.5 * (height.value or 0.0)
    assert heave.scale == pytest.approx(1.0 / amplitude)
    assert pitch.scale == pytest.approx(2.0 / (k * amplitude), rel=1e-4)
    # Five hull lengths are long: heave and pitch are those of the surface within 5 %.
    assert [heave.value, pitch.value] == pytest.approx([1.0, 1.0], abs=0.05)


def test_the_hull_begins_at_its_draught() -> None:
    (body,) = load("hull_in_waves").components["hull"].params["bodies"]
    corners = np.asarray(trimesh.load_mesh(hull.FILE).triangles, np.float64)
    keel = body["origin"][2] + float(corners[:, :, 2].min())
    draught = hull.rest(corners, body["density"])[0]
    assert hull.DENSITY == response.DENSITY == body["density"]
    assert -hull.DEPTH + draught == pytest.approx(response.WATERLINE, abs=1e-4)
    assert keel + draught == pytest.approx(response.DEPTH, abs=1e-4)


def test_the_steps_of_the_manual_lead_to_a_hull_at_its_draught(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """From an STL in mm that stands on its bow, its keel along +y, as scenarios/README.md says."""
    text = (Path(response.__file__).parents[1] / "README.md").read_text()
    steps = text.split("### From an STL to the first picture")[1]
    (tmp_path / "my_hull.toml").write_text(steps.split("```toml\n")[1].split("```")[0])
    mesh = trimesh.load_mesh(hull.FILE)
    mesh.apply_scale(1000.0)
    axes = np.eye(4)
    axes[:3, :3] = [[0.0, -1.0, 0.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]]  # x to z, -z to y
    mesh.apply_transform(axes)
    mesh.export(tmp_path / "hull.stl")
    assert mesh.extents == pytest.approx([240.0, 160.0, 480.0], rel=1e-5)
    monkeypatch.chdir(tmp_path)
    exec(steps.split("```py\n")[1].split("```")[0].replace("# hull.apply", "hull.apply"), {})
    assert capsys.readouterr().out == (
        "closed, outwards: True length, beam, depth [0.48 0.24 0.16] m\n"
        "volume 0.01225 m3, its centre at 59% of the depth\n"
        "of 6.74 kg: draught 0.1038 m, GM 0.023 m\n"
        "at a draught of 0.1 m: 6.38 kg\n"
    )
    check = str(quintet.check("my_hull.toml"))
    assert (
        "note of hull: hull_m.stl is 0.48 x 0.24 x 0.16 m, encloses 0.01225 m3 and has 6.74 kg"
    ) in check
    assert (
        "note of hull: bodies[0] weighs 6.74 kg and stands in 6.738 kg of water: without turning "
        "or other forces, it floats where it is\n"
    ) in check


def test_the_wave_length_of_the_manual_is_that_of_the_scene(
    capsys: pytest.CaptureFixture[str],
) -> None:
    text = (Path(response.__file__).parents[1] / "README.md").read_text()
    steps = text.split("### From an STL to the first picture")[1]
    exec(textwrap.dedent(steps.split("```py\n")[2].split("```")[0]), {})
    assert capsys.readouterr().out.startswith("length 2.4327")


@pytest.mark.full
@pytest.mark.parametrize("name", ["wave height", "heave", "pitch"])
def test_the_hull_answers_the_waves(quick: dict, name: str) -> None:
    expected = quick["by_name"][name]
    assert expected["met"], expected


@pytest.mark.full
def test_the_link_conserves_momentum_and_is_stable(quick: dict) -> None:
    (link,) = quick["ledger"]["links"]
    assert link["momentum_residual"] < 1e-12
    assert not quick["warnings"]


@pytest.fixture(scope="module")
def quick(run_scene: Run) -> dict:
    return run_scene("hull_in_waves", "--preset", "quick")
