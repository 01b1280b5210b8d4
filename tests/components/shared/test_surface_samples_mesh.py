"""Samples below the faces of a mesh: positions, volumes, and the transfer of loads."""

import numpy as np
import pytest

from quintet.components.shared.geometry.surface_samples import Sampling
from quintet.components.shared.geometry.surface_samples_mesh import sample_faces
from quintet.coupler.coupling.mapping import OffsetMap, ShapeMap
from quintet.interfaces.rotation import matrix

RANDOM = np.random.default_rng(7)
SPACING, DEPTH = 0.1, 0.3
SAMPLING = Sampling(SPACING, DEPTH, 0.5 * SPACING, planar=False)
FLAT = Sampling(SPACING, DEPTH, 0.5 * SPACING, planar=True)


def offset(samples):
    """Map of samples as a link makes it."""
    nodes = int(samples.node.max()) + 1
    weights = (samples.weight, samples.along, samples.across)
    shapes = [ShapeMap(samples.node, weight, nodes) for weight in weights]
    return OffsetMap(*shapes, samples.depth, samples.side)


def _grid(n, m, size, normal=1.0):
    """Faces of a plate in z = 0 whose normals point up (1) or down (-1)."""
    x, y = np.meshgrid(np.linspace(0.0, size[0], n + 1), np.linspace(0.0, size[1], m + 1))
    position = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
    first = [(n + 1) * j + i for j in range(m) for i in range(n)]
    face = np.array([[a, a + 1, a + n + 2, a + n + 1] for a in first])
    return position, face if normal > 0.0 else face[:, ::-1]


def _plate(thickness, n=4, m=3, size=(1.2, 0.9)):
    """Upper and lower faces of a plate, of different meshes."""
    upper, upper_face = _grid(n, m, size)
    lower, lower_face = _grid(n + 1, m + 2, size, normal=-1.0)
    lower[:, 2] -= thickness
    return np.concatenate([upper, lower]), np.concatenate([upper_face, lower_face + len(upper)])


def _ring(points):
    """Edges of a polygon in the plane of x and z, going round from x to z."""
    corner = np.array([[x, 0.0, z] for x, z in points])
    count = len(corner)
    edge = np.full((count, 4), -1)
    edge[:, 0], edge[:, 1] = np.arange(count), np.roll(np.arange(count), -1)
    return corner, edge


def test_a_side_is_sampled_to_the_depth_that_the_fluid_asks_for():
    position, face = _grid(4, 3, (1.2, 0.9))
    samples = sample_faces(position, face, SAMPLING)
    place, sample_velocity, mirror = offset(samples).map_consistent(
        position, np.zeros_like(position)
    )
    assert len(place) == 12 * 9 * 3
    np.testing.assert_allclose(np.unique(place[:, 2].round(12)), [-0.25, -0.15, -0.05])
    np.testing.assert_allclose(mirror, place * [1.0, 1.0, -1.0], atol=1e-15)
    np.testing.assert_allclose(samples.volume, SPACING**3, rtol=1e-12)
    np.testing.assert_array_equal(sample_velocity, np.zeros_like(sample_velocity))
    assert samples.room == np.inf


@pytest.mark.parametrize("thickness", [0.1, 0.25, 0.4, 0.55, 0.61])
def test_a_plate_wetted_on_both_sides_is_filled_once(thickness):
    position, face = _plate(thickness)
    samples = sample_faces(position, face, SAMPLING)
    place, _, mirror = offset(samples).map_consistent(position, np.zeros_like(position))
    sampled = min(thickness, 2 * DEPTH) * 1.2 * 0.9
    assert samples.volume.sum() == pytest.approx(sampled, rel=1e-12)
    upper = samples.normal[:, 2] > 0.0
    assert (place[upper, 2] > -0.5 * thickness).all() and (
        place[~upper, 2] < -0.5 * thickness
    ).all()
    outside = np.where(upper, mirror[:, 2], -thickness - mirror[:, 2])
    np.testing.assert_allclose(outside, np.where(upper, -place[:, 2], thickness + place[:, 2]))
    assert samples.room == pytest.approx(thickness) or thickness > 0.6


def test_a_bar_wetted_all_around_is_filled_once():
    """At edges each sample belongs to its nearest face; on the diagonal to one of the two."""
    position, edge = _ring([(0.0, 0.0), (0.8, 0.0), (0.8, 0.4), (0.0, 0.4)])
    samples = sample_faces(position, edge, FLAT)
    place = offset(samples).map_consistent(position, np.zeros_like(position))[0]
    lattice = {(round(x / SPACING - 0.5), round(z / SPACING - 0.5)) for x, _, z in place}
    assert len(place) == len(lattice) == 32
    assert samples.volume.sum() == pytest.approx(0.32, rel=1e-12)
    np.testing.assert_allclose(place[:, 1], 0.0, atol=1e-16)


def test_normals_of_edges_look_out_of_the_body():
    position, edge = _ring([(0.0, 0.0), (0.8, 0.0), (0.8, 0.4), (0.0, 0.4)])
    samples = sample_faces(position, edge, FLAT)
    place, _, mirror = offset(samples).map_consistent(position, np.zeros_like(position))
    centre = np.array([0.4, 0.0, 0.2])
    assert (((mirror - place) * samples.normal).sum(axis=1) > 0.0).all()
    outside = np.abs(mirror - centre) > [0.4, 1.0, 0.2]
    assert outside.any(axis=1).all()


def _bend(position):
    """Displaced nodes of a plate that is bent, sheared and stretched."""
    x, y, z = position.T
    return np.column_stack([1.02 * x - 0.2 * z * x, y + 0.03 * x, z + 0.1 * x * x - 0.05 * x * y])


