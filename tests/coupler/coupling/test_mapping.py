"""Operators and their transposes: motion maps consistently, forces conservatively, power is one."""

import numpy as np
import pytest

from quintet.components.shared.geometry.face_projection import at_points, bilinear, project
from quintet.components.shared.geometry.surface_samples import Sampling
from quintet.components.shared.geometry.surface_samples_mesh import sample_faces
from quintet.coupler.coupling.mapping import RigidMap, ShapeMap, sum_by
from quintet.interfaces.rotation import matrix

RANDOM = np.random.default_rng(5)


def _turned(axis, angle):
    """Unit quaternion of a turn about an axis."""
    axis = np.asarray(axis) / np.linalg.norm(axis)
    return np.concatenate([[np.cos(0.5 * angle)], np.sin(0.5 * angle) * axis])


def _mesh(n=3, m=2):
    """A bent mesh of n x m skew quadrilaterals, each node shared by its neighbours."""
    x, y = np.meshgrid(np.arange(n + 1.0), np.arange(m + 1.0))
    position = np.column_stack([x.ravel() + 0.2 * y.ravel(), y.ravel(), 0.1 * x.ravel() ** 2])
    first = [(n + 1) * j + i for j in range(m) for i in range(n)]
    return position, np.array([[a, a + 1, a + n + 2, a + n + 1] for a in first], dtype=float)


