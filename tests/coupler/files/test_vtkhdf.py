"""The picture files: our reader and VTK's read back the written views."""

import os
import signal
import subprocess
import sys

import numpy as np
import pytest
import pyvista

from quintet.components.shared.geometry.box_faces import CORNERS, FACES
from quintet.coupler.files.vtkhdf import VtkHdf, resume
from quintet.coupler.files.vtkhdf_reader import read_step, scene, times, units
from quintet.interfaces.errors import PortError, SceneError

COUNTS = (5, 7, 7, 5, 0, 30, 6)
CELLS = np.array([[0, 1, 2, 3], [0, 1, 2, -1]])


def _views(counts=COUNTS, cells=None):
    random = np.random.default_rng(5)
    views = []
    for n in counts:
        view = {"points": random.random((n, 3)), "velocity": random.random((n, 3))}
        view["pressure"] = random.random(n)
        views.append(view if cells is None else {**view, "cells": cells})
    return views


def _write(path, views):
    file = VtkHdf(path)
    for k, view in enumerate(views):
        file.append(0.1 * k, view)
    file.close()


@pytest.fixture
def vtk_steps():
    hdf = pytest.importorskip("vtkmodules.vtkIOHDF")
    from vtkmodules.util.numpy_support import vtk_to_numpy

    def read(path, order):
        reader = hdf.vtkHDFReader()
        reader.SetFileName(str(path))
        reader.UpdateInformation()
        steps = {}
        for k in order:
            reader.SetStep(k)
            reader.Update()
            output = reader.GetOutput()
            data = output.GetPointData()
            steps[k] = {
                "time": reader.GetTimeValue(),
                "points": vtk_to_numpy(output.GetPoints().GetData()),
                "velocity": vtk_to_numpy(data.GetArray("velocity")),
                "pressure": vtk_to_numpy(data.GetArray("pressure")),
                "vertices": vtk_to_numpy(output.GetVerts().GetConnectivityArray()),
                "ends": vtk_to_numpy(output.GetVerts().GetOffsetsArray()),
                "corners": vtk_to_numpy(output.GetPolys().GetConnectivityArray()),
                "begins": vtk_to_numpy(output.GetPolys().GetOffsetsArray()),
            }
        return reader.GetNumberOfSteps(), steps

    return read


def test_vtk_reads_each_step_of_a_cloud_whose_number_of_points_changes(tmp_path, vtk_steps):
    views = _views((5, 7, 7, 5, 30, 6))
    _write(tmp_path / "a.vtkhdf", views)
    count, steps = vtk_steps(tmp_path / "a.vtkhdf", (3, 0, 5, 4, 2, 1))
    assert count == len(views)
    for k, view in enumerate(views):
        for key in ("points", "velocity", "pressure"):
            assert np.array_equal(steps[k][key], view[key].astype(np.float32))
        assert steps[k]["time"] == 0.1 * k
        assert np.array_equal(steps[k]["vertices"], np.arange(len(view["points"])))
        assert np.array_equal(steps[k]["ends"], np.arange(len(view["points"]) + 1))
        assert not len(steps[k]["corners"])


def test_vtk_reads_moving_polygons_with_triangles_among_them(tmp_path, vtk_steps):
    _write(tmp_path / "b.vtkhdf", _views((4, 4, 6), CELLS))
    _, steps = vtk_steps(tmp_path / "b.vtkhdf", (2, 0, 1))
    for k in range(3):
        assert steps[k]["corners"].tolist() == [0, 1, 2, 3, 0, 1, 2]
        assert steps[k]["begins"].tolist() == [0, 4, 7]
        assert not len(steps[k]["vertices"])


def test_vtk_reads_more_steps_than_one_block_of_the_tables(tmp_path, vtk_steps):
    views = _views([2 + k % 3 for k in range(1100)])
    _write(tmp_path / "c.vtkhdf", views)
    count, steps = vtk_steps(tmp_path / "c.vtkhdf", (1099, 1024, 1023))
    assert count == 1100
    for k in steps:
        assert np.array_equal(steps[k]["points"], views[k]["points"].astype(np.float32))


@pytest.mark.parametrize("cells", [None, CELLS])
def test_a_step_reads_back_as_it_was_appended(tmp_path, cells):
    views = _views(COUNTS if cells is None else (4, 9, 4), cells)
    _write(tmp_path / "d.vtkhdf", views)
    assert np.array_equal(times(tmp_path / "d.vtkhdf"), 0.1 * np.arange(len(views)))
    for k, view in enumerate(views):
        time, step = read_step(tmp_path / "d.vtkhdf", k)
        assert time == 0.1 * k and step.keys() == view.keys()
        for key, array in view.items():
            expected = array if key == "cells" else array.astype(np.float32)
            assert np.array_equal(step[key], expected)


