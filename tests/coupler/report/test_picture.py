"""Pictures show the content of the files, and cost nothing to a run without pictures."""

import re
import subprocess
import sys
import time

import numpy as np
import pytest
from started import write_scene

from quintet.components.shared.geometry.box_faces import CORNERS, FACES, box
from quintet.coupler.cli import main
from quintet.coupler.files.vtkhdf import VtkHdf
from quintet.coupler.report import picture as drawing
from quintet.coupler.report.cut import cut_and_sorted
from quintet.coupler.report.picture import Picture, draw_run
from quintet.coupler.report.view_steps import Quantity, moments, read, view_files
from quintet.coupler.run import results
from quintet.interfaces.errors import SceneError
from quintet.interfaces.faces import CLAMPED, SYMMETRY, polygons

UNITS = {"velocity": "m/s", "pressure": "Pa", "stress": "Pa"}
RED, GREEN, BLUE = range(3)


def _cloud(path, n=40, speed=1.0, steps=3):
    random = np.random.default_rng(2)
    file = VtkHdf(path, UNITS)
    for k in range(steps):
        view = {"points": random.random((n, 3)), "velocity": np.full((n, 3), speed * k)}
        file.append(0.1 * k, view | {"pressure": 100.0 * random.random(n)})
    file.close()


def _box(path, **fields):
    file = VtkHdf(path, UNITS)
    for k in range(3):
        file.append(
            0.1 * k, {"points": 0.1 * CORNERS + [1.5, 0.0, 0.1 * k], "cells": FACES, **fields}
        )
    file.close()


def _walls(path, low, high, faces):
    file = VtkHdf(path)
    file.append(0.0, polygons(box(low, high, faces)))
    file.close()


def test_displacements_are_drawn_as_many_times_as_large_as_asked_for(figure, tmp_path):
    displacement = np.full((8, 3), 1e-3)
    file = VtkHdf(tmp_path / "plate.vtkhdf", {"displacement": "m"})
    file.append(
        0.0, {"points": CORNERS + displacement, "cells": FACES, "displacement": displacement}
    )
    file.close()
    picture = figure([0.0], displacement_scale=100.0)
    assert "displacements drawn 100 times as large" in picture.get_suptitle()
    view = read(tmp_path / "plate.vtkhdf", 0.0, {}, 100.0)
    corners = np.concatenate(view.faces)
    assert corners.min(axis=0) == pytest.approx(CORNERS.min(axis=0) + 0.1)


@pytest.fixture
def figure(monkeypatch, tmp_path):
    """Draw, and return matplotlib's figure."""
    figures = []

    def draw(times, title="", **options):
        monkeypatch.setattr(drawing, "save", lambda figure, out: figures.append(figure) or out)
        draw_run(tmp_path, tmp_path / "a.png", Picture(times, **options), title)
        return figures[-1]

    return draw


def _panels(figure):
    return [axes for axes in figure.axes if axes.get_xlabel()]


def _bars(figure):
    return [axes.get_ylabel() for axes in figure.axes if not axes.get_xlabel()]


def _image(path):
    from matplotlib.image import imread

    return imread(path)[..., :3]


def test_a_run_without_pictures_imports_no_drawing():
    names = "picture, quintet.coupler.report.comparison"
    script = f"import sys, quintet.coupler.report.{names}; sys.exit('matplotlib' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", script], check=False).returncode == 0


def test_every_panel_tells_its_time_and_its_axes_with_units(tmp_path, figure):
    _cloud(tmp_path / "water.vtkhdf")
    picture = figure([0.0, 0.1], title="a scene")
    panels = _panels(picture)
    assert picture.get_suptitle().startswith("a scene")
    assert [panel.get_title() for panel in panels] == ["t = 0 s", "t = 0.1 s"]
    assert {(panel.get_xlabel(), panel.get_ylabel()) for panel in panels} == {("x [m]", "z [m]")}


def test_no_panel_is_later_than_the_end_of_the_run(tmp_path, figure):
    _cloud(tmp_path / "water.vtkhdf")
    picture = figure([0.0, 0.11, 0.3, 5.0])
    assert [panel.get_title() for panel in _panels(picture)] == [
        "t = 0 s",
        "t = 0.1 s",
        "t = 0.2 s",
    ]


def test_a_scene_chooses_what_colours_stand_for(tmp_path, figure):
    _cloud(tmp_path / "water.vtkhdf")
    assert _bars(figure([0.1])) == ["speed [m/s]"]
    assert _bars(figure([0.1], colours=["water.pressure"])) == ["pressure [Pa]"]


