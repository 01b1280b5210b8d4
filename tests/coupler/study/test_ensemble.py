"""Ensembles and calibrations of a spring, whose answer is cos(√(k/m) t)."""

import csv
import json
import math
from collections import Counter

import numpy as np
import pytest
from spring_scene import CURVE, command, command_json, write

import quintet
from quintet.coupler.scene.ensemble_table import draw_settings
from quintet.coupler.scene.key_ranges import ranges_of
from quintet.coupler.scene.read import load_variants
from quintet.coupler.study.calibrate import _rounded
from quintet.coupler.study.ensemble import scatter_of
from quintet.interfaces import libraries
from quintet.interfaces.errors import SceneError

STIFFNESS, MASS = "components.spring.stiffness", "components.spring.mass"
ENSEMBLE = f"""
[ensemble.stiffness]
keys = ["{STIFFNESS}"]
normal = [100.0, 4.0]
[ensemble.mass]
keys = ["{MASS}"]
uniform = [-0.02, 0.02]
added = true
"""


def write_all(folder, tables=ENSEMBLE):
    times = np.linspace(0.0, 1.0, 21)
    rows = [f"{t},{math.cos(10.0 * t)}" for t in times]
    (folder / "cosine.csv").write_text("\n".join(["t_s,x_m", *rows]))
    return write(folder, CURVE + tables)


def starts(folder):
    """How often each run was started."""
    lines = [line.split() for line in (folder / "sweep.log").read_text().splitlines()]
    return Counter(run for _, run, event in lines if event in ("started", "resumed"))


def test_runs_are_drawn_from_the_seed_and_their_own_number(tmp_path):
    _, variants = load_variants(str(write_all(tmp_path)))
    first, longer = (draw_settings(variants.ensemble, 3, runs) for runs in (4, 9))
    assert longer[:4] == first and draw_settings(variants.ensemble, 4, 4) != first
    draws = draw_settings(variants.ensemble, 0, 4000)
    stiffness, mass = (np.array([run[key] for run in draws]) for key in (STIFFNESS, MASS))
    assert stiffness.mean() == pytest.approx(100.0, abs=0.2)
    assert stiffness.std() == pytest.approx(4.0, rel=0.05)
    assert 0.98 <= mass.min() < 0.981 and 1.019 < mass.max() <= 1.02
    assert abs(np.corrcoef(stiffness, mass)[0, 1]) < 0.05


@pytest.mark.slow
def test_an_ensemble_reports_the_distribution_and_runs_nothing_twice(tmp_path, capsys):
    path, out = write_all(tmp_path), tmp_path / "all"
    status, report = command_json("ensemble", path, "--runs", 4, "--seed", 7)
    assert status == 0 and report["runs"] == 4 and report["failed"] == []
    end, curve = report["expectations"]
    values = [row["values"]["end"] for row in report["rows"]]
    assert end["mean"] == pytest.approx(np.mean(values)) and end["count"] == 4
    assert end["deviation"] == pytest.approx(np.std(values, ddof=1))
    assert end["quantiles"]["0.5"] == pytest.approx(np.median(values))
    assert end["interval"][0] < end["mean"] < end["interval"][1]
    for row in report["rows"]:  # within the phase error of its step, ω³dt²t/24 = 0.017
        omega = math.sqrt(row["settings"][STIFFNESS] / row["settings"][MASS])
        assert row["values"]["end"] == pytest.approx(math.cos(omega), abs=0.02)
    assert 0.0 <= curve["inside"] <= 1.0 and end["inside"] in (0.0, 1.0)
    with open(out / "ensemble.csv", newline="") as file:
        assert [row["name"] for row in csv.DictReader(file)] == ["end", "curve"]
    assert (out / "ensemble.png").read_bytes().startswith(b"\x89PNG")
    assert "4 of 4 runs are done, 0 failed" in capsys.readouterr().out

    _, second_report = command_json("ensemble", path, "--runs", 6, "--seed", 7)
    assert [row["kept"] for row in second_report["rows"]] == 4 * [True] + 2 * [False]
    assert set(starts(out).values()) == {1} and len(starts(out)) == 6
    end, curve = second_report["expectations"]
    stiffness, mass = end["origins"]["effects"]
    assert (stiffness["name"], mass["name"]) == ("stiffness", "mass")
    low, high = stiffness["interval"]  # of d cos(√(k/m) 1 s)/dk
    assert 0.0 < low < -math.sin(10.0) / 20.0 < high < 0.05
    assert curve["origins"]["effects"][0]["met_at"] is None  # a distance has no reference
    assert "what they do not explain" in capsys.readouterr().out


@pytest.mark.slow
def test_failed_runs_are_counted_and_named(tmp_path, capsys):
    path = write_all(tmp_path)
    code, step = (tmp_path / "toy_spring.py").read_text(), "    def step(self, dt):\n"
    failing_code = (
        "        if self.params.stiffness > 100.0:\n            raise ValueError('stiff')\n"
    )
    assert step in code
    (tmp_path / "toy_spring.py").write_text(code.replace(step, step + failing_code))
    status, report = command_json("ensemble", path, "--runs", 4)
    stiff = [row["run"] for row in report["rows"] if row["settings"][STIFFNESS] > 100.0]
    assert status == 3 and 0 < len(stiff) < 4 and report["failed"] == stiff
    assert report["expectations"][0]["count"] == 4 - len(stiff)
    output = capsys.readouterr().out
    assert f"{4 - len(stiff)} of 4 runs are done, {len(stiff)} failed" in output
    assert all(f"run {run}" in output for run in stiff)


