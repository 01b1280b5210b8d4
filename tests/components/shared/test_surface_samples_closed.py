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

SPACING = 0.02  # m
ASKED = Sampling(SPACING, 1e9, 0.5 * SPACING, mirrored=True)
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
    found = body(ASKED)
    assert found.volume.sum() == pytest.approx(volume, rel=1e-12)
    np.testing.assert_allclose(found.arm.mean(axis=0), 0.0, atol=0.05 * SPACING)
    np.testing.assert_allclose(np.linalg.norm(found.normal, axis=1), 1.0, rtol=1e-12)
    below = 0.5 * np.linalg.norm(found.image - found.arm, axis=1)
    assert below.min() > 0.3 * SPACING  # the outermost are half a spacing deep
    assert ((found.image - found.arm) * found.normal).sum(axis=1).min() > 0.0


def test_one_sphere_of_a_union_is_filled_as_a_sphere():
    one, other = BALL(ASKED), sphere(0.2, ASKED)
    assert len(one.arm) == pytest.approx(len(other.arm), rel=0.05)
    np.testing.assert_allclose(
        np.linalg.norm(one.arm, axis=1).max(), np.linalg.norm(other.arm, axis=1).max(), rtol=1e-9
    )


def test_a_mesh_of_a_cube_is_filled_as_a_cube():
    cube = np.asarray(trimesh.creation.box((0.12,) * 3).triangles)
    one, other = mesh(cube, 0.12**3, ASKED), box((0.12,) * 3, ASKED)
    assert len(one.arm) == len(other.arm)
    apart = np.linalg.norm(one.arm[:, None] - other.arm, axis=2)
    assert apart.min(axis=0).max() < 1e-12 and apart.min(axis=1).max() < 1e-12


def test_only_a_skin_is_filled_and_thin_bodies_are_refused():
    skin = BALL(Sampling(SPACING, 2.0 * SPACING, 0.5 * SPACING))
    assert 0 < len(skin.arm) < len(BALL(ASKED).arm)
    with pytest.raises(ThinError, match=r"0\.2"):
        BALL(Sampling(0.3, 1.0, 0.15))
