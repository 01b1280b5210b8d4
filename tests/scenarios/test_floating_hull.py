"""A hull from an STL file floats: how deep it lies, and what its triangles displace."""

from collections.abc import Callable

import numpy as np
import pytest
import trimesh

from quintet.coupler.scene.read import load
from quintet.scenarios.floating_hull import hull

Run = Callable[..., dict]


@pytest.mark.slow
def test_hull_comes_to_rest_where_it_displaces_its_mass_of_water(run_scene: Run) -> None:
    swing = ("--set", "end=0.9", "--set", "expect.0.begin=0.25")  # s, one, not the second
    results = run_scene("floating_hull", "--preset", "quick", *swing)
    (link,) = results["ledger"]["links"]
    assert link["momentum_residual"] < 1e-12
    assert results["by_name"]["displaced"]["met"], results["by_name"]["displaced"]


def test_displaced_volume_of_triangles_is_exact() -> None:
    cube = np.asarray(trimesh.creation.box((2.0, 3.0, 4.0)).triangles)
    assert hull.displaced(cube, -0.5) == pytest.approx((9.0, 6.0), rel=1e-12)
    cone = trimesh.creation.cone(radius=1.0, height=2.0, sections=24)  # its tip above
    immersed, half = hull.displaced(np.asarray(cone.triangles), 2.0), cone.volume / 8.0
    assert immersed[0] == pytest.approx(cone.volume, rel=1e-12)
    below = hull.displaced(np.asarray(cone.triangles), 1.0)[0]
    assert cone.volume - below == pytest.approx(half, rel=1e-12)


def test_metacentric_height_of_a_box_is_that_of_hydrostatics() -> None:
    breadth, depth, draught = 3.0, 4.0, 1.5  # m
    box = np.asarray(trimesh.creation.box((2.0, breadth, depth)).triangles)
    height = hull.metacentric_height(box, draught - 0.5 * depth, 0.0)
    expected = 0.5 * (draught - depth) + breadth**2 / (12.0 * draught)  # BG, and I / V
    assert height == pytest.approx(expected, rel=1e-12)


def test_the_mass_at_a_draught_floats_at_that_draught() -> None:
    corners = hull.triangles()
    keel = float(corners[:, :, 2].min())
    volume = hull.displaced(corners, keel + 0.1)[0]
    density = volume * hull.WATER / hull.displaced(corners, 0.0)[0]
    assert hull.rest(corners, density)[0] == pytest.approx(0.1, abs=1e-12)


def test_the_file_and_the_expectation_are_what_the_script_writes() -> None:
    corners = np.asarray(trimesh.load_mesh(hull.FILE).triangles, np.float64)
    assert hull.displaced(corners, 0.0)[0] == pytest.approx(
        hull.displaced(hull.triangles(), 0.0)[0], rel=1e-6
    )
    (expected,) = load("floating_hull").expect
    _, volume, _ = hull.rest(corners, hull.DENSITY)
    assert expected.value == pytest.approx(volume, rel=1e-4)
    assert expected.within == pytest.approx(0.02 * volume, rel=0.01)
