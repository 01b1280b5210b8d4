"""A fluid of two dimensions and the bodies in it, 1 m deep: buoyancy, momentum, and its plane."""

import math
from functools import partial

import numpy as np
import pytest
from fluid_params import fluid_params

from quintet.components.shared.geometry.surface_samples import Sampling, disc, polygon
from quintet.components.sph_fluid.component import SphFluid
from quintet.interfaces.component import outputs_of
from quintet.interfaces.errors import SceneError
from quintet.interfaces.ports import DIMENSIONS

JOINED = frozenset({"surface", "surface_load"})
ACROSS, CELLS = 8, 14  # cells in the body's width and in the tank's
SPACING = 0.15 / ACROSS  # m
WEIGHT = 9810.0  # N/m3
SQUARE = 0.075 * np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
HOOK = [(-4, -4), (4, -4), (4, 0), (0, 0), (0, 4), (-4, 4)]  # cells, an L
CUP = [(-4, -4), (4, -4), (4, 4), (2, 4), (2, -1), (-2, -1), (-2, 4), (-4, 4)]  # a U, open above
SHAPES = {
    "square": (partial(polygon, SQUARE), 0.0225),
    "disc": (partial(disc, 0.15), math.pi / 4.0 * 0.0225),
    "L": (partial(polygon, SPACING * np.array(HOOK)), 48 * SPACING**2),
    "U": (partial(polygon, SPACING * np.array(CUP)), 44 * SPACING**2),
}
CALM = {"kernel": "wendland", "courant": 0.3, "density_diffusion": 0.1, "negative_pressure": True}
POTENTIAL = {"boundary.method": "potential", "integration": "symplectic", "courant": 1.0}
DROP = {
    "spacing": 0.02,
    "dimensions": 2,
    "sound_speed": 20.0,
    "gravity": (0.0, 0.0, 0.0),
    "fluid": (((0.0, 0.0, 0.0), (0.12, 1.0, 0.12)),),
}


def outside(name: str, x: float, z: float) -> bool:
    """Whether a place, in cells from the middle of the body, is outside of it."""
    if name == "disc":
        return math.hypot(x, z) - 0.3 > 0.5 * ACROSS
    notch = {"L": x > 0.0 and z > 0.0, "U": abs(x) < 2.0 and z > -1.0}
    return max(abs(x), abs(z)) > 0.5 * ACROSS or notch.get(name, False)


def wet_cells(name: str) -> tuple:
    """Cells of water around the body in the middle of the tank, all in one slab of 1 m."""
    cells = []
    for i in range(CELLS):
        for k in range(CELLS):
            if outside(name, *(cell + 0.5 - 0.5 * CELLS for cell in (i, k))):
                low, high = ((i, 0.0, k), (i + 1, 1.0 / SPACING, k + 1))
                cells.append(tuple(tuple(SPACING * x for x in corner) for corner in (low, high)))
    return tuple(cells)


def sunken_body(name: str, **changes: object) -> SphFluid:
    """Water at rest around a body that is fixed in the middle of a tank."""
    body, _ = SHAPES[name]
    side = CELLS * SPACING
    settings = {
        "spacing": SPACING,
        "dimensions": 2,
        "sound_speed": 10.1 * math.sqrt(9.81 * side),
        "fluid": wet_cells(name),
        "boundary.walls": ((0.0, 0.0, 0.0), (side, 1.0, side + 0.09)),
        "boundary.method": "mdbc",
    }
    fluid = SphFluid(fluid_params(**(settings | CALM | changes)))
    # Water below an overhang starts without the pressure of the water beside and above it.
    state, rows = fluid.state, slice(fluid.state.fluid)
    depth = side - state.position_density[rows, 2]
    state.position_density[rows, 3] = 1000.0 + WEIGHT * depth / fluid.params.sound_speed**2
    sample_depth = float(fluid.describe()["surface.depth"][0])
    samples = body(Sampling(SPACING, sample_depth, 0.5 * SPACING, planar=True))
    arm, static = samples.arm, {"surface.normal": samples.normal, "surface.volume": samples.volume}
    fluid.bind(static | {"surface.body": np.zeros(len(arm))}, JOINED)
    middle = np.array([0.5 * side, 0.5, 0.5 * side])
    fields = {"surface.position": arm + middle, "surface.velocity": np.zeros_like(arm)}
    if fluid.params.mirrored:
        fields["surface.mirror"] = samples.image + middle
    fluid.take(fields)
    return fluid


def push(fluid: SphFluid, begin: float, end: float) -> np.ndarray:
    """Mean force on the body between two times [s]; (3,) N."""
    time, duration, impulse = 0.0, 0.0, np.zeros(3)
    while time < end:
        dt = fluid.stable_dt()
        fluid.step(dt)
        time += dt
        if time > begin:
            duration += dt
            impulse += dt * outputs_of(fluid)["surface_load.force"].sum(axis=0)
    return impulse / duration


