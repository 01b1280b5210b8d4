"""Runs are drawn in three dimensions and as films, and their files are read by PyVista."""

import sys

import numpy as np
import pytest

from quintet.components.shared.geometry.box_faces import box
from quintet.coupler.cli import main
from quintet.coupler.files.vtkhdf import VtkHdf
from quintet.coupler.report import views3d
from quintet.coupler.report.picture import Picture
from quintet.coupler.report.view_steps import Quantity, Shown, Still
from quintet.interfaces.faces import polygons

pyvista = pytest.importorskip("pyvista")
pytestmark = pytest.mark.filterwarnings("ignore")  # of VTK, on machines without a screen
STEPS = 3


@pytest.fixture
def folder(tmp_path):
    """Folder of a run with water, which falls 0.1 m a step, a ball and a box; and a floor."""
    random = np.random.default_rng(1)
    units = {"velocity": "m/s", "pressure": "Pa"}
    water = VtkHdf(tmp_path / "water.vtkhdf", units)
    ball, block = (VtkHdf(tmp_path / f"{n}.vtkhdf", {"velocity": "m/s"}) for n in ("ball", "block"))
    start = random.random((200, 3)) * [1.0, 0.5, 0.4]
    for k in range(STEPS):
        points = start - [0.0, 0.0, 0.1 * k]
        water.append(0.1 * k, {"points": points, "velocity": points, "pressure": points[:, 0] + k})
        centre = np.array([[0.5, 0.2, 1.0 + k]])
        ball.append(0.1 * k, {"points": centre, "velocity": centre, "radius": np.array([0.1])})
        corners = polygons(box([0.0, 0.0, 1.0 + k], [0.2, 0.2, 1.2 + k], ["x-", "z+"]))
        block.append(0.1 * k, {**corners, "velocity": corners["points"]})
    floor = VtkHdf(tmp_path / "water.walls.vtkhdf")
    floor.append(0.0, polygons(box([0.0, 0.0, -1.0], [1.0, 0.5, 0.0], ["z-"])))
    for file in (water, ball, block, floor):
        file.close()
    return tmp_path


def exit_status(*arguments):
    with pytest.raises(SystemExit) as exit_info:
        main(["draw", *map(str, arguments)])
    return exit_info.value.code


@pytest.mark.parametrize("name", ["water", "ball", "block"])
def test_pyvista_reads_every_step_of_a_view(folder, name):
    reader = pyvista.get_reader(folder / f"{name}.vtkhdf").reader
    reader.Update()
    assert reader.GetNumberOfSteps() == STEPS
    heights = []
    for step in range(STEPS):
        reader.SetStep(step)
        reader.Update()
        assert reader.GetTimeValue() == pytest.approx(0.1 * step)
        data = pyvista.wrap(reader.GetOutput())
        assert {"velocity"} <= {*data.point_data.keys()}
        np.testing.assert_allclose(data.point_data["velocity"], data.points, rtol=1e-6)
        heights.append(float(data.points[:, 2].mean()))
    change = -0.1 if name == "water" else 1.0
    assert np.diff(heights) == pytest.approx([change] * (STEPS - 1), rel=1e-4)


def test_walls_are_read_by_pyvista(folder):
    data = pyvista.read(folder / "water.walls.vtkhdf")
    assert data.n_points == 4 and data.bounds[4:] == pytest.approx((-1.0, -1.0))


def test_spheres_have_their_size_and_particles_that_of_their_spacing():
    points = np.stack(np.meshgrid(*[np.arange(4.0)] * 3), axis=-1).reshape(-1, 3)
    absent, zeros = None, np.zeros(len(points))
    values = np.arange(len(points), dtype=float)
    cloud = Shown("water", Quantity("p", "Pa"), points, zeros, values, [], absent)
    ((mesh, colours),) = views3d.meshes(cloud, 0.1)
    assert mesh.bounds[::2] == pytest.approx((-0.5, -0.5, -0.5), abs=0.04)
    assert set(np.unique(colours)) == set(values)
    ball = Shown("ball", absent, points[:1], np.array([2.0]), absent, [], absent)
    ((mesh, colours),) = views3d.meshes(ball, 0.1)
    assert mesh.bounds[5] == pytest.approx(2.0) and colours is None


