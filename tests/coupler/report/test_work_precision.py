"""Content of a work-precision diagram."""

import pytest
from matplotlib.figure import Figure

from quintet.coupler.measures.convergence import as_table, observed_order
from quintet.coupler.report import work_precision
from quintet.coupler.report.work_precision import draw, pareto_front


def row(label, cpu, errors, met=True, kind="spacing", size=None):
    ladders = [kind] if size else []
    return {
        "label": label, "status": "done", "cpu": cpu, "errors": errors, "met": met, "kind": kind,
        "ladders": ladders, "sizes": {kind: size}, "within": dict.fromkeys(errors, 1e-2),
        "units": dict.fromkeys(errors, "m"),
    }  # fmt: skip


def test_the_front_holds_what_no_other_point_beats():
    costs, errors = [1.0, 2.0, 3.0, 2.0, 4.0], [0.5, 0.2, 0.3, 0.1, 0.1]
    assert pareto_front(costs, errors) == [0, 3]
    assert pareto_front([2.0], [1.0]) == [0] and pareto_front([], []) == []


@pytest.fixture
def draw_rows(monkeypatch, tmp_path):
    """Draw rows; return the figure before it is written."""
    figures = []

    def keep(figure, out):
        figure.canvas.draw()
        figures.append(figure)
        return out

    def make(rows, name="study", **keys):
        names = list(rows[0]["errors"])
        sized_rows = [row for row in rows if row["ladders"]]
        orders = {}
        for expected in names:
            pairs = [(row["sizes"]["spacing"], row["errors"][expected]) for row in sized_rows]
            orders[expected] = as_table(observed_order(*zip(*pairs, strict=True)))
        kinds = {"spacing": {"orders": orders}} if sized_rows else {}
        summary = {"scene": name, "rows": rows, "kinds": kinds, **keys}
        assert draw(summary, tmp_path / "study.png")
        return figures[-1]

    monkeypatch.setattr(work_precision, "save", keep)
    return make


def test_it_has_a_legend_a_front_and_triangles_with_their_slope(draw_rows):
    ladder = [row(f"{h} m", h**-2, {"end": h**3}, h < 0.2, size=h) for h in (0.4, 0.2, 0.1)]
    figure = draw_rows([*ladder, row("other", 50.0, {"end": 0.1}, None, "model")])
    (legend,) = figure.legends
    words = {text.get_text() for text in legend.get_texts()}
    assert {"spacing, all met", "spacing, not all met", "model", "Pareto front"} <= words
    assert {"within", "slope of spacing over time"} <= words
    (panel,) = figure.axes
    assert panel.get_xscale() == panel.get_yscale() == "log"
    assert "-1.5" in {text.get_text() for text in panel.texts}  # h³ over h⁻²
    assert "spacing: order 3.00" in panel.get_title()
    (front,) = (line for line in panel.lines if line.get_label() == "Pareto front")
    assert len(front.get_xdata()) == 3


def test_other_programs_have_marks_of_their_own_beside_the_front(draw_rows):
    ladder = [row(f"{h} m", h**-2, {"end": h**2, "b": h}, size=h) for h in (0.4, 0.2, 0.1)]
    runs = [row(f"{n} cells", 0.1 * n, {"end": 1.0 / n}, n > 10) for n in (10, 20, 40)]
    for run, series in zip(runs, ("", "", "fine"), strict=True):
        run["series"] = series
    peers = [{"program": "Toy", "version": "7.1", "cost": "wall", "rows": runs}]
    figure = draw_rows(ladder, peers=peers)
    first, second = figure.axes
    points = [line for line in first.lines if line.get_marker() in ("s", "D")]
    places = [(line.get_xdata()[0], line.get_ydata()[0]) for line in points]
    assert places == [(1.0, 0.1), (2.0, 0.05), (4.0, 0.025)]
    assert [line.get_fillstyle() for line in points] == ["none", "full", "full"]
    assert [line.get_marker() for line in points] == ["s", "s", "D"]
    words = [text.get_text() for text in figure.legends[0].get_texts()]
    assert {"Toy 7.1, wall time, time steps", "Toy 7.1, fine, wall time, time steps"} <= set(words)
    (front,) = (line for line in first.lines if line.get_label() == "Pareto front")
    assert len(front.get_xdata()) == 3  # of the refinements alone
    assert not [line for line in second.lines if line.get_marker() == "s"]


def test_no_title_runs_off(draw_rows):
    quantity = "pressure on the wall behind the column, half way up, " * 4
    rows = [row(f"{h} m", h**-2, {quantity: h**3, "b": h}, size=h) for h in (0.4, 0.2, 0.1)]
    figure = draw_rows(rows, "a_scene_with_a_name_that_is_as_long_as_it_can_be_" * 4)
    assert isinstance(figure, Figure)
    renderer, figure_box = figure.canvas.get_renderer(), figure.bbox
    for text in (figure._suptitle, *(panel.title for panel in figure.axes)):
        box = text.get_window_extent(renderer)
        assert box.x0 >= figure_box.x0 and box.x1 <= figure_box.x1 and box.y1 <= figure_box.y1, text
    left, right = (panel.title.get_window_extent(renderer) for panel in figure.axes)
    assert left.x1 < right.x0


def test_without_errors_nothing_is_drawn(tmp_path):
    rows = [row("a", 1.0, {})]
    assert draw({"scene": "x", "rows": rows, "kinds": {}}, tmp_path / "study.png") is None