@pytest.mark.parametrize(
    ("name", "changes", "end", "tolerance"),
    [
        ("square", {}, 0.5, 0.005),
        ("L", {}, 0.5, 0.02),
        pytest.param("U", {}, 0.5, 0.02, marks=pytest.mark.full),
        pytest.param("disc", {}, 1.0, 0.01, marks=pytest.mark.full),
        pytest.param(
            "square",
            POTENTIAL | {"boundary.wall_viscosity_factor": 0.0},
            0.5,
            0.005,
            marks=pytest.mark.full,
        ),
    ],
    ids=["square", "L", "U", "disc", "square held by the potential"],
)
def test_a_body_under_water_is_pushed_up_by_the_weight_of_its_area(name, changes, end, tolerance):
    force = push(sunken_body(name, **changes), 0.25, end) / (WEIGHT * SHAPES[name][1])
    assert force[2] == pytest.approx(1.0, abs=tolerance)
    assert abs(force[0]) < 1e-3 and force[1] == 0.0


def plate(fluid: SphFluid, y: float = 0.5, share: float = 0.7) -> dict:
    """Join a row of samples below the drop; return where they are, moving upwards."""
    x = 0.02 * np.arange(7)
    position = np.stack([x, np.full(7, y), np.full(7, -0.01)], axis=1)
    velocity = np.tile([0.1, 0.0, 0.3], (7, 1))
    normal, volume = np.tile([0.0, 0.0, 1.0], (7, 1)), np.full(7, share * 0.02**2)
    static = {"surface.normal": normal, "surface.volume": volume, "surface.body": np.zeros(7)}
    fluid.bind(static, JOINED)
    return {
        "surface.position": position,
        "surface.velocity": velocity,
        "surface.mirror": position + np.array([0.0, 0.0, 0.02]),
    }


@pytest.mark.parametrize(
    ("form", "method", "share"),
    [  # each form once; the others are compiled for themselves
        ("laplacian", "dbc", 1.0),
        ("stress", "mdbc", 0.7),
        pytest.param("laplacian", "dbc", 0.7, marks=pytest.mark.full),
        pytest.param("laplacian", "potential", 0.7, marks=pytest.mark.full),
        pytest.param("stress", "dbc", 0.7, marks=pytest.mark.full),
        pytest.param("laplacian", "mdbc", 0.7, marks=pytest.mark.full),
        pytest.param("stress", "potential", 0.7, marks=pytest.mark.full),
    ],
)
def test_samples_take_what_the_fluid_loses(form, method, share):
    viscous = {"viscosity.kinematic": 1e-3, "viscosity.form": form}
    fluid = SphFluid(fluid_params(**DROP, **viscous, **{"boundary.method": method}))
    fluid.take(plate(fluid, share=share))
    fluid.step(1e-4)
    before = fluid.totals()
    fluid.step(0.7e-4)
    impulse = 0.7e-4 * outputs_of(fluid)["surface_load.force"]
    gained = fluid.totals().momentum - before.momentum
    assert before.mass == pytest.approx(14.4)  # of 1 m
    assert np.abs(impulse).max() > 0.0
    assert impulse.sum(axis=0) == pytest.approx(-gained, abs=1e-12 * np.abs(impulse).sum())


def test_samples_are_in_the_plane_of_the_fluid_wherever_theirs_is():
    ends = []
    for y in (0.5, -3.0):
        fluid = SphFluid(fluid_params(**DROP))
        fluid.take(plate(fluid, y))
        for _ in range(20):
            fluid.step(1e-4)
        ends.append(fluid.save())
    assert all(np.array_equal(array, ends[1][name]) for name, array in ends[0].items())


def test_a_fluid_says_that_it_has_two_dimensions():
    flat = SphFluid(fluid_params(**DROP))
    assert DIMENSIONS in flat.takes[0].requests
    assert flat.describe()["surface.dimensions"].tolist() == [2.0]
    deep = SphFluid(fluid_params(**(DROP | {"dimensions": 3})))
    assert DIMENSIONS not in deep.takes[0].requests
    assert "surface.dimensions" not in deep.describe()


def test_samples_need_a_slab_of_one_metre():
    thin = SphFluid(fluid_params(**(DROP | {"fluid": (((0.0, 0.0, 0.0), (0.12, 0.1, 0.12)),)})))
    with pytest.raises(SceneError, match=r"its boxes reach over 0.1 m. Let them, and the walls"):
        plate(thin)


def test_films_need_three_dimensions():
    films = {"boundary.method": "mdbc", "boundary.lubrication_films": True}
    with pytest.raises(ValueError, match="lubrication_films needs three dimensions"):
        fluid_params(**DROP, **films)
