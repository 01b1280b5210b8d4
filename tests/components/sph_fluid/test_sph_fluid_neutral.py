"""Fixed bodies deep in water at rest are pushed up by the weight of the displaced water."""

import math

import numpy as np
import pytest
from fluid_params import fluid_params
from sampled_bodies import BOX, SPHERE, fill, mirrors

from quintet.components.sph_fluid.component import SphFluid
from quintet.components.sph_fluid.kernels import write_pressure
from quintet.interfaces.component import outputs_of

JOINED = frozenset({"surface", "surface_load"})
SPACING, EDGE, SIDE = 0.03, 0.15, 0.27  # m: of particles, body, tank
LOW, HIGH = 0.5 * (SIDE - EDGE), 0.5 * (SIDE + EDGE)
WEIGHT = 9810.0  # N/m3
# Water below the body, beside it and above it.
AROUND = (
    ((0.0, 0.0, 0.0), (SIDE, SIDE, LOW)),
    ((0.0, 0.0, LOW), (LOW, SIDE, HIGH)),
    ((HIGH, 0.0, LOW), (SIDE, SIDE, HIGH)),
    ((LOW, 0.0, LOW), (HIGH, LOW, HIGH)),
    ((LOW, HIGH, LOW), (HIGH, SIDE, HIGH)),
    ((0.0, 0.0, HIGH), (SIDE, SIDE, SIDE)),
)


def sunken_body(shape: int, cells: int = 5, **changes: object) -> SphFluid:
    """Water around a body in the middle of the tank, with so many samples along a box's edge."""
    settings = {
        "spacing": SPACING,
        "sound_speed": 16.4,
        "fluid": AROUND,
        "boundary.walls": ((0.0, 0.0, 0.0), (SIDE, SIDE, SIDE + 0.09)),
        "boundary.method": "mdbc",
        "density_diffusion": 0.1,
        "negative_pressure": True,
    }
    fluid = SphFluid(fluid_params(**(settings | changes)))
    description, size = fluid.describe(), np.full(3, EDGE)
    depth = float(description["surface.depth"][0])
    arm, normal, volume = fill(shape, size, EDGE / cells, depth)
    body = np.zeros(len(arm))
    fluid.bind({"surface.normal": normal, "surface.volume": volume, "surface.body": body}, JOINED)
    arms = {"position": arm, "mirror": mirrors(shape, size, arm, normal)}
    fields = {f"surface.{key}": points + 0.5 * SIDE for key, points in arms.items()}
    fluid.take(fields | {"surface.velocity": np.zeros_like(arm)})
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


@pytest.mark.parametrize("cells", [4, 5, 6])
def test_a_box_is_pushed_up_by_the_weight_of_its_water(cells: int) -> None:
    # As many samples as particles along an edge, or a fourth fewer or a fifth more.
    force = push(sunken_body(BOX, cells), 0.5, 0.8) / (WEIGHT * EDGE**3)
    assert force[2] == pytest.approx(1.0, abs=0.01)
    assert np.abs(force[:2]).max() < 1e-3


def around(edge: int, side: int, below: int, above: int, spacing: float) -> tuple:
    """Boxes of water below, beside and above a cube, all in whole spacings; its middle [m]."""
    low, high, top = 0.5 * (side - edge), 0.5 * (side + edge), below + edge + above
    boxes = (
        ((0, 0, 0), (side, side, below)),
        ((0, 0, below), (low, side, below + edge)),
        ((high, 0, below), (side, side, below + edge)),
        ((low, 0, below), (high, low, below + edge)),
        ((low, high, below), (high, side, below + edge)),
        ((0, 0, below + edge), (side, side, top)),
    )
    return tuple(tuple(tuple(spacing * x for x in corner) for corner in box) for box in boxes)


@pytest.mark.parametrize(
    ("edge", "spacing", "below", "above"), [(4, 0.03, 4, 3), (4, 0.03, 2, 7), (5, 0.02, 4, 4)]
)
def test_the_potential_pushes_a_box_up_by_the_weight_of_its_water(
    edge: int, spacing: float, below: int, above: int
) -> None:
    side, top = edge + 6, below + edge + above
    tank = ((0.0, 0.0, 0.0), (side * spacing, side * spacing, (top + 3) * spacing))
    settings = {
        "fluid": around(edge, side, below, above, spacing),
        "boundary.walls": tank,
        "boundary.wall_viscosity_factor": 0.0,
    }
    sound = 10.2 * math.sqrt(9.81 * top * spacing)
    terms = {
        "kernel": "wendland",
        "integration": "symplectic",
        "courant": 1.0,
        "viscosity.artificial": 0.3,
    }
    fluid = SphFluid(
        fluid_params(
            spacing=spacing,
            sound_speed=sound,
            boundary__method="potential",
            density_diffusion=0.1,
            negative_pressure=True,
            **settings,
            **terms,
        )
    )
    size = np.full(3, edge * spacing)
    arm, normal, volume = fill(BOX, size, spacing, 2.0 * fluid.params.smoothing_length)
    body = np.zeros(len(arm))
    fluid.bind({"surface.normal": normal, "surface.volume": volume, "surface.body": body}, JOINED)
    middle = spacing * np.array([0.5 * side, 0.5 * side, below + 0.5 * edge])
    # The body is placed twice; values of its first place are not kept.
    for place in (middle + 2.0 * spacing, middle):
        fluid.take({"surface.position": arm + place, "surface.velocity": np.zeros_like(arm)})
    force = push(fluid, 0.2, 0.5) / (WEIGHT * size[0] ** 3)
    assert force[2] == pytest.approx(1.0, abs=0.005)
    assert np.abs(force[:2]).max() < 1e-3
    # Nothing has moved, and the pressure at the floor is that of the water above it.
    assert np.linalg.norm(fluid.view()["velocity"], axis=1).max() < 0.01
    points, pressure = fluid.view()["points"], fluid.view()["pressure"]
    deep = points[:, 2] < 2.0 * spacing
    expected = WEIGHT * (top * spacing - points[deep, 2])
    assert pressure[deep] == pytest.approx(expected, rel=0.03)


@pytest.mark.slow
def test_a_sphere_is_pushed_up_by_the_weight_of_its_water() -> None:
    fluid = sunken_body(SPHERE, fluid=(*AROUND, *corners()))
    # Water below an overhang starts without the pressure of the water beside and above it.
    state, rows = fluid.state, slice(fluid.state.fluid)
    depth = SIDE - state.position_density[rows, 2]
    state.position_density[rows, 3] = 1000.0 + WEIGHT * depth / fluid.params.sound_speed**2
    write_pressure(fluid.constants, state.position_density, state.velocity_pressure)
    # Water in the corners of the sphere's box has to settle first.
    force = push(fluid, 1.6, 2.0) / (WEIGHT * math.pi / 6.0 * EDGE**3)
    assert force[2] == pytest.approx(1.0, abs=0.01)
    assert np.abs(force[:2]).max() < 0.01


def corners() -> list:
    """Cells of the box around the sphere whose middles are well outside it."""
    cells = round(EDGE / SPACING)
    spots = np.stack(np.meshgrid(*[np.arange(cells)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    middle = SPACING * (spots + 0.5 - 0.5 * cells)
    outside = spots[np.linalg.norm(middle, axis=1) > 0.5 * EDGE + 0.3 * SPACING]
    low = LOW + SPACING * outside
    return [(tuple(a), tuple(a + SPACING)) for a in low]