def _triangles():
    """A square with its centre, as four triangles."""
    position = np.array([[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [1, 1, 0.0]])
    return position, np.array([[i, (i + 1) % 4, 4, -1] for i in range(4)], dtype=float)


def _sampled(position, face, spacing):
    """Samples on the faces themselves: their map, areas and normals."""
    samples = sample_faces(position, face, Sampling(spacing, spacing, inset=0.0, planar=False))
    shape = ShapeMap(samples.node, samples.weight, len(position))
    return shape, samples.volume / spacing, samples.normal


def _hung(points, position, face):
    """Map of points that hang on faces."""
    projection = project(points, position, face)
    return ShapeMap(projection.node, projection.weight, len(position))


def _rigid(samples=200, bodies=4):
    quaternion = RANDOM.normal(size=(bodies, 4))
    quaternion /= np.linalg.norm(quaternion, axis=1)[:, None]
    owner = RANDOM.integers(0, bodies, samples)
    return RigidMap(RANDOM.normal(size=(samples, 3)), owner, bodies), quaternion


def test_rotation_matrices_are_orthogonal_and_turn_by_the_right_hand():
    _, quaternion = _rigid()
    matrices = matrix(quaternion)
    unit = np.broadcast_to(np.eye(3), matrices.shape)
    np.testing.assert_allclose(matrices @ matrices.transpose(0, 2, 1), unit, atol=1e-14)
    quarter = matrix(_turned([0, 0, 1], 0.5 * np.pi)[None])[0]
    np.testing.assert_allclose(quarter @ [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], atol=1e-15)


def test_rigid_power_is_the_same_on_both_sides():
    rigid, quaternion = _rigid()
    velocity, spin, place = (RANDOM.normal(size=(4, 3)) for _ in range(3))
    force = RANDOM.normal(size=(200, 3))
    _, moving = rigid.map_consistent(place, velocity, quaternion, spin)
    total, torque = rigid.map_conservative(force, rigid.arms(quaternion))
    power = np.vdot(total, velocity) + np.vdot(torque, spin)
    assert power == pytest.approx(np.vdot(force, moving), rel=1e-13)


def test_rigid_spread_conserves_force_and_moment():
    rigid, quaternion = _rigid()
    place, force = RANDOM.normal(size=(4, 3)), RANDOM.normal(size=(200, 3))
    position, _ = rigid.map_consistent(place, np.zeros((4, 3)), quaternion, np.zeros((4, 3)))
    total, torque = rigid.map_conservative(force, rigid.arms(quaternion))
    np.testing.assert_allclose(total.sum(axis=0), force.sum(axis=0), atol=1e-12)
    moment = np.cross(position, force).sum(axis=0)
    np.testing.assert_allclose((np.cross(place, total) + torque).sum(axis=0), moment, atol=1e-11)


def test_rigid_rotation_is_exact():
    rigid, _ = _rigid(bodies=1)
    spin, angle = np.array([[0.3, -0.5, 0.8]]), 1.1
    quaternion = _turned(spin[0], angle)[None]
    place = np.array([[3.0, 2.0, 1.0]])
    position, velocity = rigid.map_consistent(place, np.zeros((1, 3)), quaternion, spin)
    axis = spin[0] / np.linalg.norm(spin[0])
    arm = rigid.arm  # Rodrigues' formula, written out
    rotated = arm * np.cos(angle) + np.cross(axis, arm) * np.sin(angle)
    rotated += np.outer(arm @ axis, axis) * (1.0 - np.cos(angle))
    np.testing.assert_allclose(position, place + rotated, atol=1e-14)
    np.testing.assert_allclose(velocity, np.cross(spin[0], rotated), atol=1e-14)
    distance = np.linalg.norm(position - place, axis=1)
    np.testing.assert_allclose(distance, np.linalg.norm(arm, axis=1), rtol=1e-14)


@pytest.mark.parametrize("mesh", [_mesh, _triangles])
def test_face_power_is_the_same_on_both_sides(mesh):
    position, face = mesh()
    shape, _, _ = _sampled(position, face, 0.11)
    velocity = RANDOM.normal(size=position.shape)
    force = RANDOM.normal(size=(len(shape.node), 3))
    power = np.vdot(shape.map_conservative(force), velocity)
    assert power == pytest.approx(np.vdot(force, shape.map_consistent(velocity)), rel=1e-12)


@pytest.mark.parametrize("mesh", [_mesh, _triangles])
def test_constants_stay_constant_and_lines_straight(mesh):
    position, face = mesh()
    shape, _, _ = _sampled(position, face, 0.11)
    np.testing.assert_allclose(shape.weight.sum(axis=1), 1.0, atol=1e-15)
    np.testing.assert_allclose(
        shape.map_consistent(np.full((len(position), 1), 7.0)), 7.0, rtol=1e-15
    )
    slope = RANDOM.normal(size=(3, 3))
    np.testing.assert_allclose(
        shape.map_consistent(position @ slope), shape.map_consistent(position) @ slope, atol=1e-13
    )


@pytest.mark.parametrize("mesh", [_mesh, _triangles])
def test_spread_conserves_force_and_moment_over_shared_nodes(mesh):
    position, face = mesh()
    shape, _, _ = _sampled(position, face, 0.11)
    force = RANDOM.normal(size=(len(shape.node), 3))
    nodal = shape.map_conservative(force)
    np.testing.assert_allclose(nodal.sum(axis=0), force.sum(axis=0), atol=1e-12)
    moment = np.cross(shape.map_consistent(position), force).sum(axis=0)
    np.testing.assert_allclose(np.cross(position, nodal).sum(axis=0), moment, atol=1e-12)


def test_samples_of_plane_faces_share_their_area():
    position, face = _triangles()
    shape, area, normal = _sampled(position, face, 0.07)
    assert area.sum() == pytest.approx(4.0, rel=1e-14)
    np.testing.assert_allclose(normal, np.tile([0.0, 0.0, 1.0], (len(area), 1)), atol=1e-15)
    flat, square = _mesh()
    flat[:, 2] = 0.0
    assert _sampled(flat, square, 0.3)[1].sum() == pytest.approx(6.0, rel=1e-14)
    assert (shape.weight >= 0.0).all()


def test_samples_keep_the_spacing():
    position = np.array([[0, 0, 0], [1, 0, 0], [1, 0.5, 0], [0, 0.5, 0.0]])
    shape, area, _ = _sampled(position, np.array([[0, 1, 2, 3.0]]), 0.1)
    place = shape.map_consistent(position)
    assert len(place) == 50
    np.testing.assert_allclose(area, 0.01, rtol=1e-14)
    distances = np.linalg.norm(place[:, None] - place[None], axis=2) + np.eye(50)
    assert distances.min() == pytest.approx(0.1, rel=1e-12)


@pytest.mark.parametrize("mesh", [_mesh, _triangles])
def test_points_on_faces_are_projected_onto_themselves(mesh):
    position, face = mesh()
    shape, _, normal = _sampled(position, face, 0.13)
    place = shape.map_consistent(position)
    np.testing.assert_allclose(
        _hung(place, position, face).map_consistent(position), place, atol=1e-9
    )
    projected = _hung(place + 0.02 * normal, position, face).map_consistent(position)
    np.testing.assert_allclose(projected, place, atol=1e-6)


def test_points_are_hung_on_the_nearest_face_however_unequal_the_faces_are():
    x = np.array([0.0, 10.0, 10.4, 10.8])
    position = np.array([[a, b, 0.0] for b in (0.0, 1.0) for a in x])
    face = np.array([[i, i + 1, i + 5, i + 4] for i in range(3)], dtype=float)
    point = np.array([[9.5, 0.5, 0.1]])  # above the long face, nearer to the short one's centre
    shape = _hung(point, position, face)
    np.testing.assert_allclose(shape.map_consistent(position), [[9.5, 0.5, 0.0]], atol=1e-12)


def test_points_beyond_the_rim_hang_on_the_rim():
    position = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]])
    shape = _hung(np.array([[1.5, 0.3, 0.2]]), position, np.array([[0, 1, 2, 3.0]]))
    np.testing.assert_allclose(shape.map_consistent(position), [[1.0, 0.3, 0.0]], atol=1e-12)
    assert shape.weight.sum() == pytest.approx(1.0)


