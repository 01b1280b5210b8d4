"""Unions of spheres and closed meshes filled with samples: volume, depth, images."""

import math
from functools import partial

import numpy as np
import pytest
import trimesh

from quintet.components.dem_bodies.shapes.sphere_union import measure_union
from quintet.components.shared.geometry.surface_samples import (
    Sampling,
    ThinError,
    box,
    mesh,
    sphere,
    spheres,
)
from quintet.interfaces.errors import SceneError

SPACING = 0.02  # m
SAMPLING = Sampling(SPACING, 1e9, 0.5 * SPACING, mirrored=True)
TWO = ((-0.05, 0.0, 0.0), (0.05, 0.0, 0.0)), (0.1, 0.1)
BALL = partial(spheres, np.zeros((1, 3)), np.array([0.1]), math.pi / 6.0 * 0.008)
HULL = trimesh.creation.capsule(height=0.2, radius=0.1, count=[16, 16])
PAIR = partial(spheres, np.array(TWO[0]), np.array(TWO[1]), measure_union(TWO)[0])
SOLID = partial(mesh, np.asarray(HULL.triangles) - HULL.center_mass, HULL.volume)


@pytest.mark.parametrize(
    ("body", "volume"),
    [(BALL, math.pi / 6.0 * 0.008), (PAIR, measure_union(TWO)[0]), (SOLID, HULL.volume)],
)
def test_volumes_of_closed_bodies_add_up(body, volume):
    samples = body(SAMPLING)
    assert samples.volume.sum() == pytest.approx(volume, rel=1e-12)
    np.testing.assert_allclose(samples.arm.mean(axis=0), 0.0, atol=0.05 * SPACING)
    np.testing.assert_allclose(np.linalg.norm(samples.normal, axis=1), 1.0, rtol=1e-12)
    depth = 0.5 * np.linalg.norm(samples.image - samples.arm, axis=1)
    assert depth.min() > 0.3 * SPACING  # the outermost samples are half a spacing deep
    assert ((samples.image - samples.arm) * samples.normal).sum(axis=1).min() > 0.0


def test_one_sphere_of_a_union_is_filled_as_a_sphere():
    union_samples, sphere_samples = BALL(SAMPLING), sphere(0.2, SAMPLING)
    assert len(union_samples.arm) == pytest.approx(len(sphere_samples.arm), rel=0.05)
    np.testing.assert_allclose(
        np.linalg.norm(union_samples.arm, axis=1).max(),
        np.linalg.norm(sphere_samples.arm, axis=1).max(),
        rtol=1e-9,
    )


def test_a_body_far_too_large_for_the_spacing_is_refused_before_memory_runs_out():
    cube = np.asarray(trimesh.creation.box((200.0,) * 3).triangles)
    with pytest.raises(SceneError) as error:
        mesh(cube, 200.0**3, SAMPLING)
    assert str(error.value) == (
        "a body must have at most 1e+08 places for samples; found 1e+12 of one of 200 x 200 x 200 "
        "m, 0.02 m apart. Correct its size or scale, or the spacing of its partner."
    )


def test_a_mesh_of_a_cube_is_filled_as_a_cube():
    cube = np.asarray(trimesh.creation.box((0.12,) * 3).triangles)
    mesh_samples, box_samples = mesh(cube, 0.12**3, SAMPLING), box((0.12,) * 3, SAMPLING)
    assert len(mesh_samples.arm) == len(box_samples.arm)
    distance = np.linalg.norm(mesh_samples.arm[:, None] - box_samples.arm, axis=2)
    assert distance.min(axis=0).max() < 1e-12 and distance.min(axis=1).max() < 1e-12


def test_only_a_skin_is_filled_and_thin_bodies_are_refused():
    skin = BALL(Sampling(SPACING, 2.0 * SPACING, 0.5 * SPACING))
    assert 0 < len(skin.arm) < len(BALL(SAMPLING).arm)
    with pytest.raises(ThinError, match=r"0\.2"):
        BALL(Sampling(0.3, 1.0, 0.15))
