"""Gas at walls, coarse: a blunt body, friction and heat between walls, a boundary layer."""

from collections.abc import Callable

import pytest

Run = Callable[..., dict]


@pytest.mark.parametrize("scene", ["blunt_sphere", "couette"])
def test_walls_do_to_a_gas_as_laws_say(run_scene: Run, scene: str) -> None:
    found = run_scene(scene, "--preset", "quick")
    assert all(one["met"] for one in found["expect"]), found["expect"]


@pytest.mark.full
@pytest.mark.parametrize(
    ("scene", "preset"),
    [
        ("blunt_sphere", "standard"),
        ("blunt_sphere", "mach3"),
        ("blunt_sphere", "cap"),
        ("blunt_sphere", "hot"),
        ("blunt_sphere", "drag"),
        ("couette", "standard"),
        ("flat_plate", "quick"),
        ("flat_plate", "standard"),
    ],
)
def test_finer_clouds_come_nearer(run_scene: Run, scene: str, preset: str) -> None:
    found = run_scene(scene, *(() if preset == "standard" else ("--preset", preset)))
    assert all(one["met"] for one in found["expect"]), found["expect"]


@pytest.mark.full
@pytest.mark.parametrize(
    "options",
    [
        (
            "--set", "components.gas.sphere.layers.jitter=0.6",
            "--set", "components.gas.sphere.layers.cross=false",
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
    found = run_scene("blunt_sphere", "--preset", "quick", *options)
    assert found["by_name"]["pitot"]["value"] == pytest.approx(1.0, abs=0.03)
