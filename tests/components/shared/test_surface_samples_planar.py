"""Bodies of two dimensions filled with samples: area, spacing, skin."""

import math
from itertools import pairwise

import numpy as np
import pytest

from quintet.components.shared.geometry.polygons import polygon_depths
from quintet.components.shared.geometry.surface_samples import Sampling, polygon
from quintet.components.shared.geometry.surface_samples_planar import (
    fill_disc,
    fill_polygon,
    inradius,
    offset_inward,
    polygon_images,
)
from quintet.components.shared.geometry.surface_samples_solid import sphere_images

DEEP = 1e9


def ring(count, radius=0.5, turn=0.0):
    """Corners (n, 3) m of a regular polygon."""
    angle = 2.0 * math.pi * np.arange(count) / count + turn
    return radius * np.stack([np.cos(angle), np.zeros(count), np.sin(angle)], axis=1)


def rotate(corner, angle):
    c, s = math.cos(angle), math.sin(angle)
    return corner @ np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


SQUARE = np.array([[-0.2, 0.0, -0.2], [0.2, 0.0, -0.2], [0.2, 0.0, 0.2], [-0.2, 0.0, 0.2]])
OBLONG = SQUARE * [1.0, 1.0, 0.75]
WEDGE = np.array([[-0.3, 0.0, -0.2], [0.5, 0.0, -0.2], [-0.2, 0.0, 0.4]])
PLATE = np.array([[-0.5, 0.0, -0.03], [0.5, 0.0, -0.03], [0.52, 0.0, 0.03], [-0.48, 0.0, 0.03]])
SHAPES = {
    "square": (SQUARE, 0.16),
    "turned oblong": (rotate(OBLONG, 0.4) + np.array([0.1, 0.0, 0.2]), 0.12),
    "triangle": (WEDGE, 0.24),
    "hexagon": (ring(6), 1.5 * math.sqrt(3.0) * 0.25),
    "thin plate": (PLATE, 0.06),
}


# An L and a U.
BENT = {
    "L": (0.1 * np.array([[0, 0], [4, 0], [4, 2], [2, 2], [2, 4], [0, 4]]), 0.12),
    "U": (0.1 * np.array([[0, 0], [6, 0], [6, 4], [4, 4], [4, 2], [2, 2], [2, 4], [0, 4]]), 0.2),
}


@pytest.mark.parametrize("name", BENT)
@pytest.mark.parametrize("spacing", [0.05, 0.043, 0.02])
def test_a_polygon_that_is_not_convex_is_filled_and_mirrored_to_the_outside(name, spacing):
    corner, area = BENT[name]
    samples = polygon(corner, Sampling(spacing, DEEP, 0.5 * spacing, planar=True))
    assert samples.volume.sum() == pytest.approx(area, rel=1e-12)
    depth, _ = polygon_depths(corner, samples.arm[:, [0, 2]])
    assert depth.min() > 0.0
    assert (polygon_depths(corner, samples.image[:, [0, 2]])[0] < 1e-9)[depth < spacing].all()
    assert (samples.arm[:, 1] == 0.0).all() and len(samples.arm) == round(area / spacing**2)


@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize("spacing", [0.05, 0.043, 0.02])
def test_volumes_of_a_polygon_add_up_to_its_area_on_one_metre(name, spacing):
    corner, area = SHAPES[name]
    arm, normal, volume = fill_polygon(corner[:, [0, 2]], spacing, DEEP)
    assert volume.sum() == pytest.approx(area, rel=1e-9)
    # Each sample has about the area of a square of the spacing.
    assert volume.min() > 0.3 * spacing**2 and volume.max() < 1.9 * spacing**2
    assert not arm[:, 1].any() and not normal[:, 1].any()
    np.testing.assert_allclose(np.linalg.norm(normal, axis=1), 1.0, rtol=1e-14)


