"""Content of pictures: texts within the figure, fitting units, profiles, walls."""

import numpy as np
import pytest

from quintet.coupler.files.recording import Instant, Recorder, Recording
from quintet.coupler.files.vtkhdf import VtkHdf
from quintet.coupler.measures.evaluation import evaluate
from quintet.coupler.measures.expectation import Expectation
from quintet.coupler.report import comparison as comparing
from quintet.coupler.report import picture as drawing
from quintet.coupler.report.axes_units import prefix_for, with_unit
from quintet.coupler.report.picture import Picture, draw_run
from quintet.coupler.report.profiles import profiles_of
from quintet.interfaces.ports import MOTION


@pytest.fixture
def figures(monkeypatch):
    """The drawn figures of matplotlib."""
    drawn_figures = []
    for module in (comparing, drawing):
        save = module.save
        monkeypatch.setattr(
            module,
            "save",
            lambda figure, out, save=save: drawn_figures.append(figure) or save(figure, out),
        )
    return drawn_figures


def _texts_within(figure):
    """Whether all titles, labels and legends lie within the figure."""
    figure.draw_without_rendering()
    renderer = figure.canvas.get_renderer()
    edge = figure.bbox
    for panel in figure.axes:
        for text in (panel.title, panel.xaxis.label, panel.yaxis.label):
            box = text.get_window_extent(renderer)
            inside = box.x0 >= edge.x0 and box.x1 <= edge.x1 and box.y1 <= edge.y1
            assert inside, f"{text.get_text()!r} runs off the edge"


def _record(folder, step):
    with Recorder(folder / "recording.h5", "", "") as recorder:
        recorder.component("cubes", (MOTION,), {})
        for k in range(20):
            row = {"motion.position": np.array([[0.02 * k, 0.0, 0.0]])}
            recorder.add("cubes", Instant(step * k, k), row)


@pytest.mark.parametrize(
    "name", ["end", "the way of the upper mass at the end of the run, in the frame of the scene"]
)
def test_titles_of_a_comparison_stay_within_the_figure(tmp_path, figures, name):
    _record(tmp_path, 0.02)
    common = {"component": "cubes", "field": "motion.position", "unit": "m", "source": "s"}
    expectations = [
        Expectation(
            name=f"{name} {axis}", measure="at", begin=0.2, value=0.123456, within=1.234e-5,
            axis=axis, **common,
        )
        for axis in (0, 1, 2)
    ]  # fmt: skip
    with Recording(tmp_path) as recording:
        outcomes = [evaluate(expectation, recording, tmp_path) for expectation in expectations]
        out = tmp_path / "c.png"
        comparing.comparison(tmp_path, expectations, outcomes, recording, out, values=True)
    _texts_within(figures[0])


def test_times_of_microseconds_are_written_as_such(tmp_path, figures):
    _record(tmp_path, 1e-7)
    expectation = Expectation(
        name="x", component="cubes", field="motion.position", axis=0, unit="m", source="s",
        measure="at", begin=1e-6, value=0.2, within=0.1,
    )  # fmt: skip
    with Recording(tmp_path) as recording:
        outcomes = [evaluate(expectation, recording, tmp_path)]
        comparing.comparison(
            tmp_path, [expectation], outcomes, recording, tmp_path / "c.png", values=True
        )
    (panel,) = figures[0].axes
    assert panel.get_xlabel() == "t [µs]"
    panel.set_xticks([0.0, 1e-6])
    figures[0].draw_without_rendering()
    assert [text.get_text() for text in panel.get_xticklabels()] == ["0", "1"]
    assert panel.get_ylabel() == "position x of cubes [m]"


def test_a_prefix_is_that_with_which_a_number_has_few_zeros():
    assert [prefix_for(x)[1] for x in (3.0, 0.1, 0.04, 1e-4, 8e-5, 0.0)] == [
        "", "", "m", "m", "µ", ""
    ]  # fmt: skip
    assert with_unit(1.2e-4, "s") == "0.12 ms" and with_unit(0.5, "m") == "0.5 m"
    assert with_unit(0.004, "kg") == "0.004 kg", "only lengths and times take one"


def test_small_bodies_are_drawn_in_mm(tmp_path, figures):
    file = VtkHdf(tmp_path / "ball.vtkhdf", {"velocity": "m/s"})
    centre = np.array([[0.01, 0.0, 0.02]])
    file.append(2e-5, {"points": centre, "velocity": centre, "radius": np.array([0.005])})
    file.close()
    draw_run(tmp_path, tmp_path / "a.png", Picture([2e-5]))
    panel = next(panel for panel in figures[0].axes if panel.get_title())
    assert (panel.get_xlabel(), panel.get_ylabel()) == ("x [mm]", "z [mm]")
    assert panel.get_title() == "t = 20 µs"
    assert panel.get_xlim()[0] < 0.005 and panel.get_xlim()[1] > 0.015, "the data stay in m"


def test_a_profile_stands_beside_the_exact_one(tmp_path, figures):
    units = {"density": "kg/m3", "exact_density": "kg/m3", "pressure": "Pa"}
    file = VtkHdf(tmp_path / "gas.vtkhdf", units)
    points = np.array([[0.9, 0.0, 0.0], [0.1, 0.0, 0.05], [0.5, 0.0, 0.0]])
    density = np.array([3.0, 1.0, 2.0])
    for time in (0.0, 0.2):
        fields = {"density": density, "exact_density": density + time, "pressure": density}
        file.append(time, {"points": points, **fields})
    file.close()
    (profile,) = profiles_of(tmp_path)
    assert (profile.component, profile.field, profile.axis) == ("gas", "density", 0)
    _record(tmp_path, 0.02)
    with Recording(tmp_path) as recording:
        out = tmp_path / "c.png"
        comparing.comparison(tmp_path, [], [], recording, out, profiles=[profile])
    (panel,) = figures[0].axes
    exact, computed = panel.lines
    np.testing.assert_allclose(exact.get_xydata(), [[0.1, 1.2], [0.5, 2.2], [0.9, 3.2]], rtol=1e-6)
    np.testing.assert_allclose(computed.get_ydata(), [1.0, 2.0, 3.0])
    assert panel.get_title() == "density of gas at t = 0.2 s"
    assert panel.get_ylabel() == "density [kg/m3]"
