"""Mistakes in scenes are refused, and the plan of a run is known before it starts."""

import dataclasses
import math
import re
from typing import Any

import numpy as np
import pytest
from fluid_params import fluid_params, nested

from quintet.components.sph_fluid import MANIFEST, SphFluidParams
from quintet.components.sph_fluid.build import state
from quintet.interfaces.params import read

GOOD: dict[str, Any] = {
    "spacing": 0.1,
    "sound_speed": 60.0,
    "fluid": [[[0.0, 0.0, 0.0], [1.0, 1.0, 1.0]]],
    "boundary.method": "dbc",
    "boundary.walls": [[0.0, 0.0, 0.0], [2.0, 1.0, 2.0]],
}


def mistakes(**changes: Any) -> str:
    return "\n".join(read(SphFluidParams, nested(GOOD | changes), "water")[1])


def test_good_parameters_have_no_mistakes() -> None:
    assert mistakes() == ""
    assert mistakes(boundary__walls=None, gravity=[0.0, 0.0, 0.0], sound_speed=1.0) == ""


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"spacing": -0.1}, r"water.spacing should be greater than 0; found -0.1"),
        ({"spacings": 0.1}, r"water.spacings is not known. Did you mean spacing"),
        ({"fluid": []}, r"water: fluid must have at least one box; found none. Add a box."),
        (
            {"fluid": [[[0.0, 0.0, 0.0], [1.0, -1.0, 1.0]]]},
            r"fluid\[0\] must go from its lowest to its highest corner.*found .*-1.0.*Exchange",
        ),
        (
            {"fluid": [*GOOD["fluid"], [[0.5, 0.0, 0.0], [1.5, 1.0, 1.0]]]},
            r"fluid\[1\] must not overlap fluid\[0\]; found .* Cut one",
        ),
        (
            {"fluid": [[[0.0, 0.0, 0.0], [2.5, 1.0, 1.0]]]},
            r"fluid\[0\] must be inside the walls along x, 0.0 to 2.0 m; found 0.0 to 2.5 m. Move",
        ),
        ({"boundary.walls": [[0.0, 0.0, 0.0], [0.0, 1.0, 1.0]]}, r"walls must go from .* widen it"),
        (
            {"sound_speed": 20.0},
            r"sound_speed must be at least 10 sqrt\(g depth\) = 31.32 m/s .* found 20.0. Raise it",
        ),
        ({"smoothing": 4.0}, r"smoothing should be less than or equal to 3; found 4.0"),
        ({"boundary.open_faces": ["up"]}, r"water.boundary.open_faces.* found 'up'"),
        ({"xsph": 1.5}, r"water.xsph should be less than or equal to 1; found 1.5"),
        ({"shepard_every": -1}, r"water.shepard_every should be greater than or equal to 0"),
        ({"courant": 0.0}, r"water.courant should be greater than 0"),
        (
            {"viscosity.artificial": -0.1},
            r"water.viscosity.artificial should be greater than or equal to 0",
        ),
        ({"density": 0.0}, r"water.density should be greater than 0"),
        ({"gravity": [0.0, 0.0, "down"]}, r"water.gravity.2 .* found 'down'"),
        ({"negative_pressure": "no"}, r"water.negative_pressure .* found 'no'"),
        (
            {"acoustic_damper": 0.5},
            r"acoustic_damper needs integration symplectic.* 0.5 and integration extrapol.* Set",
        ),
        (
            {"acoustic_damper": -0.5},
            r"water.acoustic_damper should be greater than or equal to 0; found -0.5",
        ),
        ({"kernel": "gaussian"}, r"water.kernel .* found 'gaussian'"),
    ],
)
def test_mistake_says_where_rule_value_and_cure(changes: dict[str, Any], sentence: str) -> None:
    text = mistakes(**changes)
    assert re.search(sentence, text, re.DOTALL), text


def test_fluid_may_reach_out_of_an_open_face() -> None:
    assert mistakes(fluid=[[[0.0, 0.0, 0.0], [1.0, 1.0, 2.5]]]) == ""