@pytest.mark.parametrize("sampling", [SAMPLING, FLAT])
def test_samples_of_a_deformed_plate_keep_their_depth_and_move_as_it_does(sampling):
    """Velocities are the exact rates of the positions."""
    if sampling.planar:
        position, face = _ring([(x, 0.3 * x * x) for x in np.linspace(1.0, 0.0, 9)] + [(0.5, -1.0)])
    else:
        position, face = _plate(0.4)
    samples = sample_faces(position, face, sampling)
    deformed, velocity = _bend(position), RANDOM.normal(size=position.shape)
    if sampling.planar:
        deformed[:, 1], velocity[:, 1] = 0.0, 0.0
    place, sample_velocity, mirror = offset(samples).map_consistent(deformed, velocity)
    surface = offset(samples).surface.map_consistent(deformed)
    np.testing.assert_allclose(
        np.linalg.norm(surface - place, axis=1), offset(samples).depth, rtol=1e-12
    )
    np.testing.assert_allclose(surface - place, mirror - surface, atol=1e-14)
    step = 1e-6
    after, before = (
        offset(samples).map_consistent(deformed + sign * step * velocity, velocity)[0]
        for sign in (1, -1)
    )
    np.testing.assert_allclose((after - before) / (2.0 * step), sample_velocity, atol=1e-8)


def test_a_velocity_that_is_linear_over_a_flat_plate_is_exact_below_it():
    position, face = _plate(0.4)
    samples = sample_faces(position, face, SAMPLING)
    zero = np.zeros_like(position)
    place = offset(samples).map_consistent(position, zero)[0]
    stretch = np.diag([0.3, -0.2, 0.0])
    stretch[0, 1] = 0.5
    sample_velocity = offset(samples).map_consistent(position, position @ stretch)[1]
    np.testing.assert_allclose(sample_velocity, place @ stretch, atol=1e-13)


def test_a_body_that_turns_carries_its_samples_as_if_they_were_fixed_to_it():
    position, face = _plate(0.4)
    samples = sample_faces(position, face, SAMPLING)
    spin = np.array([0.3, -0.5, 0.8])
    half = 0.5 * 1.3 * spin / np.linalg.norm(spin)
    turn = np.concatenate([[np.cos(np.linalg.norm(half))], np.sin(np.linalg.norm(half)) * spin])
    turn[1:] /= np.linalg.norm(spin)
    rotation = matrix(turn[None])[0]
    place = offset(samples).map_consistent(position, np.zeros_like(position))[0] @ rotation.T
    turned_position = position @ rotation.T
    turned_place, sample_velocity, _ = offset(samples).map_consistent(
        turned_position, np.cross(spin, turned_position)
    )
    np.testing.assert_allclose(turned_place, place, atol=1e-14)
    np.testing.assert_allclose(sample_velocity, np.cross(spin, place), atol=1e-14)


@pytest.mark.parametrize("sampling", [SAMPLING, FLAT])
def test_loads_below_faces_conserve_force_moment_and_power(sampling):
    """Forces are mapped by the transpose of the velocity map."""
    if sampling.planar:
        position, face = _ring([(0.0, 0.0), (0.8, 0.1), (0.9, 0.5), (0.0, 0.4)])
    else:
        position, face = _plate(0.4)
    samples = sample_faces(position, face, sampling)
    bent = position if sampling.planar else _bend(position)
    velocity, force = RANDOM.normal(size=bent.shape), RANDOM.normal(size=(len(samples.volume), 3))
    if sampling.planar:
        velocity[:, 1], force[:, 1] = 0.0, 0.0
    place, sample_velocity, _ = offset(samples).map_consistent(bent, velocity)
    nodal = offset(samples).map_conservative(force, bent)
    assert np.vdot(nodal, velocity) == pytest.approx(np.vdot(force, sample_velocity), rel=1e-12)
    force_scale = np.abs(force).sum()
    assert np.abs(nodal.sum(axis=0) - force.sum(axis=0)).max() <= 1e-14 * force_scale
    moment = np.cross(place, force).sum(axis=0)
    np.testing.assert_allclose(np.cross(bent, nodal).sum(axis=0), moment, atol=1e-12 * force_scale)


def test_faces_of_a_ball_are_sampled_without_holes():
    """Adjacent faces keep all their samples."""
    count, radius = 12, 1.0
    polar = np.linspace(0.2, np.pi - 0.2, count + 1)
    azimuth = np.linspace(0.0, 2.0 * np.pi, 2 * count, endpoint=False)
    p, a = np.meshgrid(polar, azimuth, indexing="ij")
    position = radius * np.stack([np.sin(p) * np.cos(a), np.sin(p) * np.sin(a), np.cos(p)], axis=-1)
    row, width = np.arange(count), 2 * count
    i, j = (index.ravel() for index in np.meshgrid(row, np.arange(width), indexing="ij"))
    face = np.stack(
        [i * width + j, (i + 1) * width + j, (i + 1) * width + (j + 1) % width,
         i * width + (j + 1) % width], axis=1,
    )  # fmt: skip
    samples = sample_faces(position.reshape(-1, 3), face, SAMPLING)
    one_layer = sample_faces(position.reshape(-1, 3), face, Sampling(SPACING, SPACING, 0.0, False))
    assert len(samples.volume) == 3 * len(one_layer.volume)
    assert (
        np.linalg.norm(
            offset(samples).map_consistent(
                position.reshape(-1, 3), np.zeros((position.size // 3, 3))
            )[0],
            axis=1,
        )
        < radius
    ).all()
