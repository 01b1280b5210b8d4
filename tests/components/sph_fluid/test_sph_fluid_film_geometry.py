"""Faces near each other: their films, and the share of the pressure left to a film."""

import numpy as np
import pytest
from fluid_params import fluid_params
from sampled_bodies import BOX, fill, mirrors

from quintet.components.sph_fluid.boundary.film_geometry import find_faces
from quintet.components.sph_fluid.boundary.film_search import near
from quintet.components.sph_fluid.boundary.kernels.films import face_normals, write_fluid_share
from quintet.components.sph_fluid.component import SphFluid

JOINED = frozenset({"surface", "surface_load"})
SPACING = 0.01  # m
SIZE = np.array([0.03, 0.06, 0.06])  # m, of each of two blocks side by side
LONG, WIDE, HIGH = 0.14, 0.1, 0.11  # m, of the water


def boxes(width: float) -> tuple:
    """Water all around both blocks, and none between them; m."""
    last = 0.09 + width  # where the right block ends
    return (
        ((0.0, 0.0, 0.0), (LONG, WIDE, 0.02)),
        ((0.0, 0.0, 0.08), (LONG, WIDE, HIGH)),
        ((0.0, 0.0, 0.02), (LONG, 0.02, 0.08)),
        ((0.0, 0.08, 0.02), (LONG, WIDE, 0.08)),
        ((0.0, 0.02, 0.02), (0.03, 0.08, 0.08)),
        ((last, 0.02, 0.02), (LONG, 0.08, 0.08)),
    )


def pair(width: float, **changes: object) -> SphFluid:
    """Two fixed blocks under water, a gap of `width` [m] apart."""
    settings = {
        "spacing": SPACING,
        "sound_speed": 11.0,
        "fluid": boxes(width),
        "boundary.walls": ((0.0, 0.0, 0.0), (LONG, WIDE, 0.15)),
        "boundary.method": "mdbc",
        "density_diffusion": 0.1,
        "negative_pressure": True,
        "courant": 0.3,
        "boundary.lubrication_films": True,
    }
    fluid = SphFluid(fluid_params(**(settings | changes)))
    arm, normal, volume = fill(BOX, SIZE, SPACING, 3.0 * SPACING)
    image, count = mirrors(BOX, SIZE, arm, normal), len(arm)
    static = {"normal": np.tile(normal, (2, 1)), "volume": np.tile(volume, 2)}
    static["body"] = np.repeat([0.0, 1.0], count)
    fluid.bind({f"surface.{key}": value for key, value in static.items()}, JOINED)
    centres = np.array([[0.045, 0.05, 0.05], [0.075 + width, 0.05, 0.05]])
    place, mirror = (np.concatenate(centres[:, None] + points) for points in (arm, image))
    moves = {"position": place, "velocity": np.zeros_like(place), "mirror": mirror}
    fluid.take({f"surface.{key}": value for key, value in moves.items()})
    return fluid


def test_normals_are_those_of_the_faces_not_of_edges() -> None:
    face, edge, corner = [0.0, 0.0, 1.0], [0.0, 1.0, 1.0], [1.0, 1.0, 1.0]
    down, below, under = [0.0, 0.0, -1.0], [0.0, 1.0, -1.0], [1.0, 1.0, -1.0]
    off = np.array([down, below, down, below, under, under, face, edge])
    back = np.array([face, face, edge, edge, corner, face, face, edge])
    expected = np.array([face] * 6 + [[0.0] * 3] * 2)  # the last two look the same way
    np.testing.assert_allclose(face_normals(off, back), expected, atol=1e-15)


def test_a_film_covers_a_face_with_its_edges_and_corners() -> None:
    narrow, wide = pair(0.002), pair(1.25 * SPACING)
    narrow.step(1e-5)
    wide.step(1e-5)
    assert len(narrow.films.films.sample) == 36
    assert narrow.films.films.rim.sum() == 20
    assert len(wide.films.films.sample) == 0


def test_body_water_and_what_lies_across_press_the_whole_face() -> None:
    # One lattice goes on through both blocks and a gap of one spacing that is full of water.
    gap = ((0.06, 0.02, 0.02), (0.07, 0.08, 0.08))
    fluid = pair(SPACING, fluid=(*boxes(SPACING), gap))
    fluid.step(1e-9)
    film, state = fluid.films.films, fluid.state
    water_share = np.empty(len(film.row))
    place = state.position_density[state.fluid :]
    row = find_faces(state, fluid.all_ranks, SPACING).row[film.row]
    foot = place[row, :3] - [0.5 * SPACING, 0.0, 0.0]  # on the right block's left face
    lists, numbers = fluid.lists.arrays, fluid.constants
    write_fluid_share(row, foot, state.fluid, state.position_density, lists, numbers, water_share)
    rows = np.flatnonzero(state.sample >= 0)
    left_rows = rows[place[rows, 0] < 0.06]
    distance = (
        np.linalg.norm(foot[:, None] - place[left_rows, :3], axis=2)
        / fluid.constants.smoothing.length
    )
    shape = np.maximum(2.0 - distance, 0.0) ** 3 - 4.0 * np.maximum(1.0 - distance, 0.0) ** 3
    across_share = fluid.constants.smoothing.height * shape.sum(axis=1) * SPACING**3
    np.testing.assert_allclose(film.own_share + water_share + across_share, 1.0, atol=0.01)


@pytest.mark.parametrize("width", [0.1, 0.5, 1.0, 1.25])
def test_the_pressure_in_a_narrow_gap_is_that_outside(width: float) -> None:
    fluid, time, forces = pair(width * SPACING), 0.0, []
    while time < 0.2:
        dt = fluid.stable_dt()
        fluid.step(dt)
        time += dt
        if time > 0.1:
            forces.append(fluid.state.force.reshape(2, -1, 3).sum(axis=1)[:, 0])
    volume = fluid.state.fluid * SPACING**3 + 2.0 * SIZE.prod()
    outside = 9810.0 * (volume / (LONG * WIDE) - 0.05) * SIZE[1] * SIZE[2]
    left, right = np.array(forces).T
    inside = 1.0 - 0.5 * (left - right) / outside
    assert inside.mean() == pytest.approx(1.0, abs=0.2)
    assert inside.std() < 0.2


@pytest.mark.parametrize("points", [0, 300])
def test_lists_of_near_points_are_those_of_a_loop_over_all(points):
    random = np.random.default_rng(7)
    places, other_places = random.uniform(0.0, 0.3, (80, 3)), random.uniform(0.0, 0.2, (points, 3))
    lists = near(places, other_places, 0.1)
    for place, first, last in zip(places, lists.begin, lists.begin[1:], strict=False):
        listed = lists.point[first:last].tolist()
        assert listed == np.flatnonzero(((other_places - place) ** 2).sum(axis=1) < 0.01).tolist()
