"""A run is drawn again from its files: times, fields, ranges, views and sections."""

import numpy as np
import pytest

from quintet.components.shared.geometry.box_faces import CORNERS, FACES
from quintet.coupler.cli import main
from quintet.coupler.files.vtkhdf import VtkHdf
from quintet.coupler.report import picture as drawing
from quintet.coupler.report import three_views
from quintet.coupler.report.cut import depth_of_bodies
from quintet.coupler.report.picture import Picture, draw_run
from quintet.coupler.report.view_drawing import _range
from quintet.coupler.report.view_steps import read, view_files
from quintet.coupler.report.viewpoint import VIEWPOINTS

UNITS = {"velocity": "m/s", "pressure": "Pa"}
POINTS = np.random.default_rng(2).random((2000, 3)) * [1.0, 0.5, 0.4]  # m, a block of water


@pytest.fixture
def folder(tmp_path):
    """Folder of a run with water and a ball of 0.1 m in its middle, at 0, 0.1 and 0.2 s."""
    water, ball = VtkHdf(tmp_path / "water.vtkhdf", UNITS), VtkHdf(tmp_path / "ball.vtkhdf", UNITS)
    centre = np.array([[0.5, 0.25, 0.2]])
    for k in range(3):
        pressure = 1000.0 * POINTS[:, 2]
        water.append(0.1 * k, {"points": POINTS, "velocity": POINTS, "pressure": pressure})
        ball.append(0.1 * k, {"points": centre, "velocity": centre, "radius": np.array([0.1])})
    water.close()
    ball.close()
    return tmp_path


@pytest.fixture
def drawn_figures(monkeypatch):
    """The drawn figures of matplotlib."""
    figures = []
    save = drawing.save
    monkeypatch.setattr(
        drawing, "save", lambda figure, out: figures.append(figure) or save(figure, out)
    )
    return figures


def _command(*arguments):
    with pytest.raises(SystemExit) as exit_info:
        main(["draw", *map(str, arguments)])
    return exit_info.value.code


def _panels(figure):
    return [panel for panel in figure.axes if panel.get_xlabel()]


def _circles(panel):
    return [part for part in panel.collections if hasattr(part, "get_widths")]


def test_a_ball_under_water_is_seen(folder, drawn_figures):
    draw_run(folder, folder / "a.png", Picture([0.1]))
    (panel,) = _panels(drawn_figures[0])
    ball, water = sorted(_circles(panel), key=lambda part: len(part.get_offsets()))
    order = panel.collections.index
    assert order(ball) > order(water), "bodies are drawn after particles"
    assert len(water.get_offsets()) == np.count_nonzero(POINTS[:, 1] >= 0.25)
    assert "particles in front of y = 0.25 m left out" in drawn_figures[0].get_suptitle()


def test_titles_of_three_views_fit_above_narrow_panels(folder, monkeypatch):
    figures = []
    monkeypatch.setattr(three_views, "save", lambda figure, out: figures.append(figure))
    three_views.draw_three_views(folder, folder / "a.png")
    titles = [panel.get_title() for panel in _panels(figures[0])]
    assert titles[0] == "side view\nparticles in front of y\n= 0.25 m left out"
    assert max(len(line) for title in titles for line in title.split("\n")) <= 24


def test_a_point_in_front_of_the_middle_stays(folder):
    """A buoy before the ball, which water in front of would hide: it hides nothing itself."""
    buoy = VtkHdf(folder / "buoy.vtkhdf", UNITS)
    buoy.append(0.0, {"points": np.array([[0.5, 0.01, 0.4]]), "velocity": np.ones((1, 3))})
    buoy.close()
    _, ((_, shown, water),) = drawing.turned_views(view_files(folder), [0.0], Picture([0.0]))
    assert shown.name == "buoy" and len(shown.points) == 1
    assert 0 < len(water.points) < len(POINTS)


