"""Readings of gauges: exact fields, levels, the front without its spray, energies."""

import math
import subprocess
import sys

import numpy as np
import pytest
from fluid_params import fluid_params, nested

from quintet.components.sph_fluid import MANIFEST, SphFluidParams
from quintet.components.sph_fluid.component import SphFluid
from quintet.interfaces.component import outputs_of
from quintet.interfaces.params import read

SPACING = 0.02
BOX = ((0.0, 0.0, 0.0), (0.2, 0.2, 0.16))  # m


def fluid_with(**changes):
    settings = {"spacing": SPACING, "sound_speed": 30.0, "fluid": (BOX,)}
    return SphFluid(fluid_params(**(settings | changes)))


def walled(**changes):
    return fluid_with(boundary__walls=BOX, boundary__method="mdbc", **changes)


@pytest.mark.parametrize(
    "point",
    [(0.1, 0.1, 0.08), (0.103, 0.091, 0.05), (0.0, 0.1, 0.08), (0.2, 0.2, 0.0)],
    ids=["on the lattice", "beside it", "on a wall", "in a corner"],
)
def test_pressure_of_still_water_is_read_exactly(point):
    fluid = walled(gauges__pressure_gauges=(point,))
    rows, shake = slice(fluid.state.fluid), np.random.default_rng(2).uniform(-0.2, 0.2, (2000, 3))
    place, motion = fluid.state.position_density, fluid.state.velocity_pressure
    place[rows, :3] += SPACING * shake[: fluid.state.fluid]
    motion[rows, 3] = (5000.0 - 9810.0 * place[rows, 2]) / place[rows, 3] ** 2
    pressure = outputs_of(fluid)["pressure_gauge.pressure"]
    assert pressure == pytest.approx([5000.0 - 9810.0 * point[2]], rel=1e-11)


def test_hydrostatic_pressure_is_read_on_the_floor_at_the_start():
    fluid = walled(gauges__pressure_gauges=((0.1, 0.1, 0.0), (0.0, 0.0, 0.0), (0.1, 0.1, 0.08)))
    pressure = outputs_of(fluid)["pressure_gauge.pressure"]
    assert pressure == pytest.approx([9810.0 * 0.16, 9810.0 * 0.16, 9810.0 * 0.08], rel=1e-9)


@pytest.mark.parametrize(("top", "share"), [(0.08, 0.5 / 0.85), (0.16, 1.0)])
def test_a_gauge_on_a_face_that_is_half_wet_reads_its_share(top, share):
    # The fluid ends at the gauge, or goes on beyond it.
    water = ((0.0, 0.0, 0.0), (0.2, 0.2, top))
    fluid = walled(
        fluid=(water,), gauges__pressure_gauges=((0.0, 0.1, 0.08),), gravity=(0.0, 0.0, 0.0)
    )
    rows = slice(fluid.state.fluid)
    fluid.state.velocity_pressure[rows, 3] = 5000.0 / fluid.state.position_density[rows, 3] ** 2
    pressure = outputs_of(fluid)["pressure_gauge.pressure"]
    assert pressure == pytest.approx([5000.0 * share], rel=0.01)


def test_a_dry_gauge_reads_zero_and_one_that_a_drop_strikes_its_share():
    spot = (0.5, 0.1, 0.1)
    fluid = fluid_with(boundary__method="mdbc", gauges__pressure_gauges=(spot, (0.5, 0.1, 0.5)))
    fluid.state.position_density[0, :3] = spot
    fluid.state.velocity_pressure[0, 3] = 70.0 / fluid.state.position_density[0, 3] ** 2
    share = (
        SPACING**3 / (math.pi * (1.5 * SPACING) ** 3) * 1000.0 / fluid.state.position_density[0, 3]
    )
    pressure = outputs_of(fluid)["pressure_gauge.pressure"]
    assert pressure == pytest.approx([70.0 * share / 0.85, 0.0], rel=1e-3)


@pytest.mark.parametrize("tension", [False, True])
@pytest.mark.parametrize("method", ["dbc", "mdbc"])
def test_a_gauge_reads_nothing_until_fluid_reaches_it(tension, method):
    # Extrapolated above the surface, the pressure of still water is below zero.
    above = tuple((0.1, 0.1, 0.16 + k * SPACING) for k in (0.5, 1.0, 2.0, 2.9))
    before = tuple((0.2 + k * SPACING, 0.1, 0.08) for k in (0.6, 1.0, 2.0, 2.9))
    fluid = fluid_with(
        boundary__method=method,
        negative_pressure=tension,
        gauges__pressure_gauges=above + before,
    )
    rows = slice(fluid.state.fluid)
    fluid.state.velocity_pressure[rows, 3] -= 2000.0 / fluid.state.position_density[rows, 3] ** 2
    np.testing.assert_array_equal(outputs_of(fluid)["pressure_gauge.pressure"], 0.0)