def test_a_picture_file_may_be_read_while_it_grows(tmp_path):
    path = tmp_path / "e.vtkhdf"
    file = VtkHdf(path)
    file.append(0.0, _views()[0])
    importing = "from quintet.coupler.files.vtkhdf_reader import times"
    script = f"{importing}; print(len(times({str(path)!r})))"
    result = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    file.close()
    assert result.stdout.strip() == "1", result.stderr


def test_a_killed_writer_leaves_every_appended_step(tmp_path, vtk_steps):
    path = tmp_path / "f.vtkhdf"
    script = f"""
import os, signal, numpy as np
from quintet.coupler.files.vtkhdf import VtkHdf
file = VtkHdf({str(path)!r})
for k in range(9):
    ones = np.full((50 + k, 3), float(k))
    file.append(0.5 * k, dict(points=ones, velocity=ones, pressure=ones[:, 0]))
os.kill(os.getpid(), signal.SIGKILL)
"""
    result = subprocess.run([sys.executable, "-c", script], env=os.environ, check=False)
    assert result.returncode == -signal.SIGKILL
    count, steps = vtk_steps(path, (8, 0))
    assert count == len(times(path)) == 9
    assert (steps[8]["velocity"] == 8.0).all() and len(steps[8]["velocity"]) == 58
    assert read_step(path, 8)[0] == 4.0


def test_a_view_that_changes_its_names_shapes_or_cells_is_refused(tmp_path):
    file = VtkHdf(tmp_path / "g.vtkhdf")
    view = _views((4,), CELLS)[0]
    file.append(0.0, view)
    for wrong_view, word in (
        ({"points": view["points"]}, "is missing"),
        ({**view, "heat": view["pressure"]}, "heat appeared"),
        ({**view, "velocity": view["points"][:, :2]}, "velocity must keep"),
        ({**view, "pressure": np.zeros(3)}, "pressure must have one row"),
        ({"velocity": view["velocity"]}, "must have points"),
        ({k: v[:3] for k, v in view.items()}, "cells use 4 points"),
    ):
        with pytest.raises(PortError, match=word):
            file.append(0.1, wrong_view)
    file.close()
    assert len(times(tmp_path / "g.vtkhdf")) == 1


@pytest.mark.parametrize("begins_with_ranks", [True, False])
def test_a_file_goes_on_with_another_number_of_ranks(tmp_path, begins_with_ranks):
    views = _views((5, 5))
    ranks = {"rank": np.array([0.0, 1.0, 1.0, 0.0, 1.0])}
    first, second = (ranks, {}) if begins_with_ranks else ({}, ranks)
    _write(tmp_path / "of_two.vtkhdf", [{**views[0], **first}, {**views[1], **second}])
    _write(tmp_path / "of_one.vtkhdf", views)
    for k in range(2):
        _, step = read_step(tmp_path / "of_two.vtkhdf", k)
        _, plain_step = read_step(tmp_path / "of_one.vtkhdf", k)
        assert all((step[key] == plain_step[key]).all() for key in plain_step)
        if begins_with_ranks:
            assert (step["rank"] == (ranks["rank"] if k == 0 else 0.0)).all()
        else:
            assert "rank" not in step


def test_pyvista_shows_the_rank_of_each_point(tmp_path):
    ranks = np.array([0.0, 1.0, 1.0, 0.0, 1.0])
    path = tmp_path / "points.vtkhdf"
    _write(path, [{**view, "rank": ranks} for view in _views((5, 5))])
    assert (pyvista.read(path)["rank"] == ranks).all()


def test_a_step_that_is_not_there_is_refused_by_its_number(tmp_path):
    _write(tmp_path / "h.vtkhdf", _views((3,)))
    with pytest.raises(SceneError, match="1 steps; there is no step 1"):
        read_step(tmp_path / "h.vtkhdf", 1)
    (tmp_path / "text.vtkhdf").write_text("no")
    with pytest.raises(SceneError, match="must be a VTKHDF file"):
        times(tmp_path / "text.vtkhdf")


UNITS = {"velocity": "m/s", "pressure": "Pa", "stress": "Pa"}


