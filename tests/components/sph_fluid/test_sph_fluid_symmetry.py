"""Planes of symmetry: half of a symmetric flow moves as the whole does, and nothing passes."""

import math
import subprocess
import sys
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from fluid_params import fluid_params
from numpy.typing import NDArray

from quintet.components.shared.threads import Team
from quintet.components.sph_fluid import SphFluidParams
from quintet.components.sph_fluid.component import SphFluid
from quintet.interfaces.component import Fields, outputs_of
from quintet.interfaces.errors import StepError

SPACING, DEPTH = 0.02, 0.2
FULL = ((0.0, 0.0, 0.0), (0.2, 0.1, 2.0 * DEPTH))  # m
THIN = ((0.0, 0.0, 0.0), (0.08, 0.1, DEPTH))  # m
CALM = {"boundary.method": "mdbc", "density_diffusion": 0.1, "negative_pressure": True}
EVERY = CALM | {"viscosity.kinematic": 1e-4, "xsph": 0.3, "shepard_every": 10}

JOINED = frozenset({"surface", "surface_load"})


def params(**changes: Any) -> SphFluidParams:
    """Half a column of water between a plane of symmetry and a dry floor, in two dimensions."""
    settings = {
        "spacing": SPACING,
        "sound_speed": 20.0 * math.sqrt(9.81 * DEPTH),
        "dimensions": 2,
        "fluid": (((0.0, 0.0, 0.0), (0.1, 0.1, DEPTH)),),
        "boundary.walls": ((0.0, 0.0, 0.0), (0.6, 0.1, 0.4)),
        "boundary.symmetry": ("x-",),
    }
    return fluid_params(**(settings | CALM | changes))


def whole_params(half: SphFluidParams) -> SphFluidParams:
    """The same water and tank on both sides of all planes of symmetry through the origin."""
    edge = half.boundary
    axes = ["xyz".index(face[0]) for face in edge.symmetry]
    assert edge.walls is not None

    def extend(box: Any) -> Any:
        low, high = box.bounds
        x, y, z = (-high[axis] if axis in axes else low[axis] for axis in range(3))
        return replace(box, lowest=(x, y, z))

    return replace(
        half,
        fluid=tuple(map(extend, half.fluid)),
        boundary=replace(
            edge,
            obstacles=tuple(map(extend, edge.obstacles)),
            walls=extend(edge.walls),
            symmetry=(),
        ),
    )


def side_by_side(half_fluid: SphFluid, whole_fluid: SphFluid, end: float) -> float:
    """Advance both to a time [s]; return the largest difference of particles' places [m]."""
    time = 0.0
    while time < end:
        dt = min(half_fluid.stable_dt(), whole_fluid.stable_dt())
        half_fluid.step(dt)
        whole_fluid.step(dt)
        time += dt
    half_points, whole_points = half_fluid.view()["points"], whole_fluid.view()["points"]
    distance = np.abs(half_points[:, np.newaxis] - whole_points).max(axis=2)
    assert len(set(distance.argmin(axis=1))) == len(half_points)
    return float(distance.min(axis=1).max())


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"integration": "symplectic"},
        {"boundary.method": "dbc"},
        {"boundary.method": "potential"},
        EVERY,
    ],
    ids=["mirrored", "symplectic", "dynamic", "potential", "every term"],
)
def test_half_a_column_falls_as_the_whole_does(changes: dict[str, Any]) -> None:
    half = params(**changes)
    half_fluid = SphFluid(half)
    start = half_fluid.view()["points"]
    # Over 0.7 √(H/g) the water moves by a spacing; rounding alone may part the two.
    assert side_by_side(half_fluid, SphFluid(whole_params(half)), 0.1) < 1e-12
    assert np.abs(half_fluid.view()["points"] - start).max() > SPACING


