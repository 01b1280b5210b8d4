"""Fixed boxes in the water: where their particles are, and that water stays out of them."""

import numpy as np
import pytest
from fluid_params import fluid_params, nested

from quintet.components.shared.smoothing.cubic_spline import SUPPORT
from quintet.components.sph_fluid import MANIFEST, SphFluidParams
from quintet.components.sph_fluid.boundary.obstacles import FELT, obstacle_points
from quintet.components.sph_fluid.build import state
from quintet.components.sph_fluid.component import SphFluid
from quintet.interfaces.params import read

SPACING = 0.05
TANK = ((0.0, 0.0, 0.0), (1.5, 0.4, 0.8))
WATER = ((0.0, 0.0, 0.0), (0.5, 0.4, 0.4))
BOX = ((0.9, 0.1, 0.0), (1.2, 0.3, 0.4))  # stands on the floor


def params(**changes):
    settings = {"spacing": SPACING, "sound_speed": 40.0, "fluid": (WATER,), "boundary.walls": TANK}
    return fluid_params(**(settings | {"boundary.obstacles": (BOX,)} | changes))


@pytest.mark.parametrize("wall_offset", [0.5, 1.0, 1.5])
def test_outermost_particles_lie_the_wall_offset_inside_wet_faces(wall_offset):
    points = obstacle_points(params(boundary__wall_offset=wall_offset))
    inside = wall_offset * SPACING
    assert points.min(axis=0) == pytest.approx([0.9 + inside, 0.1 + inside, 0.5 * SPACING])
    assert points.max(axis=0) == pytest.approx([1.2 - inside, 0.3 - inside, 0.4 - inside])
    nearest = np.linalg.norm(points[:, None] - points[None], axis=2) + np.eye(len(points))
    assert 0.8 * SPACING < nearest.min(axis=1).min() <= nearest.min(axis=1).max() < 1.3 * SPACING


def test_a_box_against_a_wall_is_dry_there_unless_the_face_is_open():
    corner = ((1.2, 0.0, 0.0), (1.5, 0.4, 0.3))
    closed_points = obstacle_points(params(boundary__obstacles=(corner,)))
    assert closed_points.max(axis=0)[0] == pytest.approx(1.5 - 0.5 * SPACING)
    assert closed_points.min(axis=0)[1] == pytest.approx(0.5 * SPACING)
    outlet_points = obstacle_points(
        params(
            boundary__obstacles=(corner,),
            boundary__open_faces=("z+", "x+"),
            boundary__wall_offset=1.0,
        )
    )
    assert outlet_points.max(axis=0)[0] == pytest.approx(1.5 - SPACING)


def test_closed_faces_of_the_tank_and_all_of_a_box_are_shown_as_walls():
    walls = SphFluid(params(boundary__open_faces=("z+", "x+"))).walls()
    assert walls["cells"].shape == (4 + 6, 4)
    tank, box = walls["points"][:16], walls["points"][16:]
    assert (tank.min(axis=0), tank.max(axis=0)) == (pytest.approx(TANK[0]), pytest.approx(TANK[1]))
    assert not (tank.reshape(4, 4, 3)[:, :, 0] == 1.5).all(axis=1).any()
    assert (box.min(axis=0), box.max(axis=0)) == (pytest.approx(BOX[0]), pytest.approx(BOX[1]))


def test_in_two_dimensions_they_have_one_row_along_y():
    tank, water = ((0.0, 0.0, 0.0), (1.5, 1.0, 0.8)), ((0.0, 0.0, 0.0), (0.5, 1.0, 0.4))
    slab = {"dimensions": 2, "boundary.walls": tank, "fluid": (water,)}
    thin = params(**slab, boundary__obstacles=(((0.9, 0.0, 0.0), (1.0, 1.0, 0.4)),))
    points = obstacle_points(thin)
    assert len(points) == 2 * 8
    assert (points[:, 1] == 0.5).all()
    assert MANIFEST.plan is not None
    assert MANIFEST.plan(thin).items == len(state(thin).position_density)
    with pytest.raises(ValueError, match="must reach over the same y"):
        params(**slab)


def test_what_water_cannot_feel_is_left_out():
    block = ((0.7, 0.1, 0.2), (1.4, 0.9, 0.9))
    points = obstacle_points(params(boundary__walls=None, boundary__obstacles=(block,)))
    middle = np.array([1.05, 0.5, 0.55])
    assert np.abs(points - middle).max(axis=1).min() > 0.1
    assert len(points) < 14 * 16 * 14
    assert FELT == SUPPORT


def test_plan_counts_the_particles_of_obstacles():
    parameters = params()
    assert MANIFEST.plan is not None
    assert MANIFEST.plan(parameters).items == len(state(parameters).position_density)
    assert len(state(parameters).position_density) == len(
        state(params(boundary__obstacles=())).position_density
    ) + len(obstacle_points(parameters))


def test_water_does_not_enter_an_obstacle():
    dam = ((0.7, 0.0, 0.0), (0.9, 0.4, 0.6))  # a dam across the whole tank
    changes = {
        "boundary.obstacles": (dam,),
        "boundary.wall_viscosity_factor": 0.0,
        "boundary.wall_offset": 1.0,
        "viscosity.artificial": 0.1,
    }
    fluid = SphFluid(params(**changes))
    time = 0.0
    while time < 0.5:
        dt = fluid.stable_dt()
        fluid.step(dt)
        time += dt
    x = fluid.view()["points"][:, 0]
    assert 0.7 - SPACING < x.max() < 0.7 + SPACING
    assert fluid.totals().mass == pytest.approx(80.0)


@pytest.mark.parametrize(
    ("box", "sentence"),
    [
        ([[0.9, 0.1, 0.0], [0.8, 0.3, 0.4]], "obstacles[0] must go from its lowest"),
        ([[0.9, 0.1, 0.0], [0.93, 0.3, 0.4]], "obstacles[0] must be at least 0.05 m across"),
        ([[0.4, 0.1, 0.0], [0.8, 0.3, 0.4]], "obstacles[0] must not overlap fluid[0]"),
    ],
)
def test_a_wrong_obstacle_is_refused_with_a_sentence(box, sentence):
    base = {"spacing": SPACING, "sound_speed": 40.0, "fluid": [WATER]}
    parameters, mistakes = read(
        SphFluidParams, nested(base | {"boundary.obstacles": [box]}), "water"
    )
    assert parameters is None and sentence in "\n".join(mistakes), mistakes
