"""Walls of bodies as planes of symmetry: images of the nodes above them."""

import math

import numpy as np
import pytest

from quintet.components.meshless_gas.clouds.cloud import SLIP, SYMMETRY
from quintet.components.meshless_gas.clouds.layers import Sides
from quintet.components.meshless_gas.clouds.meridian import (
    Reach,
    SphereInStream,
    sphere_meridian,
)
from quintet.components.meshless_gas.clouds.mirrored import mirrored
from quintet.components.meshless_gas.kernels.symmetry import hold_along
from quintet.components.meshless_gas.stencils import stencils
from quintet.components.shared.threads import Team

SIDES = Sides(
    {"wall": "slip", "far": "inflow", "exit": "outflow"}, {"wall": 1, "far": 2, "exit": 3}
)
REACH = Reach(rays=12, layers=10, first=0.01, sector=math.pi, margin=1.4, farthest=4.0)


def slipping_and_symmetric():
    """A cloud round a sphere of radius 1, and the same with images in its wall."""
    slipping = sphere_meridian(SphereInStream(np.zeros(3), 1.0, 3.0), REACH, SIDES)
    return slipping, mirrored(slipping, SIDES.patches["wall"])


def test_images_lie_below_the_wall_as_deep_as_their_owners_are_above_it():
    slipping, symmetric = slipping_and_symmetric()
    cloud = symmetric.cloud
    images = np.arange(len(slipping.cloud.positions), len(cloud.positions))
    owner = cloud.owner[images - cloud.nodes]
    depth, height = (np.linalg.norm(cloud.positions[rows], axis=1) for rows in (images, owner))
    assert 1.0 - depth == pytest.approx(height - 1.0)
    out = cloud.positions[images] / depth[:, None]
    turned = np.einsum("gab,gb->ga", cloud.turn[images - cloud.nodes], cloud.positions[owner])
    assert turned == pytest.approx(-out * height[:, None])  # what flows out there flows in here


def test_nodes_of_the_wall_have_whole_stencils_exact_of_linear_fields():
    slipping, symmetric = slipping_and_symmetric()
    wall = symmetric.cloud.kind == SYMMETRY
    assert wall.sum() == REACH.rays == (slipping.cloud.kind == SLIP).sum()
    assert (symmetric.neighbours[wall] != np.flatnonzero(wall)[:, None]).all()
    coefficients = stencils(symmetric.cloud, symmetric.neighbours, False, Team(1)).coefficients
    slope = np.array([0.3, -1.2, 0.7])
    field = symmetric.cloud.positions @ slope
    rise = field[symmetric.neighbours] - field[:, None]
    gradients = (coefficients * rise[:, :, None]).sum(axis=1)[wall]
    assert gradients == pytest.approx(np.tile(slope, (len(gradients), 1)), abs=1e-9)


def test_velocity_through_the_wall_is_taken_with_its_energy():
    normals = np.array([[0.6, 0.0, 0.8]])
    primitive = np.array([[2.0, 1.0, 5.0, 3.0, 7.0]])
    conservative = np.array([[2.0, 2.0, 10.0, 6.0, 7.0 / 0.4 + 35.0]])
    hold_along(np.zeros(1, np.int32), normals, conservative, primitive)
    velocity = primitive[0, 1:4]
    assert normals[0] @ velocity == pytest.approx(0.0)
    assert velocity == pytest.approx([1.0 - 3.0 * 0.6, 5.0, 3.0 - 3.0 * 0.8])
    assert conservative[0, 1:4] == pytest.approx(2.0 * velocity)
    assert conservative[0, 4] == pytest.approx(7.0 / 0.4 + velocity @ velocity)
