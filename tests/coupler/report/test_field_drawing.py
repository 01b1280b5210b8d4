"""Nodes that sample a continuum are drawn as a field, particles as particles."""

import numpy as np
import pytest

from quintet.coupler.files.vtkhdf import VtkHdf
from quintet.coupler.report.field_drawing import is_field, spans_a_hole
from quintet.coupler.report.view_drawing import colour_scales, diameters, draw_view
from quintet.coupler.report.view_steps import read

UNITS = {"density": "kg/m3", "schlieren": "1", "spacing": "m"}
STEP = 0.1  # m


@pytest.fixture
def nodes(tmp_path):
    """Write a plane of nodes with a round hole; return the file."""
    x, z = np.meshgrid(np.arange(0.0, 2.0, STEP), np.arange(0.0, 1.0, STEP))
    points = np.stack([x.ravel(), np.zeros(x.size), z.ravel()], axis=1)
    points = points[np.hypot(points[:, 0] - 1.0, points[:, 2] - 0.5) > 0.3]
    file = VtkHdf(tmp_path / "gas.vtkhdf", UNITS)
    flat = {"points": points, "density": points[:, 0], "schlieren": points[:, 2]}
    file.append(0.0, flat | {"spacing": np.full(len(points), STEP)})
    file.close()
    return tmp_path / "gas.vtkhdf"


def test_holes_between_nodes_are_left_open(nodes):
    from matplotlib.tri import Triangulation

    view = read(nodes, 0.0, {"gas": "density"})
    assert is_field(view)
    triangles = Triangulation(view.points[:, 0], view.points[:, 2]).triangles
    centres = view.points[triangles].mean(axis=1)
    inside = np.hypot(centres[:, 0] - 1.0, centres[:, 2] - 0.5) < 0.1
    masked = spans_a_hole(view.points, view.spacing, triangles)
    assert masked[inside].all()
    outside = np.hypot(centres[:, 0] - 1.0, centres[:, 2] - 0.5) > 0.45
    assert not masked[outside].any()


def test_a_cloud_that_fills_space_is_drawn_as_points(nodes):
    view = read(nodes, 0.0, {"gas": "density"})
    view.points[:, 1] = np.linspace(0.0, 1.0, len(view.points))
    assert not is_field(view)


def test_schlieren_pictures_are_grey(nodes):
    views = [[read(nodes, 0.0, {"gas": name})] for name in ("density", "schlieren")]
    assert [scale.cmap.name for scale in colour_scales(views, {}).values()] == ["viridis", "gray"]


def test_a_field_is_filled_between_its_nodes_and_has_no_marks(nodes):
    from matplotlib.collections import TriMesh
    from matplotlib.figure import Figure

    views = [[read(nodes, 0.0, {"gas": "density"})]]
    panel = Figure().subplots()
    draw_view(panel, views[0], colour_scales(views, {}), diameters(views[0]))
    (mesh,) = panel.collections
    assert isinstance(mesh, TriMesh)
    assert mesh.get_array().max() == pytest.approx(2.0 - STEP)
