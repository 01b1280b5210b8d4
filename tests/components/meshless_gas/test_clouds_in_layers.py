"""Clouds in layers over spheres and plates: places, neighbours, areas, ghosts."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from quintet.components.meshless_gas.clouds.cap import geodesic, sphere_cap
from quintet.components.meshless_gas.clouds.cloud import GHOST, INNER, OUTFLOW, SLIP
from quintet.components.meshless_gas.clouds.grading import geometric
from quintet.components.meshless_gas.clouds.layers import LayeredCloud, Sides
from quintet.components.meshless_gas.clouds.meridian import Reach, SphereInStream, sphere_meridian
from quintet.components.meshless_gas.clouds.plane import plate
from quintet.components.meshless_gas.stencils import stencils
from quintet.components.shared.threads import Team

SIDES = Sides(
    {"wall": "slip", "far": "inflow", "exit": "outflow"}, {"wall": 1, "far": 2, "exit": 3}
)
REACH = Reach(rays=12, layers=10, first=0.01, sector=math.pi, margin=1.4, farthest=4.0)


def meridian(reach: Reach = REACH, is_cross: bool = False) -> LayeredCloud:
    """Cloud round a sphere of radius 1 at M = 3."""
    sphere = SphereInStream(np.zeros(3), 1.0, 3.0)
    return sphere_meridian(sphere, reach._replace(is_cross=is_cross), SIDES)


def test_layers_grow_by_one_factor_from_the_first_to_the_last() -> None:
    heights = geometric(np.array([0.01, 0.5]), np.array([2.0, 2.0]), 8)
    assert heights[[0, -1]].T == pytest.approx(np.array([[0.0, 2.0], [0.0, 2.0]]))
    assert heights[1, 0] == pytest.approx(0.01)
    steps = np.diff(heights[:, 0])
    assert steps[1:] / steps[:-1] == pytest.approx(np.full(7, steps[1] / steps[0]))
    assert heights[1, 1] == pytest.approx(0.25)  # more than a share of the total: even layers


def test_rings_of_a_sphere_have_its_area() -> None:
    cloud = meridian().cloud
    wall = cloud.kind == SLIP
    areas = np.sqrt((cloud.areas[wall] ** 2).sum(axis=1))
    assert areas.sum() == pytest.approx(4.0 * math.pi)
    # A force of one pressure all round has no part along the axis.
    assert cloud.areas[wall, 0].sum() == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("is_cross", [False, True])
def test_gradients_round_an_axis_are_exact_of_linear_fields(is_cross: bool) -> None:
    cloud, neighbours, _ = meridian(is_cross=is_cross)
    coefficients = stencils(cloud, neighbours, False, Team(1)).coefficients
    slope = np.array([0.3, -1.2, 0.7])
    field = cloud.positions @ slope
    rise = field[neighbours] - field[:, None]
    gradients = (coefficients * rise[:, :, None]).sum(axis=1)
    nodes = cloud.nodes
    assert gradients[:nodes] == pytest.approx(np.tile(slope, (nodes, 1)), abs=1e-9)
    assert neighbours.shape[1] == (6 if is_cross else 14)


def test_ghosts_are_their_owners_turned_about_the_axis() -> None:
    cloud = meridian().cloud
    ghosts = cloud.positions[cloud.kind == GHOST]
    assert ghosts == pytest.approx(
        np.einsum("gij,gj->gi", cloud.turn, cloud.positions[cloud.owner])
    )
    assert ghosts[:, 0] == pytest.approx(cloud.positions[cloud.owner, 0])


def test_gas_leaves_downstream_only() -> None:
    cloud = meridian().cloud
    leaving = cloud.positions[cloud.kind == OUTFLOW]
    assert len(leaving) > 0
    assert (leaving[:, 0] > 0.0).all()
    cap = meridian(REACH._replace(sector=1.4)).cloud
    edge = cap.kind == OUTFLOW
    assert (cap.normals[edge, 0] < 0.0).all()  # into the gas: against the flow


def test_jitter_moves_nodes_within_alone() -> None:
    still, moved = meridian().cloud, meridian(REACH._replace(jitter=0.6)).cloud
    is_moved = (still.positions != moved.positions).any(axis=1)
    assert is_moved[still.kind == INNER].any()
    assert not is_moved[(still.kind != INNER) & (still.kind != GHOST)].any()


def test_a_geodesic_grid_covers_the_sphere() -> None:
    points, triangles = geodesic(4)
    assert len(points) == 10 * 4**2 + 2
    assert len(triangles) == 20 * 4**2
    assert (points**2).sum(axis=1) == pytest.approx(np.ones(len(points)))


def test_a_cap_has_the_area_of_its_sector_and_upright_neighbours() -> None:
    layered_cloud = sphere_cap(
        SphereInStream(np.zeros(3), 2.0, 6.0), REACH._replace(rays=30, sector=1.2), SIDES
    )
    cloud = layered_cloud.cloud
    wall = cloud.kind == SLIP
    area = (cloud.areas[wall] * cloud.normals[wall]).sum()
    assert area == pytest.approx(
        2.0 * math.pi * 4.0 * (1.0 - math.cos(1.2)), rel=0.1
    )  # whole triangles
    apart = cloud.positions[layered_cloud.off_wall[:, 0]] - cloud.positions[wall]
    along = (apart * cloud.normals[wall]).sum(axis=1)
    assert along == pytest.approx(np.sqrt((apart**2).sum(axis=1)))


@pytest.mark.parametrize("make", [sphere_cap, sphere_meridian])
def test_the_surface_of_a_cloud_closes_also_where_gas_leaves_it(
    make: Callable[..., LayeredCloud],
) -> None:
    reach = REACH._replace(rays=30, sector=1.2)
    cloud = make(SphereInStream(np.zeros(3), 2.0, 6.0), reach, SIDES).cloud
    total_area = np.abs(cloud.areas[:, 0]).sum()
    assert abs(cloud.areas[:, 0].sum()) < 1e-3 * total_area  # along the axis; rings close across it
    leaving = cloud.kind == OUTFLOW
    assert (cloud.areas[leaving] * cloud.normals[leaving]).sum(axis=1).min() > 0.0


def test_a_plate_begins_at_its_leading_edge() -> None:
    faces = {"wall": "adiabatic", "ahead": "slip", "inlet": "inflow", "far": "outflow"}
    patches = {"wall": 1, "ahead": 2, "inlet": 3, "far": 4, "exit": 5}
    reach = REACH._replace(rays=16, first=0.01, is_cross=True)
    layered_cloud = plate(reach, 1.0, 0.5, 0.4, 0.02, Sides({**faces, "exit": "outflow"}, patches))
    cloud = layered_cloud.cloud
    on_plate = cloud.patch == 1
    assert cloud.positions[on_plate, 0].min() == pytest.approx(0.0)
    assert cloud.positions[on_plate, 0].max() == pytest.approx(1.0)
    assert cloud.positions[:, 2].max() == pytest.approx(0.4)
    assert cloud.areas[cloud.positions[:, 2] == 0.0, 2].sum() == pytest.approx(1.5)
    assert cloud.volumes.sum() == pytest.approx(1.5 * 0.4)
    assert layered_cloud.neighbours.shape[1] == 4