WRONG = {
    "a key twice": (
        f'[ensemble.a]\nkeys = ["{MASS}"]\nuniform = [1.0, 2.0]\n'
        f'[ensemble.b]\nkeys = ["{MASS}"]\nuniform = [1.0, 2.0]\n',
        f"ensemble: a key must be in one table; found {MASS} in 2. Remove it.",
    ),
    "no distribution": (
        f'[ensemble.a]\nkeys = ["{MASS}"]\n',
        "it must have one distribution; give either uniform or normal.",
    ),
    "ends exchanged": (
        f'[ensemble.a]\nkeys = ["{MASS}"]\nuniform = [2.0, 1.0]\n',
        "uniform must go from its lower to its upper end; found (2.0, 1.0). Exchange them.",
    ),
    "an unknown key": (
        '[ensemble.a]\nkeys = ["components.spring.mas"]\nuniform = [0.0, 1.0]\nadded = true\n',
        "components.spring.mas has no value in the scene. Did you mean mass?",
    ),
    "no number": (
        '[ensemble.a]\nkeys = ["components.spring.kind"]\nuniform = [0.0, 1.0]\nadded = true\n',
        "components.spring.kind must be a number; found",
    ),
    "a mean that is refused": (
        f'[ensemble.a]\nkeys = ["{MASS}"]\nnormal = [-1.0, 0.1]\n',
        "ensemble, at its means:",
    ),
}


@pytest.mark.parametrize("case", WRONG)
def test_wrong_tables_are_refused(tmp_path, capsys, case):
    text, message = WRONG[case]
    path = write_all(tmp_path, text)
    assert command("ensemble", path) == 2
    assert message in capsys.readouterr().err


def test_a_scene_without_an_ensemble_says_what_to_add(tmp_path):
    with pytest.raises(SceneError, match=r"there is no \[ensemble\]. Add a table"):
        quintet.ensemble(write(tmp_path), 2, out=tmp_path / "all")


@pytest.mark.slow
def test_a_calibration_finds_the_stiffness_again(tmp_path, capsys):
    pytest.importorskip("optuna")
    path, out = write_all(tmp_path), tmp_path / "all"
    options = ("--over", f"{STIFFNESS}=60:140", "--to", "curve")
    status, report = command_json("calibrate", path, *options, "--runs", 8)
    key = report["keys"][STIFFNESS]
    assert status == 0 and report["misfit"] < 0.05
    assert key["best"] == pytest.approx(100.0, abs=5.0)
    assert 60.0 < key["low"] < key["best"] < key["high"] < 140.0
    assert not key["open_below"] and not key["open_above"]
    assert (out / "calibrate.png").read_bytes().startswith(b"\x89PNG")
    assert "its tolerance" in capsys.readouterr().out
    _, second_report = command_json("calibrate", path, *options, "--runs", 10, "--jobs", 1)
    assert [row["settings"] for row in second_report["rows"][:8]] == [
        r["settings"] for r in report["rows"]
    ]
    assert set(starts(out).values()) == {1} and len(starts(out)) == 10


def test_a_calibrated_number_is_rounded_within_its_range():
    (span,) = ranges_of({"window": (0.12345678, 0.99999999)})
    assert _rounded(0.99999998, span) == span.high and _rounded(0.12345679, span) == 0.123457
    (span,) = ranges_of({"window": (0.12345612, 1.0)})
    assert _rounded(0.12345613, span) == span.low


def test_a_calibration_without_its_library_says_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setattr(libraries, "is_installed", lambda library: False)
    with pytest.raises(SceneError, match=r"needs the library optuna.*quintet\[calibrate\]"):
        quintet.calibrate(write_all(tmp_path), {STIFFNESS: (60.0, 140.0)}, "curve")


@pytest.mark.parametrize(
    ("ranges", "message"),
    [
        (f"{STIFFNESS}=140:60", "LOW must be below HIGH; found (140.0, 60.0). Exchange them."),
        (f"{STIFFNESS}=1,2", "--over needs KEY=LOW:HIGH; found"),
        (f"{MASS},{MASS}=1:2", "a key must be given once; found it 2 times. Remove one."),
    ],
)
def test_wrong_ranges_are_refused(tmp_path, capsys, ranges, message):
    assert command("calibrate", write_all(tmp_path), "--over", ranges, "--to", "end") == 2
    assert message in capsys.readouterr().err


def test_an_ensemble_that_is_none_is_refused(tmp_path):
    pytest.importorskip("optuna")
    (tmp_path / "ensemble.json").write_text(json.dumps({"expectations": []}))
    with pytest.raises(SceneError, match="two values of curve or more; it has 0"):
        quintet.calibrate(
            write_all(tmp_path), {STIFFNESS: (60.0, 140.0)}, "curve", ensemble=tmp_path
        )
    row = {"name": "curve", "deviation": None, "count": 1}
    (tmp_path / "ensemble.json").write_text(json.dumps({"expectations": [row]}))
    with pytest.raises(SceneError, match="two values of curve or more; it has 1"):
        scatter_of(tmp_path, "curve")