@pytest.mark.parametrize("spacing", [0.05, 0.043, 0.02])
def test_volumes_of_a_disc_add_up_to_its_area_on_one_metre(spacing):
    arm, normal, volume = fill_disc(0.6, spacing, DEEP)
    assert volume.sum() == pytest.approx(math.pi * 0.09, rel=1e-13)
    outermost = np.linalg.norm(arm, axis=1).max()
    assert outermost == pytest.approx(0.3 - 0.5 * spacing, rel=1e-12)
    np.testing.assert_allclose(np.linalg.norm(normal, axis=1), 1.0, rtol=1e-14)
    distance = np.linalg.norm(arm[:, None] - arm[None], axis=2) + 9.0 * np.eye(len(arm))
    assert distance.min() > 0.6 * spacing
    assert np.abs(volume[: len(volume) // 2] / spacing**2 - 1.0).max() < 0.05


@pytest.mark.parametrize("angle", [0.0, 0.3, 2.0])
def test_a_rectangle_keeps_the_lattice_of_the_fluid(angle):
    arm, _, volume = fill_polygon(rotate(OBLONG, angle)[:, [0, 2]], 0.1, DEEP)
    np.testing.assert_allclose(volume, 0.01, rtol=1e-9)
    x, z = np.meshgrid([-0.15, -0.05, 0.05, 0.15], [-0.1, 0.0, 0.1])
    lattice = rotate(np.stack([x.ravel(), 0.0 * x.ravel(), z.ravel()], axis=1), angle)
    distance = np.linalg.norm(arm[:, None] - lattice[None], axis=2)
    assert (
        len(arm) == 12 and distance.min(axis=1).max() < 1e-12 and distance.min(axis=0).max() < 1e-12
    )


@pytest.mark.parametrize("name", ["triangle", "hexagon"])
def test_the_outermost_layer_lies_half_a_spacing_deep(name):
    corner, _ = SHAPES[name]
    spacing = inradius(corner[:, [0, 2]]) / 5.0
    arm, normal, _ = fill_polygon(corner[:, [0, 2]], spacing, DEEP)
    depth = 0.5 * np.linalg.norm(polygon_images(corner[:, [0, 2]], arm, normal) - arm, axis=1)
    assert depth.min() == pytest.approx(0.5 * spacing, rel=1e-9)


@pytest.mark.parametrize("fill", [fill_disc, fill_polygon])
def test_only_a_skin_of_the_depth_is_filled(fill):
    body = ring(6)[:, [0, 2]] if fill == fill_polygon else 0.6
    arm, _, volume = fill(body, 0.02, 0.06)
    all_arms, _, all_volumes = fill(body, 0.02, DEEP)
    assert 0 < len(arm) < len(all_arms)
    np.testing.assert_array_equal(arm, all_arms[: len(arm)])
    np.testing.assert_array_equal(volume, all_volumes[: len(arm)])


@pytest.mark.parametrize(("inset", "outermost"), [(0.0, 0.3), (0.03, 0.27)])
def test_the_outermost_samples_lie_where_the_fluid_wants_them(inset, outermost):
    arm, *_ = fill_disc(0.6, 0.02, DEEP, inset)
    assert np.linalg.norm(arm, axis=1).max() == pytest.approx(outermost, rel=1e-12)
    arm, *_ = fill_polygon(1.5 * SQUARE[:, [0, 2]], 0.02, DEEP, inset)
    assert np.abs(arm).max() == pytest.approx(outermost, rel=1e-12)


@pytest.mark.parametrize("name", SHAPES)
def test_mirror_points_lie_as_far_outside_a_polygon(name):
    corner, _ = SHAPES[name]
    arm, normal, _ = fill_polygon(corner[:, [0, 2]], 0.05, 0.08)
    image = polygon_images(corner[:, [0, 2]], arm, normal)
    midpoints, closed = 0.5 * (arm + image), np.vstack([corner, corner[:1]])
    for point in midpoints:  # it lies on an edge, with which it spans no area
        areas = [np.cross(a - point, b - point)[1] for a, b in pairwise(closed)]
        assert np.abs(areas).min() < 1e-9
        assert max(areas) < 1e-9  # it lies outside no edge
    assert (np.einsum("nd,nd->n", image - arm, normal) > 0.0).all()


def test_mirror_points_lie_as_far_outside_a_disc():
    arm, normal, _ = fill_disc(0.6, 0.05, 0.1)
    image = sphere_images(0.6, arm, normal)
    np.testing.assert_allclose(np.linalg.norm(0.5 * (arm + image), axis=1), 0.3, rtol=1e-12)


def test_offsets_and_widths_are_those_of_the_outline():
    square = SQUARE[:, [0, 2]]
    np.testing.assert_allclose(np.abs(offset_inward(square, 0.05)), 0.15, rtol=1e-12)
    np.testing.assert_allclose(np.abs(offset_inward(square, -0.05)), 0.25, rtol=1e-12)
    assert len(offset_inward(square, 0.21)) == 0
    assert inradius(rotate(OBLONG, 0.7)[:, [0, 2]]) == pytest.approx(0.15, rel=1e-9)
    # The triangle of sides 3, 4 and 5 has a circle of radius 1 in it.
    assert inradius(np.array([[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]])) == pytest.approx(1.0)