def test_gauges_on_the_plane_read_what_they_do_in_the_whole() -> None:
    points, spots = ((0.0, 0.0, 0.05), (0.01, 0.0, 0.1)), ((0.0, 0.0), (0.01, 0.0), (0.09, 0.0))
    half = params(gauges__pressure_gauges=points, gauges__level_gauges=spots)
    half_fluid, whole_fluid = SphFluid(half), SphFluid(whole_params(half))
    side_by_side(half_fluid, whole_fluid, 0.02)
    half_outputs, whole_outputs = outputs_of(half_fluid), outputs_of(whole_fluid)
    for name, least in (("pressure_gauge.pressure", 100.0), ("level_gauge.height", 0.5 * DEPTH)):
        assert np.abs(whole_outputs[name]).min() > least
        np.testing.assert_allclose(half_outputs[name], whole_outputs[name], rtol=1e-9)


@pytest.mark.parametrize("dimensions", [2, 3])
def test_water_presses_on_half_a_box_as_on_the_whole(dimensions: int) -> None:
    box = ((0.0, 0.0, 0.0), (0.06, 0.1, 0.06))
    half = params(
        dimensions=dimensions,
        boundary__obstacles=(box,),
        fluid=(((0.0, 0.0, 0.06), (0.1, 0.1, 0.16)),),
        boundary__walls=((0.0, 0.0, 0.0), (0.2, 0.1, 0.3)),
        gauges__pressure_gauges=((0.0, 0.05, 0.06), (0.03, 0.05, 0.06), (0.06, 0.05, 0.03)),
    )
    half_fluid, whole_fluid = SphFluid(half), SphFluid(whole_params(half))
    half_values, whole_values = (
        fluid.state.position_density[fluid.state.fluid :, :3] for fluid in (half_fluid, whole_fluid)
    )
    whole_values = whole_values[whole_values[:, 0] > 0.0]
    half_order, whole_order = (
        np.lexsort(points.round(6).T) for points in (half_values, whole_values)
    )
    np.testing.assert_allclose(half_values[half_order], whole_values[whole_order], atol=1e-12)
    assert side_by_side(half_fluid, whole_fluid, 0.1) < 1e-11
    x, _, z = half_fluid.view()["points"].T
    assert ((x > 0.06) & (z < 0.05)).any()  # some water is beside the box
    half_values, whole_values = (
        outputs_of(fluid)["pressure_gauge.pressure"] for fluid in (half_fluid, whole_fluid)
    )
    assert whole_values.min() > 100.0
    np.testing.assert_allclose(half_values, whole_values, rtol=1e-9)


def test_a_quarter_falls_as_the_whole_does_in_three_dimensions() -> None:
    quarter = params(
        dimensions=3,
        boundary__symmetry=("y-", "x-"),
        fluid=(((0.0, 0.0, 0.0), (0.08, 0.08, 0.12)),),
        boundary__walls=((0.0, 0.0, 0.0), (0.16, 0.08, 0.2)),
    )
    # The wall at y = 0.08 m is a wall of both.
    assert side_by_side(SphFluid(quarter), SphFluid(whole_params(quarter)), 0.03) < 1e-12


def test_still_water_is_hydrostatic_beside_the_plane() -> None:
    sound = 20.0 * math.sqrt(9.81 * 2.0 * DEPTH)
    fluid = SphFluid(params(boundary__walls=FULL, fluid=(FULL,), sound_speed=sound))
    for _ in range(1500):
        fluid.step(fluid.stable_dt())
    rows = slice(fluid.state.fluid)
    place, motion = fluid.state.position_density[rows], fluid.state.velocity_pressure[rows]
    beside = place[:, 0] < 0.06
    pressure = motion[beside, 3] * place[beside, 3] ** 2
    error = pressure - 9810.0 * (2.0 * DEPTH - place[beside, 2])
    assert np.abs(error).max() < 0.02 * 9810.0 * 2.0 * DEPTH
    assert np.abs(motion[beside, :3]).max() < 0.005 * math.sqrt(9.81 * 2.0 * DEPTH)
    assert place[:, 0].min() > 0.25 * SPACING
    assert fluid.state.lost == 0


