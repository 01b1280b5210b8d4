"""Computed curves are drawn against their expectations, one panel for each curve."""

from dataclasses import replace

import numpy as np
import pytest

from quintet.coupler.files.recording import Instant, Recorder, Recording
from quintet.coupler.measures.evaluation import evaluate
from quintet.coupler.measures.expectation import Expectation
from quintet.coupler.report import comparison as drawing
from quintet.coupler.report.comparison import comparison
from quintet.coupler.report.panels import save
from quintet.coupler.scene.read import load
from quintet.interfaces.ports import MOTION

COMMON = {
    "component": "cubes", "field": "motion.position", "axis": 0, "unit": "m", "source": "s"
}  # fmt: skip
X_RMS = Expectation(name="x [rms]", measure="rms", csv="ref.csv", within=0.1, **COMMON)
X_PASSES = Expectation(
    name="x_$1", measure="crossing", csv="ref.csv", level=0.3, within=1, **{**COMMON, "unit": "s"}
)
TOP = Expectation(name="top", measure="max", value=1.0, within=0.1, **{**COMMON, "offset": 0.5})
END = Expectation(name="end", measure="at", begin=0.9, value=0.9, within=0.1, **COMMON)


@pytest.fixture
def figure(monkeypatch, tmp_path):
    with Recorder(tmp_path / "recording.h5", "", "") as recorder:
        recorder.component("cubes", (MOTION,), {})
        for k in range(50):
            row = {"motion.position": np.array([[0.02 * k, 0.0, 0.0]])}
            recorder.add("cubes", Instant(0.02 * k, k), row)
    (tmp_path / "ref.csv").write_text("t,x\n0,0\n0.5,0.52\n0.9,0.9\n")
    figures = []

    def draw(*expectations, **options):
        monkeypatch.setattr(drawing, "save", lambda figure, out: figures.append(figure) or out)
        with Recording(tmp_path) as recording:
            outcomes = [evaluate(expectation, recording, tmp_path) for expectation in expectations]
            out = tmp_path / "c.png"
            is_drawn = comparison(tmp_path, expectations, outcomes, recording, out, **options)
        return figures[-1] if is_drawn else None

    return draw


def test_expectations_of_one_curve_share_a_panel(figure):
    (panel,) = figure(X_RMS, X_PASSES, title="a scene").axes
    text = panel.get_title()
    assert "x [rms]: RMS distance" in text and "x_$1: passes 0.3 at 0.3, expected" in text
    computed, reference = panel.get_lines()[:2]
    assert len(computed.get_xdata()) == 50 and len(reference.get_xdata()) == 3


@pytest.mark.parametrize("preset", ["quick", "standard"])
def test_curves_of_the_main_job_have_one_panel_each(preset):
    scene = load("dam_break_cubes", preset)
    assert sum(expectation.csv is not None for expectation in scene.expect) == 2
    assert (
        len(
            {
                drawing._curve_of(expectation)
                for expectation in scene.expect
                if expectation.csv is not None
            }
        )
        == 1
    )


def test_curves_have_axes_with_names_and_units(figure):
    picture = figure(X_RMS, TOP, title="a scene", values=True)
    assert picture.get_suptitle() == "a scene"
    assert [panel.get_xlabel() for panel in picture.axes] == ["t [s]", "t [s]"]
    names = [panel.get_ylabel() for panel in picture.axes]
    assert names == ["position x of cubes [m]", "position x of cubes, plus 0.5 m [m]"]


def test_a_curve_is_called_what_the_scene_calls_it(figure):
    named = replace(END, quantity="way of the cube")
    (panel,) = figure(X_RMS, named, values=True).axes
    assert panel.get_ylabel() == "way of the cube [m]"


def test_a_scaled_curve_has_the_unit_of_what_is_measured(figure):
    """Of an amplitude that is the curve's; where no measure has it, the scale is written out."""
    keys = {**COMMON, "scale": 2.5, "quantity": "heave over wave amplitude", "unit": "1"}
    swing = Expectation(name="a", measure="amplitude", period=0.5, value=0.0, within=9, **keys)
    (panel,) = figure(swing, values=True).axes
    assert panel.get_ylabel() == "heave over wave amplitude [1]"
    time = {**keys, "unit": "s"}
    passes = Expectation(name="t", measure="crossing", level=1.0, value=0.4, within=1, **time)
    (panel,) = figure(passes, values=True).axes
    assert " ".join(panel.get_ylabel().split()) == "2.5 × (position x of cubes in m) [1]"


def test_dollar_signs_are_no_mathematics(figure, tmp_path, monkeypatch):
    """Mathematics that matplotlib cannot read would end a run in an error."""
    priced = replace(END, name="$5_{ to $6", source="$\\SI{5}{m}$", quantity="way $\\frac$")
    picture = figure(priced, values=True, title="a $\\foo$ scene")
    assert save(picture, tmp_path / "c.png").stat().st_size > 1000


def test_a_title_says_how_much_of_the_tolerance_is_used_up(figure):
    (panel,) = figure(END, values=True).axes
    title = " ".join(panel.get_title().split())
    assert title.endswith("met, 0% of the tolerance used up")


def test_an_expected_oscillation_has_the_computed_phase(tmp_path, monkeypatch):
    times = np.linspace(0.0, 4.0, 401)
    with Recorder(tmp_path / "recording.h5", "", "") as recorder:
        recorder.component("cubes", (MOTION,), {})
        for k, t in enumerate(times):
            place = 0.3 + 0.1 * np.exp(-0.2 * t) * np.sin(5.0 * t)
            recorder.add("cubes", Instant(t, k), {"motion.position": np.array([[place, 0.0, 0.0]])})
    period = Expectation(name="period", measure="period", value=1.3, within=1.0, **COMMON)
    figures = []
    monkeypatch.setattr(drawing, "save", lambda figure, out: figures.append(figure) or out)
    with Recording(tmp_path) as recording:
        outcomes = [evaluate(period, recording, tmp_path)]
        comparison(tmp_path, [period], outcomes, recording, tmp_path / "c.png", values=True)
    line = figures[0].axes[0].get_lines()[1]
    assert line.get_label() == "as fitted to it, but with the expected period"
    t, x = line.get_data()
    expected = 0.3 + 0.1 * np.exp(-0.2 * t) * np.sin(2.0 * np.pi / 1.3 * t)
    assert x == pytest.approx(expected, abs=1e-6)


def test_single_values_are_drawn_where_the_scene_wants_pictures(figure):
    assert figure(TOP, END) is None
    band, point = figure(TOP, END, values=True).axes
    assert band.get_lines()[1].get_ydata().tolist() == [1.0, 1.0]
    assert not np.any([line.get_label() == "its mean" for line in band.get_lines()])
    assert point.get_lines()[1].get_xydata().tolist() == [[0.9, 0.9]]


def test_a_curve_with_a_reference_file_and_a_value_has_both(figure):
    (panel,) = figure(X_RMS, END, values=True).axes
    labels = [text.get_text() for text in panel.get_legend().get_texts()]
    assert labels == ["computed", "s", "expected: s"]


def test_a_run_that_ended_early_says_which_time_it_did_not_reach(figure):
    expectation = Expectation(name="late", measure="at", begin=3.0, value=1.0, within=0.1, **COMMON)
    (panel,) = figure(expectation, values=True).axes
    assert panel.get_title() == "late: at 3 s: not reached (t = 3 s)"