def _mixed(k):
    """A box, two spheres beside it, a stress over the faces; at a step."""
    rng = np.random.default_rng(k)
    points = np.concatenate([CORNERS + 0.1 * k, rng.random((2, 3))])
    radius = np.array([0.0] * 8 + [0.1, 0.2])
    view = {"points": points, "velocity": rng.random((10, 3)), "radius": radius}
    return view | {"cells": FACES, "stress": rng.random((6, 2))}


def test_fields_over_cells_and_loose_points_read_back(tmp_path):
    views = [_mixed(k) for k in range(3)]
    _write(tmp_path / "a.vtkhdf", views)
    for k, view in enumerate(views):
        step = read_step(tmp_path / "a.vtkhdf", k)[1]
        assert step.keys() == view.keys()
        assert all(np.array_equal(step[key], np.float32(view[key])) for key in view)


def test_units_and_scene_read_back_in_the_order_of_the_view(tmp_path):
    file = VtkHdf(tmp_path / "a.vtkhdf", UNITS | {"radius": "m"}, "a – scene")
    file.append(0.0, _mixed(0) | {"unknown": np.zeros(10)})
    file.close()
    read_units = units(tmp_path / "a.vtkhdf")
    assert list(read_units.items()) == [
        ("velocity", "m/s"), ("stress", "Pa"), ("radius", "m"), ("unknown", "")
    ]  # fmt: skip
    assert scene(tmp_path / "a.vtkhdf") == "a – scene"


def test_a_file_that_goes_on_keeps_its_units(tmp_path):
    file = VtkHdf(tmp_path / "a.vtkhdf", UNITS, "here")
    for k in range(3):
        file.append(0.1 * k, _mixed(k))
    file.close()
    resume(tmp_path / "a.vtkhdf", 0.1).close()
    assert len(times(tmp_path / "a.vtkhdf")) == 2 and scene(tmp_path / "a.vtkhdf") == "here"
    assert units(tmp_path / "a.vtkhdf")["stress"] == "Pa"


def _pyvista_steps(path):
    reader = pyvista.get_reader(str(path))
    reader.reader.UpdateInformation()
    for k in range(reader.reader.GetNumberOfSteps()):  # which pyvista's own reader has no name for
        reader.reader.SetStep(k)
        mesh = reader.read()
        yield reader.reader.GetTimeValue(), mesh


def test_pyvista_opens_a_cloud_at_all_steps_with_its_units(tmp_path):
    views = _views((5, 7, 7, 5, 30, 6))
    file = VtkHdf(tmp_path / "a.vtkhdf", UNITS, "a scene")
    for k, view in enumerate(views):
        file.append(0.1 * k, view)
    file.close()
    steps = list(_pyvista_steps(tmp_path / "a.vtkhdf"))
    assert [time for time, _ in steps] == [0.1 * k for k in range(6)]
    for view, (_, mesh) in zip(views, steps, strict=True):
        assert mesh.n_points == mesh.n_verts == len(view["points"])
        assert np.array_equal(mesh["pressure"], view["pressure"].astype(np.float32))
        assert list(mesh.field_data["units"]) == ["points m; velocity m/s; pressure Pa"]
        assert list(mesh.field_data["scene"]) == ["a scene"]


@pytest.mark.parametrize("cells", [None, CELLS])
def test_pyvista_opens_a_file_with_one_step(tmp_path, cells):
    _write(tmp_path / "a.vtkhdf", _views((4,), cells))
    ((time, mesh),) = _pyvista_steps(tmp_path / "a.vtkhdf")
    assert isinstance(mesh, pyvista.PolyData) and mesh.n_points == 4 and time == 0.0


def test_pyvista_opens_faces_spheres_and_fields_over_faces_at_all_steps(tmp_path):
    _write(tmp_path / "a.vtkhdf", [_mixed(k) for k in range(4)])
    for k, (_, mesh) in enumerate(_pyvista_steps(tmp_path / "a.vtkhdf")):
        view = _mixed(k)
        assert (mesh.GetNumberOfVerts(), mesh.GetNumberOfPolys()) == (2, 6)
        assert np.array_equal(mesh.points, view["points"].astype(np.float32))
        assert mesh["radius"][-1] == np.float32(0.2)
        assert np.isnan(mesh.cell_data["stress"][:2]).all()  # the spheres have none
        assert np.array_equal(mesh.cell_data["stress"][2:], view["stress"].astype(np.float32))
    assert k == 3
