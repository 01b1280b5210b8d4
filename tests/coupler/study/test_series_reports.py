"""The page of a series has its tables and pictures, and needs no other file."""

import base64
import html
import io
import re
import shlex

import pytest
from PIL import Image
from spring_scene import command, write

from quintet.coupler.report.series_report import PARTS
from quintet.coupler.report.sweep_report import draw
from quintet.coupler.scene.sweep_axes import axes_of, combinations

STEP = "components.spring.step"
STUDY = "".join(
    f'[[study]]\nlabel = "{step}"\nsettings = {{ "{STEP}" = {step} }}\nsize = "{STEP}"\n'
    for step in (0.02, 0.01)
)
LIMIT = f'''
[[stability]]
parameter = "{STEP}"
from = 0.15
to = 0.25
accuracy = 0.5
end = 12.0
bounds = [{{ component = "spring", field = "motion.position", low = -1.5, high = 1.5 }}]
against = {{ parameter = "components.spring.mass", values = [1.0, 2.0] }}
'''
STIFFNESS = """
[ensemble.stiffness]
keys = ["components.spring.stiffness"]
uniform = [95.0, 105.0]
source = "a spring as bought"
"""
CASES = {
    "study": ((), ["2 of 2 runs done", "The cheapest refinement", "Observed orders", "CPU [s]"]),
    "sweep": (("--over", f"{STEP}=0.02,0.01"), ["2 of 2 runs done", STEP, "done, met"]),
    "ensemble": (("--runs", "3"), ["3 of 3 runs done", "What is uncertain", "stiffness"]),
    "calibrate": (
        ("--over", "components.spring.stiffness=90.0:110.0", "--to", "end", "--runs", "3"),
        ["3 of 3 runs done", "What fits best"],
    ),
    "stability": ((), ["limits found", "Limits", "bounds"]),
}


@pytest.mark.parametrize("kind", CASES)
def test_a_series_has_a_page(tmp_path, capsys, kind):
    arguments, words = CASES[kind]
    out = tmp_path / "all"
    path = write(tmp_path, STUDY + LIMIT + STIFFNESS, within=0.5)
    command(kind, path, "--out", out, *arguments)
    assert command("report", out) == 0, capsys.readouterr().err
    page = (out / "report.html").read_text()
    words_of_command = shlex.split(html.unescape(re.search("<pre>(.*)</pre>", page)[1]))
    assert words_of_command[:3] == ["quintet", kind, str(path)]
    assert list(arguments) == [word for word in words_of_command if word in arguments]
    assert not [word for word in words if word not in page]
    images = re.findall(r'src="data:image/png;base64,([^"]+)"', page)
    assert len(images) == 1
    assert Image.open(io.BytesIO(base64.b64decode(images[0]))).size[0] > 400
    assert "<script" not in page and "http" not in page and "None" not in page


def test_a_series_that_has_not_ended_says_so(tmp_path, capsys):
    out = tmp_path / "all"
    command("study", write(tmp_path, STUDY), "--out", out)
    (out / "study.json").unlink()
    assert command("report", out) == 2
    assert "this study has no study.json yet. Go on with it" in capsys.readouterr().err


def test_curves_of_a_sweep_over_keys_of_one_name_are_told_apart(tmp_path, monkeypatch):
    figures = []
    monkeypatch.setattr(
        "quintet.coupler.report.sweep_report.save", lambda figure, out: figures.append(figure)
    )
    axes = axes_of({"components.a.mass": [1.0, 2.0], "components.b.mass": [3.0, 4.0]})
    rows = [
        {"settings": s, "values": {"x": 1.0}, "units": {"x": "m"}, "status": "done"}
        for s in combinations(axes)
    ]
    draw(axes, rows, tmp_path / "a.png")
    words = [word.get_text() for word in figures[0].axes[0].get_legend().get_texts()]
    assert words == ["components.b.mass = 3.0", "components.b.mass = 4.0"]


def test_the_page_of_a_long_sweep_says_that_its_table_is_cut():
    row = {"settings": {"end": 1.0}, "values": {}, "units": {}, "status": "done", "met": True}
    row |= {"wall": 1.0, "cpu": 1.0, "run": "a"}
    content = {"over": {"end": [1.0]}, "rows": [row] * 61}
    (part,) = PARTS["sweep"](content)
    assert len(part.table.rows) == 60
    assert part.sentences == ["the first 60 of 61 runs; all are in sweep.csv"]