def test_tension_is_read_inside_the_fluid_alone_where_it_bears_any():
    for tension in (False, True):
        fluid = fluid_with(
            gravity=(0.0, 0.0, 0.0),
            negative_pressure=tension,
            gauges__pressure_gauges=((0.1, 0.1, 0.08),),
        )
        density = fluid.state.position_density[: fluid.state.fluid, 3]
        fluid.state.velocity_pressure[: fluid.state.fluid, 3] = -500.0 / density**2
        pressure = outputs_of(fluid)["pressure_gauge.pressure"]
        assert pressure == pytest.approx([-500.0 if tension else 0.0], rel=1e-6)


@pytest.mark.parametrize(("height", "tolerance"), [(0.16, 0.1), (0.06, 0.1), (0.04, 0.25)])
def test_level_of_still_water_is_within_a_tenth_of_a_spacing_unless_it_is_shallow(
    height, tolerance
):
    water = (BOX[0], (0.2, 0.2, height))
    spots = ((0.1, 0.1), (0.107, 0.093), (0.0, 0.1), (0.01, 0.19), (0.0, 0.0), (0.5, 0.1))
    settings = {
        "fluid": (water,),
        "boundary.walls": (BOX[0], (0.6, 0.2, 0.3)),
        "gauges.level_gauges": spots,
    }
    levels = outputs_of(fluid_with(**settings))["level_gauge.height"]
    assert levels[:5] == pytest.approx(np.full(5, height), abs=tolerance * SPACING)
    assert levels[5] == 0.0  # dry: the floor


def test_level_is_the_highest_and_passes_over_drops():
    boxes = (BOX, ((0.0, 0.0, 0.4), (0.2, 0.2, 0.5)))
    spots = ((0.1, 0.1), (0.17, 0.1))
    fluid = fluid_with(fluid=boxes, gauges__level_gauges=spots)
    fluid.state.position_density[0, :3] = [0.1, 0.1, 0.8]
    assert outputs_of(fluid)["level_gauge.height"] == pytest.approx([0.5, 0.5], abs=0.1 * SPACING)
    high = fluid.state.position_density[:, 2] > 0.35
    fluid.state.position_density[high, 0] += 1.0
    assert outputs_of(fluid)["level_gauge.height"] == pytest.approx([0.16, 0.16], abs=0.1 * SPACING)


@pytest.mark.parametrize("smoothing", [1.0, 1.2])
def test_level_of_water_is_read_whatever_the_smoothing_and_of_a_drop_it_is_not(smoothing):
    """With Wendland's kernel at 1.0 spacing, two drops fill more than a whole spot."""
    fluid = fluid_with(
        dimensions=2,
        fluid=(((0.0, 0.0, 0.0), (0.4, 0.1, 0.2)),),
        kernel="wendland",
        smoothing=smoothing,
        **{
            "boundary.walls": (BOX[0], (0.8, 0.1, 0.3)),
            "gauges.level_gauges": ((0.2, 0), (0.7, 0)),
        },
    )
    fluid.state.position_density[0, :3] = [0.7, 0.05, 0.1]
    level, drop = outputs_of(fluid)["level_gauge.height"]
    assert level == pytest.approx(0.2, abs=0.2 * SPACING) and drop == 0.0


def test_level_follows_a_slope():
    fluid = fluid_with(gauges__level_gauges=((0.1, 0.1), (0.06, 0.1), (0.14, 0.1)))
    fluid.state.position_density[:, 2] += 0.1 * (fluid.state.position_density[:, 0] - 0.1)
    exact = [0.16, 0.156, 0.164]
    assert outputs_of(fluid)["level_gauge.height"] == pytest.approx(exact, abs=0.1 * SPACING)


@pytest.mark.parametrize(("axis", "end"), [("x", 0.2), ("y", 0.2), ("z", 0.16)])
def test_front_of_a_box_is_its_face(axis, end):
    fluid = fluid_with(gauges__front_gauge=axis, gravity=(0.0, 0.0, 0.0))
    assert outputs_of(fluid)["front_gauge.position"] == pytest.approx([end])
    fluid.step(1e-6)
    assert outputs_of(fluid)["front_gauge.position"] == pytest.approx([end], abs=1e-6)