def test_plan_counts_what_is_built() -> None:
    params = read(SphFluidParams, nested(GOOD | {"boundary.open_faces": ["z+", "x-"]}), "water")[0]
    plan = MANIFEST.plan(params) if MANIFEST.plan else None
    assert plan is not None and plan.items == len(state(params).position_density)
    assert plan.dt == pytest.approx(0.2 * 0.15 / 66.0)


def test_benchmark_tank_has_142421_particles() -> None:
    tank = ((0.005, 0.005, 0.005), (1.595, 0.595, 0.605))
    water = ((0.005, 0.005, 0.005), (0.605, 0.595, 0.305))
    params = fluid_params(spacing=0.01, sound_speed=40.0, fluid=(water,), boundary__walls=tank)
    assert MANIFEST.plan is not None
    assert MANIFEST.plan(params).items == 142421


def test_wall_goes_on_with_the_lattice_of_the_fluid() -> None:
    params = read(SphFluidParams, nested(GOOD), "water")[0]
    initial = state(params)
    wall = initial.position_density[initial.fluid :, :3]
    assert wall.min(axis=0) == pytest.approx([-0.05, -0.05, -0.05])
    assert wall.max(axis=0) == pytest.approx([2.05, 1.05, 1.95])
    assert initial.position_density[: initial.fluid, :3].min(axis=0) == pytest.approx([0.05] * 3)


def test_pressure_at_the_start_is_hydrostatic() -> None:
    params = read(SphFluidParams, nested(GOOD), "water")[0]
    initial = state(params)
    z, density = (
        initial.position_density[: initial.fluid, 2],
        initial.position_density[: initial.fluid, 3],
    )
    stiffness = 60.0**2 * 1000.0 / 7.0
    pressure = stiffness * ((density / 1000.0) ** 7 - 1.0)
    assert pressure == pytest.approx(9810.0 * (1.0 - z), rel=1e-9)


def test_ports_are_the_shared_ones() -> None:
    for boundary, fields in (("dbc", 2), ("mdbc", 3)):
        takes, gives = MANIFEST.ports(fluid_params(**tuples(), boundary__method=boundary))
        assert [port.name for port in (*takes, *gives)] == ["surface", "surface_load"]
        assert len(takes[0].fields) == fields
    assert math.isfinite(MANIFEST.load()(fluid_params(**tuples())).stable_dt())


def tuples() -> dict[str, Any]:
    return {"spacing": 0.5, "sound_speed": 60.0, "fluid": (((0.0,) * 3, (1.0,) * 3),)}


def test_water_under_water_starts_under_the_pressure_of_both() -> None:
    boxes = (((0.0, 0.0, 0.0), (0.4, 0.4, 0.2)), ((0.0, 0.0, 0.2), (0.2, 0.4, 0.4)))
    beside = ((0.4, 0.0, 0.0), (0.6, 0.4, 0.2))  # nothing stands on it
    params = fluid_params(spacing=0.05, sound_speed=20.0, fluid=(*boxes, beside))
    initial = state(params)
    z, density = initial.position_density[:, 2], initial.position_density[:, 3]
    depth = np.where(initial.position_density[:, 0] < 0.4, 0.4, 0.2) - z
    pressure = 400.0 * 1000.0 / 7.0 * ((density / 1000.0) ** 7 - 1.0)
    np.testing.assert_allclose(pressure, 9810.0 * depth, rtol=1e-6)


def test_an_old_key_is_answered_with_the_new_one() -> None:
    for old, new in SphFluidParams.RENAMED.items():
        (sentence,) = read(SphFluidParams, nested(GOOD) | {old: 1}, "components.water")[1]
        assert sentence == f"components.water.{old} is now {new}. Rename it."
        *parents, key = new.split(".")
        section = SphFluidParams
        for parent in parents:
            section = type(getattr(section, parent))
        assert key in {field.name for field in dataclasses.fields(section)}