def test_quantities_of_one_name_and_unit_share_a_colour_bar(tmp_path, figure):
    _cloud(tmp_path / "air.vtkhdf")
    _cloud(tmp_path / "water.vtkhdf")
    assert _bars(figure([0.1])) == ["speed [m/s]"]
    assert _bars(figure([0.1], colours=["air.pressure"])) == ["pressure [Pa]", "speed [m/s]"]


def test_faces_take_the_colour_of_their_field_only_if_the_scene_asks(tmp_path):
    _box(tmp_path / "plate.vtkhdf", stress=np.arange(6.0))
    (path,) = view_files(tmp_path)
    assert read(path, 0.0, {}).face_values is None
    view = read(path, 0.0, {"plate": "stress"})
    assert view.quantity == Quantity("stress", "Pa")
    assert view.face_values.tolist() == [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]


def test_faces_have_the_mean_of_their_corners(tmp_path):
    _box(tmp_path / "plate.vtkhdf", pressure=CORNERS[:, 0])
    (path,) = view_files(tmp_path)
    assert read(path, 0.0, {"plate": "pressure"}).face_values.tolist() == [-1.0, 1.0, 0, 0, 0, 0]


def test_what_is_in_front_of_the_region_is_cut_away(tmp_path, figure):
    _cloud(tmp_path / "water.vtkhdf", 500)
    picture = figure([0.1], region=((0.2, 0.5, 0.0), (0.8, 1.0, 0.5)))
    (panel,) = _panels(picture)
    assert panel.get_xlim() == (0.2, 0.8) and panel.get_ylim() == (0.0, 0.5)
    (points,) = [
        collection for collection in panel.collections if hasattr(collection, "get_widths")
    ]
    drawn_points = len(points.get_offsets())
    all_points = read(view_files(tmp_path)[0], 0.1, {}).points
    assert drawn_points == np.count_nonzero(all_points[:, 1] >= 0.5)
    assert "particles from y = 0.5 to 1 m" in picture.get_suptitle()


def test_a_solid_of_elements_is_cut_open_where_it_shows_a_field(tmp_path):
    slices = [0.5 * CORNERS + [0.0, y, 0.0] for y in (0.0, 1.0, 2.0)]  # three elements along y
    cells = np.concatenate([FACES + 8 * k for k in range(3)])
    file = VtkHdf(tmp_path / "block.vtkhdf", UNITS)
    file.append(0.0, {"points": np.concatenate(slices), "cells": cells, "stress": np.arange(18.0)})
    file.close()
    (path,) = view_files(tmp_path)
    depths = 0.75, 9.0
    cut = cut_and_sorted(read(path, 0.0, {"block": "stress"}), depths)
    assert min(face[:, 1].mean() for face in cut.faces) >= 0.75
    assert 0 < len(cut.faces) == len(cut.face_values) < 18
    assert len(cut_and_sorted(read(path, 0.0, {}), depths).faces) == 18  # a plain body is whole


def test_walls_are_drawn_and_do_not_shrink_what_moves(tmp_path, figure):
    _cloud(tmp_path / "water.vtkhdf")
    _walls(tmp_path / "water.walls.vtkhdf", (-9.0, 0.0, 0.0), (90.0, 1.0, 1.0), ("x-", "z-", "y+"))
    picture = figure([0.1])
    (panel,) = _panels(picture)
    lines = [
        len(collection.get_segments())
        for collection in panel.collections
        if hasattr(collection, "get_segments")
    ]
    assert lines == [2]  # the wall behind is seen from its face
    assert np.ptp(panel.get_xlim()) < 1.5
    assert "walls" in [text.get_text() for text in picture.legends[0].get_texts()]


def test_clamped_faces_have_strokes_behind_them_and_planes_of_symmetry_are_dashed(tmp_path, figure):
    _box(tmp_path / "plate.vtkhdf")
    end, axis = box((1.5, 0.0, 0.0), (1.6, 0.1, 0.1), ("x-", "z-"))
    file = VtkHdf(tmp_path / "plate.walls.vtkhdf")
    file.append(0.0, {**polygons([end, axis]), "support": np.array([CLAMPED, SYMMETRY], float)})
    file.close()
    picture = figure([0.0])
    (panel,) = _panels(picture)
    lines = [collection for collection in panel.collections if hasattr(collection, "get_segments")]
    strokes = np.concatenate(lines[-1].get_segments())
    outwards = 1.0 if end[:, 0].max() > 1.55 else -1.0
    assert ((strokes[:, 0] - end[0, 0]) * outwards >= -1e-12).all()
    labels = [text.get_text() for text in picture.legends[0].get_texts()]
    assert {"clamped", "plane of symmetry"} <= set(labels) and "walls" not in labels