def test_points_on_edges_and_corners_of_faces_hang_on_one_face_each():
    position, face = _mesh()
    projection = project(position, position, face)
    np.testing.assert_allclose(
        at_points(projection.weight, position[projection.node]), position, atol=1e-12
    )
    np.testing.assert_allclose(projection.gap, 0.0, atol=1e-12)
    np.testing.assert_allclose(projection.beyond, 0.0, atol=1e-12)
    assert projection.face.min() == 0 and projection.face.max() == len(face) - 1


def test_projection_of_no_points_is_empty():
    position, face = _mesh()
    shape = _hung(np.zeros((0, 3)), position, face)
    assert shape.map_consistent(position).shape == (0, 3)
    np.testing.assert_array_equal(shape.map_conservative(np.zeros((0, 3))), np.zeros_like(position))


def test_shape_functions_are_one_at_their_corner():
    xi, eta = np.array([-1.0, 1.0, 1.0, -1.0]), np.array([-1.0, -1.0, 1.0, 1.0])
    np.testing.assert_array_equal(bilinear(xi, eta), np.eye(4))


def test_sums_by_owner_are_those_of_the_dense_operator():
    values, owner = RANDOM.normal(size=(50, 3)), RANDOM.integers(0, 5, 50)
    dense = (owner == np.arange(6)[:, None]).astype(float) @ values  # the last owner has no row
    np.testing.assert_allclose(sum_by(values, owner, 6), dense, atol=1e-14)


def test_gather_is_the_transpose_of_spread():
    position, face = _mesh()
    shape, _, _ = _sampled(position, face, 0.5)
    samples, nodes = len(shape.node), len(position)
    gather = np.array([shape.map_consistent(unit[:, None])[:, 0] for unit in np.eye(nodes)]).T
    spread = np.array([shape.map_conservative(unit[:, None])[:, 0] for unit in np.eye(samples)]).T
    np.testing.assert_array_equal(gather, spread.T)
    assert isinstance(shape, ShapeMap)
