"""Gas at walls, coarse: a blunt body, friction and heat between walls, a boundary layer."""

import json
import tomllib
from collections.abc import Callable
from pathlib import Path

import pytest

import quintet.scenarios.blunt_sphere.drag as sphere_drag
from quintet.components.meshless_gas.point_particles.laws import LOTH, drag_factor

Run = Callable[..., dict]
SPHERE = tomllib.loads(Path(sphere_drag.__file__).with_name("scene.toml").read_text())
CASES = {case["label"]: case["settings"] for case in SPHERE["presets"]["drag"]["study"]}


@pytest.mark.parametrize("scene", ["blunt_sphere", "couette"])
def test_walls_do_to_a_gas_as_laws_say(run_scene: Run, scene: str) -> None:
    results = run_scene(scene, "--preset", "quick")
    assert all(outcome["met"] for outcome in results["expect"]), results["expect"]


@pytest.mark.full
@pytest.mark.parametrize(
    ("scene", "preset"),
    [
        ("blunt_sphere", "standard"),
        ("blunt_sphere", "mach3"),
        ("blunt_sphere", "hot"),
        ("couette", "standard"),
        ("flat_plate", "quick"),
        ("flat_plate", "standard"),
    ],
)
def test_finer_clouds_come_nearer(run_scene: Run, scene: str, preset: str) -> None:
    results = run_scene(scene, *(() if preset == "standard" else ("--preset", preset)))
    assert all(outcome["met"] for outcome in results["expect"]), results["expect"]


@pytest.mark.full
def test_a_sphere_in_space_has_the_shock_of_an_axisymmetric_one(run_scene: Run) -> None:
    space = run_scene("blunt_sphere", "--preset", "cap")
    assert all(outcome["met"] for outcome in space["expect"]), space["expect"]
    same_cloud = (  # as many layers, nodes as far apart along the wall
        "--set", "components.gas.sphere.points_around=17",
        "--set", "components.gas.sphere.sector=0.8",
    )  # fmt: skip
    plane = run_scene("blunt_sphere", "--preset", "quick", *same_cloud)
    for name in ("standoff", "pitot"):
        in_space, in_plane = space["by_name"][name]["value"], plane["by_name"][name]["value"]
        assert in_space == pytest.approx(in_plane, rel=0.02)


@pytest.mark.full
@pytest.mark.parametrize(
    "options",
    [
        (
            "--set", "components.gas.sphere.layers.jitter=0.6",
            "--set", "components.gas.sphere.layers.line_stencils=false",
        ),
        (
            "--set", "components.gas.initial.velocity=[20.0, 0.0, 0.0]",
            "--set", "components.gas.boundaries.far.state.velocity=[20.0, 0.0, 0.0]",
            "--set", "end=0.4",
            *(part for k in range(3) for part in ("--set", f"expect.{k}.begin=0.4")),
        ),
    ],
    ids=["jitter of 0.6", "M = 20"],
)  # fmt: skip
def test_a_uniform_stream_may_strike_a_sphere_at_once(run_scene: Run, options: list[str]) -> None:
    results = run_scene("blunt_sphere", "--preset", "quick", *options)
    assert results["by_name"]["pitot"]["value"] == pytest.approx(1.0, abs=0.03)


@pytest.mark.full
@pytest.mark.parametrize("case", ["M2 Re1000", "M2 Re100", "M6 Re300"])
def test_drag_of_a_sphere_is_within_8_percent_of_loths(run_scene: Run, case: str) -> None:
    settings = [f"{path}={json.dumps(value)}" for path, value in CASES[case].items()]
    results = run_scene(
        "blunt_sphere", "--preset", "drag",
        *(word for setting in settings for word in ("--set", setting)),
    )  # fmt: skip
    assert results["by_name"]["drag"]["met"], results["expect"]


def test_drags_are_compared_with_the_law_of_loth() -> None:
    for settings in CASES.values():
        mach = settings["components.gas.initial.velocity"][0]
        reynolds = 2.0 * mach / settings["components.gas.gas.viscosity"]
        law = 24.0 / reynolds * drag_factor(LOTH, reynolds, mach, mach / reynolds, 1.0, 1.4)
        assert sphere_drag.loth(mach, reynolds) == pytest.approx(law, rel=1e-12)
        assert settings["expect.0.value"] == pytest.approx(law, rel=1e-3)
        assert settings["expect.0.within"] == pytest.approx(0.08 * law, rel=1e-2)