@pytest.mark.parametrize("symmetry", [("y-", "y+"), ()], ids=["planes", "walls"])
def test_a_flow_along_planes_stays_uniform(symmetry: tuple[str, ...]) -> None:
    box = ((0.0, 0.0, 0.0), (0.12, 0.12, 0.12))
    fluid = SphFluid(
        params(
            dimensions=3,
            boundary__symmetry=symmetry,
            boundary__open_faces=("x-", "x+", "z-", "z+"),
            fluid=(box,),
            boundary__walls=box,
            gravity=(0.0, 0.0, 0.0),
            viscosity__kinematic=1e-2,
        )
    )
    rows, stream = slice(fluid.state.fluid), np.array([0.5, 0.0, -0.3])
    fluid.state.velocity_pressure[rows, :3] = stream
    for _ in range(20):
        fluid.step(fluid.stable_dt())
    change = np.abs(fluid.state.velocity_pressure[rows, :3] - stream).max()
    assert change < 1e-12 if symmetry else change > 0.01


def test_fluid_that_passes_the_plane_changes_places_with_its_image() -> None:
    fluid = SphFluid(params(integration="symplectic"))
    fluid.step(1e-4)
    state, planes = fluid.state, fluid.symmetry
    position, velocity, acceleration = (
        state.position_density, state.velocity_pressure, state.acceleration,
    )  # fmt: skip
    row = int(np.argmin(position[: state.fluid, 0]))
    position[row, 0], velocity[row, 0], acceleration[row, 0] = -1e-3, -2.0, -3.0
    planes.write_images(state)
    before = sorted_rows(position, velocity)
    planes.reflect_crossed(state)
    assert (position[row, 0], velocity[row, 0], acceleration[row, 0]) == (1e-3, 2.0, 3.0)
    planes.write_images(state)
    np.testing.assert_array_equal(sorted_rows(position, velocity), before)


def sorted_rows(place: NDArray[Any], motion: NDArray[Any]) -> NDArray[Any]:
    rows = np.concatenate([place, motion], axis=1)
    return np.asarray(rows[np.lexsort(rows.T)])


def test_water_thrown_at_the_plane_stays_before_it() -> None:
    fluid = SphFluid(params(sound_speed=60.0, viscosity__artificial=0.01))
    fluid.state.velocity_pressure[: fluid.state.fluid, 0] = -5.0
    for _ in range(400):
        fluid.step(fluid.stable_dt())
        assert fluid.view()["points"][:, 0].min() >= 0.0
    assert fluid.totals().momentum[0] > 0.0


def water_over_plate(half: bool) -> SphFluid:
    """A cube of water, or the half of it with x > 0, over a moving plate."""
    edge, low = 6 * SPACING, 0.0 if half else -3 * SPACING
    fluid = SphFluid(
        params(
            dimensions=3,
            boundary__method="dbc",
            density_diffusion=0.0,
            gravity=(0.0,) * 3,
            boundary__symmetry=("x-",) if half else (),
            fluid=(((low, 0.0, 0.0), (3 * SPACING, edge, edge)),),
            boundary__open_faces=("x+", "y-", "y+", "z+"),
            boundary__walls=((0.0 if half else -0.2, 0.0, -0.2), (0.2, 0.2, 0.2)),
        )
    )
    line = SPACING * (np.arange(8) - 3.5)
    x, y = np.meshgrid(line[line > 0.0] if half else line, line + 3 * SPACING)
    points = np.stack([x.ravel(), y.ravel(), np.full(x.size, -0.5 * SPACING)], axis=1)
    # Samples are lighter than particles; their images have the same mass.
    volume = np.full(len(points), 0.8 * SPACING**3)
    normal = np.tile([0.0, 0.0, 1.0], (len(points), 1))
    fluid.bind(
        {"surface.normal": normal, "surface.volume": volume, "surface.body": 0.0 * volume}, JOINED
    )
    fluid.take(plate_fields(points))
    return fluid


def plate_fields(points: NDArray[Any]) -> Fields:
    return {
        "surface.position": points,
        "surface.velocity": np.tile([0.0, 0.0, 0.3], (len(points), 1)),
    }