def test_faces_of_different_numbers_of_corners_are_one_mesh():
    square, triangle = np.eye(4, 3), np.eye(3) + 2.0
    mesh = views3d.polygons([square, triangle])
    assert mesh.n_cells == 2 and mesh.n_points == 7
    np.testing.assert_allclose(mesh.get_cell(1).points, triangle)


def test_the_camera_sees_all_that_moves_and_walls_that_are_near():
    ball = Shown("ball", None, np.zeros((1, 3)), np.array([1.0]), None, [], None)
    far = Still(np.array([[-9.0, -9.0, -1.0], [9.0, -9.0, -1.0], [9.0, 9.0, -1.0]]))
    low, high = views3d._bounds([[ball]], [far])
    rim = 1.0 + 2.0 * views3d.NEAR
    assert low.tolist() == [-rim, -rim, -1.0] and high.tolist() == [rim, rim, 1.0]


def test_a_run_is_drawn_in_three_dimensions(folder, capfd):
    assert exit_status(folder, "--3d", "--times", "0,0.2", "--colour", "water.pressure") == 0
    assert "X server" not in capfd.readouterr().err
    pixels = pyvista.read(folder / "drawn-3d.png")
    wide, tall, _ = pixels.dimensions
    assert (wide, tall) == (2 * views3d.SIZE[0], views3d.SIZE[1])
    colours = np.asarray(pixels.active_scalars).reshape(tall, wide, -1)[..., :3]
    for half in (colours[:, : wide // 2], colours[:, wide // 2 :]):
        assert (half < 250).any(axis=2).mean() > 0.02, "something is drawn in each panel"


def test_a_film_has_a_frame_for_each_step(folder):
    imageio = pytest.importorskip("imageio.v3")
    film = folder / "film.gif"
    assert exit_status(folder, "--animate", film) == 0
    frames = imageio.imread(film, index=None)
    assert len(frames) == STEPS
    assert (frames[0] != frames[-1]).any()


def test_wrong_wishes_are_refused(folder, capsys):
    for options, message in (
        (["--3d", "--section", "0.1"], "--section and --region are for pictures in two"),
        (["--3d", "--out", "a.svg"], "must end with one of .png, .jpg; found .svg"),
        (["--animate", "a.avi"], "must end with .gif or .mp4"),
        (["--animate", folder / "a.gif", "--times", "0.1"], "needs two steps or more; found 1"),
    ):
        assert exit_status(folder, *options) == 2
        assert message in capsys.readouterr().err
    (folder / "mine.gif").write_text("mine")
    assert exit_status(folder, "--animate", folder / "mine.gif") == 2
    assert (folder / "mine.gif").read_text() == "mine"


@pytest.mark.parametrize(
    ("library", "options"),
    [
        ("pyvista", ["--3d"]),
        ("pyvista", ["--animate", "a.gif"]),
        ("imageio", ["--animate", "a.gif"]),
        ("imageio_ffmpeg", ["--animate", "a.mp4"]),
    ],
)
def test_what_lacks_is_named_with_its_extra(folder, monkeypatch, capsys, library, options):
    monkeypatch.setitem(sys.modules, library, None)
    assert exit_status(folder, *options) == 2
    message = capsys.readouterr().err
    assert f"needs the library {library}" in message and "quintet[views3d]" in message


def test_the_verbosity_of_vtk_is_restored_after_drawing(folder, tmp_path):
    from vtkmodules.vtkCommonCore import vtkLogger

    before = vtkLogger.GetCurrentVerbosityCutoff()
    try:
        for verbosity in (vtkLogger.VERBOSITY_WARNING, vtkLogger.VERBOSITY_OFF):
            vtkLogger.SetStderrVerbosity(verbosity)
            views3d.draw_3d(folder, tmp_path / "drawn.png", Picture(times=[0.0]))
            assert vtkLogger.GetCurrentVerbosityCutoff() == verbosity
    finally:
        vtkLogger.SetStderrVerbosity(before)
