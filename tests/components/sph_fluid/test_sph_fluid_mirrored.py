"""Mirrored walls: their mirror points, their density, and that no fluid passes them."""

import math
import sys

import numpy as np
import pytest
from fluid_params import fluid_params

from quintet.components.sph_fluid.boundary.walls import wall_points
from quintet.components.sph_fluid.component import SphFluid

TANK = {
    "boundary.walls": ((0.0, 0.0, 0.0), (0.8, 0.4, 0.8)),
    "fluid": (((0.0, 0.0, 0.0), (0.8, 0.4, 0.4)),),
}


def params(**changes):
    settings = {"spacing": 0.05, "sound_speed": 20.0 * math.sqrt(9.81 * 0.4), **TANK}
    return fluid_params(**(settings | {"boundary.method": "mdbc"} | changes))


def walls(fluid):
    rows = slice(fluid.state.fluid, None)
    return fluid.state.position_density[rows], fluid.state.mirror_point


def test_mirror_points_lie_as_deep_in_the_tank_as_particles_outside():
    particle, mirror = walls(SphFluid(params()))
    place = particle[:, :3]
    nearest = 0.5 * (place + mirror)
    low, high = np.array([0.0, 0.0, 0.0]), np.array([0.8, 0.4, np.inf])
    np.testing.assert_allclose(nearest, np.clip(place, low, high), atol=1e-12)
    corner = place[(place < low).all(axis=1)]
    assert len(corner) == 3**3  # layers as deep as the kernel reaches, in corners too


@pytest.mark.parametrize("slope", [(0.0, 0.0, 0.0), (0.5, -1.5, 2.5)])
def test_walls_carry_on_a_linear_density(slope):
    fluid = SphFluid(params(gravity=(0.0, 0.0, -300.0), sound_speed=150.0))
    state, rows = fluid.state, slice(fluid.state.fluid)
    linear = 1005.0 + state.position_density[:, :3] @ np.array(slope)
    state.position_density[rows, 3] = linear[rows]
    fluid.lists.sort(fluid.state)
    fluid._list()
    fluid._compute_rates(0.0, 0.0)
    points, density = walls(fluid)[0][:, :3], walls(fluid)[0][:, 3]
    wet = (points[:, 2] < 0.1) & (points[:, 2] > -0.03)
    expected = 1005.0 + points @ np.array(slope)
    np.testing.assert_allclose(density[wet], expected[wet], atol=1e-9)


def test_dry_walls_press_nothing():
    fluid = SphFluid(params())
    fluid.step(1e-5)
    particle, _ = walls(fluid)
    dry = particle[:, 2] > 0.4 + 4 * 0.05
    assert dry.any()
    assert (particle[dry, 3] == 1000.0).all()


def errors_at_rest(boundary, steps, **changes):
    """Largest error of pressure over ρgH, and speed over √(gH), of water at rest."""
    fluid = SphFluid(
        params(
            boundary__method=boundary,
            dimensions=2,
            kernel="wendland",  # as fluids of other tests are compiled
            density_diffusion=0.1,
            negative_pressure=True,
            **changes,
        )
    )
    for _ in range(steps):
        fluid.step(fluid.stable_dt())
    state, rows = fluid.state, slice(fluid.state.fluid)
    place, motion = state.position_density[rows], state.velocity_pressure[rows]
    pressure = motion[:, 3] * place[:, 3] ** 2
    error = np.abs(pressure - 9810.0 * (0.4 - place[:, 2])).max() / (9810.0 * 0.4)
    return error, np.linalg.norm(motion[:, :3], axis=1).max() / math.sqrt(9.81 * 0.4)


def test_still_water_stays_hydrostatic_with_mirrored_walls_alone():
    error, speed = errors_at_rest("mdbc", 2000)
    assert error < 0.03
    assert speed < 0.03
    assert errors_at_rest("dbc", 2000)[0] > 3 * error


def test_water_thrown_at_a_wall_stays_inside():
    high = ((0.0, 0.0, 0.0), (0.8, 0.4, 6.0))
    terms = {"dimensions": 2, "density_diffusion": 0.1, "negative_pressure": True, "courant": 0.3}
    fluid = SphFluid(params(boundary__walls=high, sound_speed=60.0, **terms))
    rows = slice(fluid.state.fluid)
    fluid.state.velocity_pressure[rows, 0] = 5.0
    for _ in range(800):
        fluid.step(fluid.stable_dt())
    place = fluid.state.position_density[: fluid.state.fluid]
    assert place[:, 0].max() < 0.8 + 0.25 * 0.05
    assert place[:, 2].min() > -0.25 * 0.05
    assert fluid.state.lost == 0


def test_obstacles_are_mirrored_in_their_wet_faces():
    box = ((0.3, 0.0, 0.0), (0.5, 0.4, 0.2))
    fluid = (((0.0, 0.0, 0.0), (0.3, 0.4, 0.4)),)
    parameters = params(boundary__obstacles=(box,), fluid=fluid)
    count = len(wall_points(parameters))
    particle, mirror = walls(SphFluid(parameters))
    place, mirror = particle[count:, :3], mirror[count:]
    assert len(place) > 0
    inside = (mirror > np.array(box[0]) + 1e-9) & (mirror < np.array(box[1]) - 1e-9)
    assert not inside.all(axis=1).any()
    nearest = 0.5 * (place + mirror)
    on_face = np.isclose(nearest, box[0]) | np.isclose(nearest, box[1])
    assert on_face.any(axis=1).all()


def test_only_a_scene_that_asks_imports_them():
    import subprocess

    program = (
        "import sys; from quintet.components.sph_fluid.params import Boundary, SphFluidParams;"
        "from quintet.components.sph_fluid.component import SphFluid;"
        "from quintet.components.sph_fluid.setup.shapes import FluidRegion;"
        "f = SphFluid(SphFluidParams(spacing=0.1, sound_speed=30.0,"
        " fluid=(FluidRegion(lowest=(0.0, 0.0, 0.0), highest=(0.3, 0.3, 0.3)),),"
        " boundary=Boundary(method='dbc')));"
        "f.step(1e-5); names = {m.rpartition('.')[2] for m in sys.modules};"
        "print(sorted(names & {'mirrored', 'mirrored_density', 'lubrication', 'film_geometry'}))"
    )
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert result.stdout.strip() == "[]", result.stderr


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"boundary.wall_offset": 1.5}, "half a spacing behind the face; found wall_offset 1.5"),
        (
            {"boundary.method": "dbc", "boundary.lubrication_films": True},
            "lubrication_films needs boundary.method mdbc",
        ),
        ({"dimensions": 2, "gravity": (0.0, 1.0, -9.81)}, "gravity has no y"),
        (
            {"dimensions": 2, "fluid": (((0.0, 0.0, 0.0), (0.8, 0.3, 0.4)),)},
            "all boxes must reach over the same y",
        ),
    ],
)
def test_mistakes_are_told(changes, sentence):
    with pytest.raises(ValueError, match=sentence):
        params(**changes)