def test_a_few_values_among_equal_ones_have_colours():
    """As the plastic strain of a strike: the bar would end at 1 otherwise, whatever they are."""
    strain = np.r_[np.zeros(2000), 0.05]
    assert _range(strain) == (0.0, 0.05)
    assert _range(np.zeros(2000)) == (0.0, 1.0)


def test_nothing_is_left_out_where_particles_hide_no_body(folder, drawn_figures):
    (folder / "ball.vtkhdf").unlink()
    draw_run(folder, folder / "a.png", Picture([0.1]))
    (panel,) = _panels(drawn_figures[0])
    assert len(_circles(panel)[0].get_offsets()) == len(POINTS)
    assert "left out" not in drawn_figures[0].get_suptitle()


def test_a_box_hides_nothing_of_particles_in_one_plane(tmp_path):
    file = VtkHdf(tmp_path / "box.vtkhdf", UNITS)
    file.append(0.0, {"points": 0.1 * CORNERS, "cells": FACES})
    file.close()
    file = VtkHdf(tmp_path / "water.vtkhdf", UNITS)
    file.append(0.0, {"points": POINTS * [1.0, 0.0, 1.0], "velocity": POINTS})
    file.close()
    view = [read(tmp_path / f"{name}.vtkhdf", 0.0, {}) for name in ("box", "water")]
    assert depth_of_bodies(view) is None
    deep = [view[0], read(tmp_path / "box.vtkhdf", 0.0, {})]
    assert depth_of_bodies(deep) is None, "bodies alone hide nothing"
    empty = VtkHdf(tmp_path / "spray.vtkhdf", UNITS)
    empty.append(0.0, {"points": np.zeros((0, 3)), "velocity": np.zeros((0, 3))})
    empty.close()
    spray = read(tmp_path / "spray.vtkhdf", 0.0, {})
    assert depth_of_bodies([view[0], spray]) is None, "nothing hides nothing"


@pytest.mark.parametrize(
    "view, names, right, into",
    [
        ("side", ("x", "z"), [1, 0, 0], [0, 1, 0]),
        ("front", ("y", "z"), [0, 1, 0], [-1, 0, 0]),
        ("top", ("x", "y"), [1, 0, 0], [0, 0, -1]),
    ],
)
def test_views_are_not_mirrored(view, names, right, into):
    viewpoint = VIEWPOINTS[view]
    assert viewpoint.names == names
    assert viewpoint.turned(np.array(right, float)).tolist() == [1.0, 0.0, 0.0]
    assert viewpoint.turned(np.array(into, float)).tolist() == [0.0, 1.0, 0.0]
    turn = viewpoint.turned(np.eye(3))
    assert np.linalg.det(turn) == pytest.approx(1.0), "a turn, no mirror"


def test_a_section_is_a_coordinate_of_the_scene(folder, drawn_figures):
    assert _command(folder, "--view", "front", "--section", "0.75", "--times", "0.1") == 0
    (panel,) = _panels(drawn_figures[0])
    water = max(_circles(panel), key=lambda part: len(part.get_offsets()))
    assert len(water.get_offsets()) == np.count_nonzero(POINTS[:, 0] <= 0.75), (
        "one looks against x: what is in front has a larger x"
    )
    assert "front view against x, cut open at x = 0.75 m" in drawn_figures[0].get_suptitle()


def test_the_command_chooses_times_colours_and_their_range(folder, drawn_figures):
    arguments = ("--times", "0,0.2", "--colour", "water.pressure", "--range", "water=100,300")
    assert _command(folder, *arguments) == 0
    assert (folder / "drawn.png").stat().st_size > 1000
    (figure,) = drawn_figures
    assert [panel.get_title() for panel in _panels(figure)] == ["t = 0 s", "t = 0.2 s"]
    bars = {bar.get_ylabel(): bar.get_ylim() for bar in figure.axes if not bar.get_xlabel()}
    ((label, ends),) = [item for item in bars.items() if "pressure" in item[0]]
    assert ends == (100.0, 300.0)
    assert label.startswith("pressure [Pa]") and "beyond" in label