def test_half_a_body_feels_what_that_half_of_the_whole_does() -> None:
    half_fluid, whole_fluid = water_over_plate(True), water_over_plate(False)
    for _ in range(10):
        half_fluid.step(2e-4)
        whole_fluid.step(2e-4)
    rows = whole_fluid.state.position_density[whole_fluid.samples.row, 0] > 0.0
    half_force, whole_force = (
        outputs_of(half_fluid)["surface_load.force"],
        outputs_of(whole_fluid)["surface_load.force"][rows],
    )
    assert np.abs(whole_force).max() > 0.01
    np.testing.assert_allclose(half_force, whole_force, atol=1e-10)


def test_samples_behind_the_plane_are_refused() -> None:
    fluid = water_over_plate(True)
    points = fluid.state.position_density[fluid.samples.row, :3] - np.array([0.012, 0.0, 0.0])
    sentence = r"before the plane of symmetry x-, x = 0 m; sample 0 is at x = -0.002 m. Move"
    with pytest.raises(StepError, match=sentence):
        fluid.take(plate_fields(points))


@pytest.mark.parametrize("changes", [EVERY, {"integration": "symplectic"}])
def test_saved_state_and_threads_change_no_bit(changes: dict[str, Any]) -> None:
    ends = []
    for threads in (1, 3):
        fluid = SphFluid(params(**changes))
        fluid.team = Team(threads, fewest=5)
        for _ in range(30):
            fluid.step(fluid.stable_dt())
        saved = fluid.save()
        if threads == 3:
            fluid = SphFluid(params(**changes))
            fluid.load(saved)
        for _ in range(30):
            fluid.step(fluid.stable_dt())
        ends.append(fluid.save())
    assert all(np.array_equal(ends[0][name], ends[1][name]) for name in ends[0])


def test_only_a_scene_that_asks_imports_them() -> None:
    program = (
        "import sys; from quintet.components.sph_fluid import SphFluidParams;"
        "from quintet.components.sph_fluid.component import SphFluid;"
        "from quintet.components.sph_fluid.setup.shapes import FluidRegion;"
        "f = SphFluid(SphFluidParams(spacing=0.1, sound_speed=30.0,"
        " fluid=(FluidRegion(lowest=(0.0, 0.0, 0.0), highest=(0.3, 0.3, 0.3)),))); f.step(1e-5);"
        "assert 'quintet.components.sph_fluid.boundary.symmetry' not in sys.modules;"
        "assert len(f.state.position_density) == f.items() == 27"
    )
    subprocess.run([sys.executable, "-c", program], check=True)


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"boundary.symmetry": ("z-",)}, "symmetry"),
        (
            {"boundary.open_faces": ("x-", "z+")},
            r"x- must be a face of the tank; found walls .* and open_faces .*x-",
        ),
        ({"boundary.walls": None}, r"x- must be a face of the tank; found walls None"),
        ({"boundary.symmetry": ("y+",)}, r"y\+ must be x- or x\+ in two dimensions"),
        ({"gravity": (0.5, 0.0, -9.8)}, r"x- must have gravity in its plane; found \(0.5, 0.0"),
        (
            {"boundary.wall_velocity": {"x-": (0.0, 1.0, 0.0)}},
            r"wall_velocity.x- must be of a closed face of the tank, ",
        ),
        (
            {"boundary.lubrication_films": True},
            r"films is not available with boundary.symmetry; found both, with symmetry \('x-',\)",
        ),
        (
            {"boundary.symmetry": ("x-", "x+"), "fluid": (THIN,), "boundary.walls": THIN},
            r"x- must be 0.09 m or more, 3 smoothing lengths, .* found 0.08 m. Widen",
        ),
        (
            {"boundary.obstacles": (((-0.1, 0.0, 0.3), (0.1, 0.1, 0.4)),)},
            r"x-, x from 0 to 0.6 m, must not cut boundary.obstacles\[0\]; found .* Cut",
        ),
    ],
)
def test_mistakes_are_told(changes: dict[str, Any], sentence: str) -> None:
    with pytest.raises(ValueError, match=sentence):
        params(**changes)