@pytest.mark.parametrize(("drops", "front"), [(0, 0.2), (1, 0.2), (3, 0.2), (200, 0.3)])
def test_front_leaves_out_spray_but_not_bulk(drops, front):
    fluid = fluid_with(gauges__front_gauge="x", gravity=(0.0, 0.0, 0.0))
    spray = fluid.state.position_density[: fluid.state.fluid, 0].argsort(kind="stable")[::-1][
        :drops
    ]
    fluid.state.position_density[spray, 0] += 0.1
    fluid.step(1e-9)
    assert outputs_of(fluid)["front_gauge.position"] == pytest.approx([front], abs=1e-6)


def test_motion_gauge_agrees_with_the_totals():
    fluid = fluid_with(gauges__motion_gauge=True)
    for _ in range(5):
        fluid.step(fluid.stable_dt())
    outputs, totals = outputs_of(fluid), fluid.totals()
    points, velocity = fluid.view()["points"], fluid.view()["velocity"]
    assert outputs["motion_gauge.kinetic"] == pytest.approx([totals.kinetic])
    assert outputs["motion_gauge.potential"] == pytest.approx([totals.potential])
    assert outputs["motion_gauge.centre"] == pytest.approx(points.mean(axis=0)[np.newaxis])
    fastest = np.linalg.norm(velocity, axis=1).max()
    assert outputs["motion_gauge.speed"] == pytest.approx([fastest], rel=1e-6)


def test_gauges_do_not_depend_on_what_was_before_a_repeated_window():
    fluid = fluid_with(
        gauges__front_gauge="x",
        gauges__level_gauges=((0.1, 0.1),),
        gauges__pressure_gauges=((0.1, 0.1, 0.1),),
    )
    saved, first = fluid.save(), outputs_of(fluid)
    for _ in range(3):
        fluid.step(fluid.stable_dt())
    fluid.load(saved)
    repeated = outputs_of(fluid)
    assert all(np.array_equal(first[key], repeated[key]) for key in first)


def test_only_gauges_that_are_on_have_a_port():
    base = {"spacing": SPACING, "sound_speed": 30.0, "fluid": (BOX,)}
    for gauge, name in (
        ({}, None),
        ({"gauges.pressure_gauges": ((0.0, 0.0, 0.0),)}, "pressure_gauge"),
        ({"gauges.level_gauges": ((0.0, 0.0),)}, "level_gauge"),
        ({"gauges.front_gauge": "x"}, "front_gauge"),
        ({"gauges.motion_gauge": True}, "motion_gauge"),
    ):
        params = fluid_params(**base, **gauge)
        names = [port.name for port in MANIFEST.ports(params)[1]]
        assert names == (["surface_load", name] if name else ["surface_load"])


OFF = """
import sys
from quintet.components.sph_fluid import SphFluidParams
from quintet.components.sph_fluid.component import SphFluid
from quintet.interfaces.component import outputs_of
from quintet.components.sph_fluid.setup.shapes import FluidRegion
region = FluidRegion(lowest=(0.0, 0.0, 0.0), highest=(0.12, 0.12, 0.12))
fluid = SphFluid(SphFluidParams(spacing=0.02, sound_speed=20.0, fluid=(region,)))
assert list(outputs_of(fluid)) == ["surface_load.force"]
assert not [name for name in sys.modules if name.endswith(("gauges", "gauge_kernels"))]
"""


def test_gauges_that_are_off_are_not_imported():
    subprocess.run([sys.executable, "-c", OFF], check=True)


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        (
            {"gauges.front_gauge": "w"},
            "water.gauges.front_gauge should be 'x', 'y' or 'z'; found 'w'",
        ),
        ({"gauges.pressure_gauges": [[0.0, 1.0]]}, "water.gauges.pressure_gauges.0.2 is needed"),
        (
            {"gauges.level_gauges": [[0.0, "high"]]},
            "water.gauges.level_gauges.0.1 should be a valid number",
        ),
        ({"gauges.level_gauge": [[0.0, 0.0]]}, "Did you mean level_gauges?"),
    ],
)
def test_a_wrong_gauge_is_refused_with_a_sentence(changes, sentence):
    base = {"spacing": SPACING, "sound_speed": 30.0, "fluid": [list(map(list, BOX))]}
    params, mistakes = read(SphFluidParams, nested(base | changes), "water")
    assert params is None and sentence in "\n".join(mistakes), mistakes


def test_gauges_read_nothing_that_is_not_finite():
    fluid = fluid_with(
        gauges__pressure_gauges=((0.1, 0.1, 0.1),),
        gauges__front_gauge="x",
        gauges__motion_gauge=True,
    )
    outputs = outputs_of(fluid)
    assert all(math.isfinite(value) for array in outputs.values() for value in array.ravel())
