"""Bodies filled with samples: volume, spacing, skin."""

import math

import numpy as np
import pytest

from quintet.components.shared.geometry.surface_samples_solid import (
    box_images,
    fill_box,
    fill_sphere,
    sphere_images,
)

DEEP = 1e9
BOX, SPHERE = "box", "sphere"


def fill(shape, size, spacing, depth):
    """Samples of a box, or of a sphere."""
    if shape == BOX:
        return fill_box(size, spacing, depth)
    return fill_sphere(size[0], spacing, depth)


def mirrors(shape, size, arm, normal):
    """Images of samples of a box, or of a sphere."""
    if shape == BOX:
        return box_images(size, arm, normal)
    return sphere_images(size[0], arm, normal)


@pytest.mark.parametrize("spacing", [0.1, 0.07, 0.5])
def test_volumes_of_a_box_add_up(spacing):
    size = np.array([1.0, 0.6, 0.4])
    arm, normal, volume = fill(BOX, size, spacing, DEEP)
    assert volume.sum() == pytest.approx(0.24, rel=1e-13)
    np.testing.assert_allclose(arm.mean(axis=0), 0.0, atol=1e-14)
    np.testing.assert_allclose(np.linalg.norm(normal, axis=1), 1.0, rtol=1e-14)


@pytest.mark.parametrize("spacing", [0.1, 0.063, 0.9])
def test_volumes_of_a_sphere_add_up(spacing):
    arm, normal, volume = fill(SPHERE, np.full(3, 1.0), spacing, DEEP)
    assert volume.sum() == pytest.approx(math.pi / 6.0, rel=1e-13)
    assert (np.linalg.norm(arm, axis=1) < 0.5).all()
    np.testing.assert_allclose(arm.mean(axis=0), 0.0, atol=1e-14)
    np.testing.assert_allclose(np.linalg.norm(normal, axis=1), 1.0, rtol=1e-14)


def test_a_box_keeps_the_spacing_that_divides_it():
    arm, _, volume = fill(BOX, np.array([0.4, 0.3, 0.2]), 0.1, DEEP)
    assert len(arm) == 4 * 3 * 2
    np.testing.assert_allclose(volume, 1e-3, rtol=1e-12)
    distance = np.linalg.norm(arm[:, None] - arm[None], axis=2) + np.eye(len(arm))
    assert distance.min() == pytest.approx(0.1, rel=1e-12)
    # The outermost samples lie half a spacing below the faces.
    np.testing.assert_allclose(np.abs(arm).max(axis=0), [0.15, 0.1, 0.05], rtol=1e-12)


def test_spacing_is_rounded_to_divide_the_edges():
    arm, _, _ = fill(BOX, np.array([1.0, 1.0, 1.0]), 0.3, DEEP)
    assert len(arm) == 27


@pytest.mark.parametrize("diameter", [3, 4, 5, 6, 8, 10])
def test_a_sphere_has_as_many_samples_as_it_has_cubes_on_shells(diameter):
    arm, _, _ = fill(SPHERE, np.full(3, float(diameter)), 1.0, DEEP)
    assert len(arm) == pytest.approx(math.pi / 6.0 * diameter**3, rel=0.02)
    outermost = np.linalg.norm(arm, axis=1).max()
    assert outermost == pytest.approx(0.5 * diameter - 0.5)
    distance = np.linalg.norm(arm[:, None] - arm[None], axis=2) + 9.0 * np.eye(len(arm))
    assert distance.min() > 0.6


@pytest.mark.parametrize("shape", [SPHERE, BOX])
def test_only_a_skin_of_the_depth_is_filled(shape):
    size, spacing, depth = np.full(3, 1.0), 0.05, 0.12
    arm, _, volume = fill(shape, size, spacing, depth)
    all_arms, _, whole_volume = fill(shape, size, spacing, DEEP)
    if shape == BOX:
        depths = (0.5 - np.abs(all_arms)).min(axis=1)
    else:
        depths = 0.5 - np.linalg.norm(all_arms, axis=1)
    np.testing.assert_array_equal(arm, all_arms[depths < depth])
    assert 0 < len(arm) < len(all_arms)
    np.testing.assert_array_equal(volume, whole_volume[: len(volume)])


def test_normals_point_outward_and_between_the_faces_on_edges():
    arm, normal, _ = fill(BOX, np.full(3, 0.4), 0.1, DEEP)
    assert ((arm * normal).sum(axis=1) > 0.0).all()
    corner = np.argmax(arm.sum(axis=1))
    np.testing.assert_allclose(normal[corner], np.full(3, 1.0 / math.sqrt(3.0)), rtol=1e-14)
    face = np.flatnonzero(np.isclose(arm, [0.15, 0.05, 0.05]).all(axis=1))[0]
    np.testing.assert_allclose(normal[face], [1.0, 0.0, 0.0], atol=1e-15)
    arm, normal, _ = fill(SPHERE, np.full(3, 1.0), 0.1, DEEP)
    radial = arm / np.linalg.norm(arm, axis=1)[:, None]
    np.testing.assert_allclose(normal, radial, atol=1e-14)


@pytest.mark.parametrize("shape", [SPHERE, BOX])
def test_a_body_smaller_than_the_spacing_has_one_sample(shape):
    arm, normal, volume = fill(shape, np.full(3, 0.1), 1.0, DEEP)
    np.testing.assert_allclose(arm, np.zeros((1, 3)), atol=1e-15)
    np.testing.assert_array_equal(normal, [[0.0, 0.0, 1.0]])
    exact = 1e-3 * (math.pi / 6.0 if shape == SPHERE else 1.0)
    assert volume.sum() == pytest.approx(exact, rel=1e-13)


@pytest.mark.parametrize(("shape", "size"), [(BOX, (0.4, 0.3, 0.2)), (SPHERE, (0.4,) * 3)])
def test_mirror_points_lie_as_far_outside(shape, size):
    size = np.array(size)
    arm, normal, _ = fill(shape, size, 0.05, 0.1)
    image = mirrors(shape, size, arm, normal)
    midpoint = 0.5 * (arm + image)
    if shape == BOX:
        assert np.isclose(np.abs(midpoint), 0.5 * size).any(axis=1).all()
        assert (np.abs(midpoint) <= 0.5 * size + 1e-12).all()
    else:
        np.testing.assert_allclose(np.linalg.norm(midpoint, axis=1), 0.2, rtol=1e-12)
    outside = np.abs(image) > 0.5 * size if shape == BOX else np.linalg.norm(image, axis=1) > 0.2
    assert (outside.any(axis=1) if shape == BOX else outside).all()