def test_the_picture_at_the_end_is_drawn_though_the_last_step_is_rounded(tmp_path, drawn_figures):
    ball = VtkHdf(tmp_path / "ball.vtkhdf", UNITS)
    for time in (0.0, 0.051 / 3 * 3):
        ball.append(time, {"points": POINTS[:1], "velocity": POINTS[:1]})
    ball.close()
    assert 0.051 / 3 * 3 < 0.051
    (tmp_path / "scene.toml").write_text("[output]\npictures = [0.0, 0.051]\n")
    assert _command(tmp_path) == 0
    assert len(_panels(drawn_figures[0])) == 2


def test_a_region_may_be_given_by_any_two_opposite_corners(folder, drawn_figures):
    assert _command(folder, "--region", "0.8", "0.5", "0.3", "0.2", "0.1", "0.0") == 0
    (panel,) = _panels(drawn_figures[0])
    assert panel.get_xlim() == (0.2, 0.8) and panel.get_ylim() == (0.0, 0.3)
    assert panel.get_title() == "t = 0.2 s", "the last state, where the scene names no time"


def test_another_file_is_not_replaced_without_force(folder, capsys):
    picture = folder / "mine.png"
    picture.write_text("mine")
    assert _command(folder, "--out", picture) == 2
    assert "it exists. Name another file, or use --force." in capsys.readouterr().err
    assert picture.read_text() == "mine"
    assert _command(folder, "--out", picture, "--force") == 0
    assert picture.stat().st_size > 1000


@pytest.mark.parametrize(
    "arguments, message",
    [
        (["--colour", "water.presure"], "field presure is not known. Did you mean pressure?"),
        (["--colour", "sea.pressure"], "component sea is not known. Known here: ball, water."),
        (["--range", "sea=1,2"], "component sea is not known"),
        (["--out", "a.txt"], "it must end with one of .png, .svg, .pdf, .jpg; found .txt"),
        (["--displacement-scale", "5"], "none of ball, water does. Remove it."),
        (["--region", *"000011"], "a region must extend along both"),
        (["--region", *"000", "0.001", "1", "9"], "found 0.001 and 9 m. Choose another region"),
        (["--out", "file/a.png"], "--out file/a.png: it must lie in a folder; file is none"),
        (["--out", "folder.png", "--force"], "it must be a file; found a folder"),
        (["--series", "--times", "0.1", "--3d"], "for which --times, --3d says nothing"),
        (["--series", "--view", "top", "--range", "ball=0,1"], "--range, --view says nothing"),
    ],
)
def test_mistakes_are_told(folder, arguments, message, capsys, monkeypatch):
    monkeypatch.chdir(folder)
    (folder / "file").write_text("")
    (folder / "folder.png").mkdir()
    assert _command(folder, *arguments) == 2
    assert message in capsys.readouterr().err


@pytest.mark.parametrize("text", ["water=2,1", "water=1", "water", "water=a,b"])
def test_a_range_has_two_ends(folder, text, capsys):
    assert _command(folder, "--range", text) == 2
    assert "--range" in capsys.readouterr().err


def test_a_range_of_what_has_no_colours_is_refused(tmp_path, capsys):
    box = VtkHdf(tmp_path / "box.vtkhdf", UNITS)
    box.append(0.0, {"points": CORNERS, "velocity": CORNERS, "cells": FACES})
    box.close()
    assert _command(tmp_path, "--range", "box=0,1") == 2
    assert "Choose them by --colour box.FIELD." in capsys.readouterr().err
    assert _command(tmp_path, "--range", "box=0,1", "--colour", "box.velocity") == 0


def test_a_folder_without_views_is_refused(tmp_path, capsys):
    assert _command(tmp_path) == 2
    assert "no view with steps to draw" in capsys.readouterr().err
