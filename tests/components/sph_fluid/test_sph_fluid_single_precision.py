"""Pairs in single precision: their difference from double precision, also at rest."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from fluid_params import fluid_params

from quintet.components.sph_fluid.component import SphFluid
from quintet.interfaces.component import Fields

Make = Callable[..., SphFluid]
Join = Callable[..., Fields]
Strike = Callable[..., tuple[Any, Any]]
SPACING = 0.02
DEPTH = 20 * SPACING
ROUNDED = 2.0**-24  # half of single precision's last place


def slab(precision: str, width: float) -> SphFluid:
    """Water 0.4 m deep in a tank twice as long, in two dimensions, as dam breaks are computed."""
    settings: dict[str, Any] = {
        "dimensions": 2,
        "fluid": (((0.0, 0.0, 0.0), (width, SPACING, DEPTH)),),
        "boundary.walls": ((0.0, 0.0, 0.0), (2.0 * DEPTH, SPACING, 1.5 * DEPTH)),
        "boundary.method": "mdbc",
        "density_diffusion": 0.1,
        "negative_pressure": True,
        "boundary.wall_viscosity_factor": 0.0,
    }
    sound = 20.0 * math.sqrt(9.81 * DEPTH)
    params = fluid_params(spacing=SPACING, sound_speed=sound, precision=precision, **settings)
    return SphFluid(params)


def run(fluid: SphFluid, steps: int, dt: float) -> None:
    for _ in range(steps):
        fluid.step(dt)


def test_a_dam_breaks_as_in_double_precision() -> None:
    single, double = slab("float32", DEPTH), slab("float64", DEPTH)
    dt = double.stable_dt()
    for fluid in (single, double):
        run(fluid, 1500, dt)
    single_points, double_points = single.view()["points"], double.view()["points"]
    assert double_points[:, 0].max() > 1.9 * DEPTH  # it has run almost to the far wall
    assert np.abs(single_points - double_points).max() < 0.05 * SPACING
    assert single_points.mean(axis=0) == pytest.approx(
        double_points.mean(axis=0), abs=1e-4 * SPACING
    )
    single_totals, double_totals = single.totals(), double.totals()
    assert single_totals.kinetic == pytest.approx(double_totals.kinetic, rel=1e-4)


def test_rounding_alone_parts_the_two_at_first() -> None:
    single, double = slab("float32", DEPTH), slab("float64", DEPTH)
    dt = double.stable_dt()
    for fluid in (single, double):
        run(fluid, 50, dt)
    difference = single.view()["points"] - double.view()["points"]
    assert 0.0 < np.abs(difference).max() < 1e-4 * SPACING


def test_still_water_is_no_less_still() -> None:
    worst = {}
    for precision in ("float32", "float64"):
        fluid = slab(precision, 2.0 * DEPTH)
        run(fluid, 1500, fluid.stable_dt())
        view = fluid.view()
        depth = DEPTH - view["points"][:, 2]
        error = np.sqrt(np.mean((view["pressure"] - 9810.0 * depth) ** 2)) / (9810.0 * DEPTH)
        speed = np.linalg.norm(view["velocity"], axis=1).max() / math.sqrt(9.81 * DEPTH)
        worst[precision] = (error, speed)
    assert worst["float32"] == pytest.approx(worst["float64"], rel=0.1)


@pytest.mark.parametrize(
    ("friction", "kernel"),
    [  # once; the others are compiled for themselves
        ("stress", "cubic"),
        pytest.param("laplacian", "wendland", marks=pytest.mark.full),
        pytest.param("laplacian", "cubic", marks=pytest.mark.full),
        pytest.param("stress", "wendland", marks=pytest.mark.full),
    ],
)
def test_samples_take_what_the_fluid_loses_to_rounding(
    drop: Make, plate: Join, struck: Strike, kernel: str, friction: str
) -> None:
    settings = {"kernel": kernel, "viscosity.form": friction, "viscosity.kinematic": 1e-3}
    fluid = drop(gravity=(0.0, 0.0, 0.0), precision="float32", **settings)
    impulse, gained = struck(fluid, plate(fluid))
    assert impulse.sum(axis=0) == pytest.approx(-gained, abs=20 * ROUNDED * np.abs(impulse).sum())


def test_a_copy_of_the_state_goes_on_with_the_same_bits(drop: Make) -> None:
    first, second = (drop(precision="float32", xsph=0.5) for _ in range(2))
    run(first, 20, 1e-4)
    second.load(first.save())
    for fluid in (first, second):
        run(fluid, 20, 1e-4)
    first_state, second_state = first.save(), second.save()
    assert all(np.array_equal(first_state[name], second_state[name]) for name in first_state)