def test_a_long_tank_is_no_strip(tmp_path, figure):
    file = VtkHdf(tmp_path / "water.vtkhdf", UNITS)
    random = np.random.default_rng(2)
    for k in range(6):
        points = random.random((400, 3)) * [8.0, 0.7, 0.8]
        file.append(0.1 * k, {"points": points, "velocity": points})
    file.close()
    picture = figure([0.1 * k for k in range(6)])
    picture.draw_without_rendering()
    height = _panels(picture)[0].get_window_extent().height / picture.dpi
    assert height > 1.6 and picture.get_figwidth() < 13.0 and picture.get_figheight() < 20.0
    assert re.search(r"z drawn [0-9.]+ times as long as x", picture.get_suptitle())


def test_spheres_have_their_size(tmp_path, figure):
    file = VtkHdf(tmp_path / "balls.vtkhdf", {"velocity": "m/s", "radius": "m"})
    points = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
    view = {"points": points, "velocity": points, "radius": np.array([0.1, 0.25])}
    file.append(0.0, view)
    file.close()
    (panel,) = _panels(figure([0.0]))
    (balls,) = [collection for collection in panel.collections if hasattr(collection, "get_widths")]
    assert np.allclose(np.sort(balls.get_widths()), [0.2, 0.5])
    assert panel.get_xlim()[0] < -0.1 and panel.get_xlim()[1] > 1.25


def test_times_are_those_of_steps(tmp_path):
    _cloud(tmp_path / "water.vtkhdf")
    assert moments(view_files(tmp_path), [0.04, 0.06, 0.09]) == [0.0, 0.1]


def test_snapshots_show_particles_and_bodies_in_each_panel(tmp_path):
    _cloud(tmp_path / "water.vtkhdf", 500)
    _box(tmp_path / "cube.vtkhdf")
    out = draw_run(tmp_path, tmp_path / "pictures" / "all.png", Picture([0.0, 0.11, 5.0]))
    image = _image(out)
    solid = (image[..., RED] - image[..., BLUE] > 0.15) & (image[..., RED] < 0.85)
    columns = np.flatnonzero(solid.any(axis=0))
    assert solid.sum() > 1000  # the box, in its own colour
    assert np.count_nonzero(np.diff(columns) > 50) >= 1  # in several panels
    assert (image.max(axis=2) - image.min(axis=2) > 0.2).sum() > 2000


def test_a_picture_of_a_time_beyond_the_end_shows_the_last_state(tmp_path, monkeypatch, capsys):
    path = write_scene(tmp_path, end=0.01, ping="seen = true")
    drawings = []
    monkeypatch.setattr(
        results, "draw_run", lambda run, _, picture, *__: drawings.append((run, picture.times))
    )
    with pytest.raises(SystemExit) as exit_info:
        main(
            [
                "run",
                str(path),
                "--set",
                "output.pictures=[0.0, 2.8, 3.0]",
                "--out",
                f"{tmp_path}/out",
            ]
        )
    assert exit_info.value.code == 0
    ((run, times),) = drawings
    assert moments(view_files(run), times) == [0.0, 0.01], "the start, and the last state once"
    messages = [line for line in capsys.readouterr().err.splitlines() if "pictures" in line]
    assert len(messages) == 1, "it is told in one line"
    assert "t = 2.8, 3 s lie beyond the run's end: its last state, at 0.01 s," in messages[0]


@pytest.mark.parametrize("content", ["cloud", "box", "point"])
def test_snapshots_need_neither_particles_nor_bodies(tmp_path, content):
    if content == "box":
        _box(tmp_path / "a.vtkhdf")
    else:
        _cloud(tmp_path / "a.vtkhdf", 40 if content == "cloud" else 1, speed=0.0)
    assert draw_run(tmp_path, tmp_path / "a.png", Picture([0.1])).stat().st_size > 1000


def test_snapshots_of_many_particles_are_quick(tmp_path):
    _cloud(tmp_path / "water.vtkhdf", 200_000)
    begin = time.process_time()
    draw_run(tmp_path, tmp_path / "a.png", Picture([0.2]))
    assert time.process_time() - begin < 12.0


def test_a_picture_of_nothing_is_refused(tmp_path):
    with pytest.raises(SceneError, match=r"needs a \.vtkhdf file with steps"):
        draw_run(tmp_path, tmp_path / "a.png", Picture([0.0]))
