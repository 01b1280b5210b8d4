"""The results of a run are printed in full, as text that a pipe can carry."""

import copy
import json

import pytest

from quintet.coupler.files.run_files import new_marker, write_marker
from quintet.coupler.report.html_report import render
from quintet.coupler.report.run import Run
from quintet.coupler.report.show import results, show
from quintet.interfaces.errors import SceneError

NO_ENERGY = dict.fromkeys(
    ("change", "outside", "links", "heat", "lost", "unexplained", "gained", "coupling"), 0.0
)
RESULTS = {
    "scene": "dam_break", "preset": "quick", "transport": "zenoh", "status": "done",
    "windows": 1234, "time": 1.8,
    "expect": [
        {"name": "top.x [rms]", "value": 0.0437, "reference": 0.0, "within": 0.05, "unit": "m",
         "met": True, "source": "Canelas 2016"},
        {"name": "late", "value": None, "reference": 1.5, "within": 0.1, "unit": "s",
         "met": False, "source": "Canelas 2016"},
    ],
    "ledger": {
        "links": [{"link": "water-cubes", "momentum_residual": 1e-15, "energy_residual": 2e-14}],
        "energy_balance": {
            "scale": 1000.0,
            "times": 5,
            "run": {**NO_ENERGY, "change": -8.0, "outside": 4.0, "lost": 12.0, "gained": 3.0},
            "components": {
                "water": {**NO_ENERGY, "links": -5.0, "unexplained": None, "lost": 12.0},
                "cubes": {**NO_ENERGY, "links": 5.0, "unexplained": 1e-13},
            },
        },
        "mass_drift": {
            "water": {"kg": -2.0, "relative": -0.01}, "cubes": {"kg": 1e-9, "relative": 1e-9},
        },
    },
    "timing": {
        "wall": 100.0, "compile": 20.0, "exchange": 0.4, "mapping": 0.3,
        "components": {
            "water": {"build": 3.0, "compute": 80.0, "cpu": 150.0, "wait": 5.0, "steps": 9000,
                      "items": 61000},
        },
    },
    "machine": {"cpu": "x", "cores": 2, "versions": {}},
}  # fmt: skip


def _text_of(folder, results, capsys, **settings):
    (folder / "results.json").write_text(json.dumps(results))
    show(folder, **settings)
    return capsys.readouterr().out


def _line(text, word):
    return next(line for line in text.splitlines() if word in line).split()


def test_show_tells_expectations_ledger_and_timing(tmp_path, capsys):
    text = _text_of(tmp_path, RESULTS, capsys)
    assert "dam_break (quick): done, 1234 windows to t = 1.8 s over zenoh" in text
    assert _line(text, "top.x") == ["met", "top.x", "[rms]", "m", "0.0437", "0", "0.05"]
    assert _line(text, "late") == ["not", "met", "late", "s", "-", "1.5", "0.1"]
    assert "water-cubes" in text
    assert _line(text, "momentum residual")[-1] == "1e-15"
    assert _line(text, "energy residual")[-1] == "2e-14"
    assert _line(text, "9000") == ["water", "3", "80", "150", "5", "9000", "61000", "6.862e+06"]
    assert "exchange 0.4 s" in text


def test_show_leaves_out_what_no_link_carries_and_stays_narrow(tmp_path, capsys):
    zeros = {"momentum_residual": 0.0, "work_given": 0.0, "work_taken": 0.0, "turnover": 0.0,
             "energy_residual": 0.0, "impulse": [0.0, 0.0, 0.0]}  # fmt: skip
    heat = {"link": "points-bar", **zeros, "heat_residual": 0.0, "heat": -1.5}
    force = {"link": "water-cubes", **zeros, "impulse": [-1.234e-5, 2.345e-6, -3.456e-7]}
    text = _text_of(tmp_path, RESULTS | {"ledger": {"links": [heat, force]}}, capsys)
    assert "work" not in text and "energy residual" not in text
    assert _line(text, "momentum residual")[2:] == ["-", "0"], "exactly 0, and carried by one"
    assert _line(text, "heat residual")[2:] == ["0", "-"]
    assert max(map(len, text.splitlines())) <= 100


def test_show_tells_where_the_energy_of_the_run_and_of_each_component_went(tmp_path, capsys):
    text = _text_of(tmp_path, RESULTS, capsys)
    assert "Energy [J], 100 % = 1000 J" in text
    assert _line(text, "lost (diss")[2:] == ["12", "(1.2", "%)", "12", "(1.2", "%)", "0"]
    assert _line(text, "work over")[3:] == ["0", "-5", "(-0.5", "%)", "5", "(0.5", "%)"]
    assert _line(text, "largest rise")[3:] == ["3", "(0.3", "%)", "0", "0"]
    assert "heat over" not in text and "of it by" not in text, "no line where all are 0"
    assert "unexplained\n" not in text, "a rise of rounding is none"


def test_show_tells_of_one_component_without_repeating_it_for_the_run(tmp_path, capsys):
    full_balance = RESULTS["ledger"]["energy_balance"]
    water = {**full_balance["components"]["water"], "change": -12.0}
    balance = {**full_balance, "run": water, "components": {"water": water}}
    text = _text_of(
        tmp_path, RESULTS | {"ledger": {"links": [], "energy_balance": balance}}, capsys
    )
    assert _line(text, "change") == ["change", "-12", "(-1.2", "%)"]


def test_show_tells_of_masses_that_changed(tmp_path, capsys):
    text = _text_of(tmp_path, RESULTS, capsys)
    assert "Mass: mass of water changed by -1 % (-2 kg)\n" in text, "and only of water"
    filled = {"basin": {"kg": 2.5, "relative": None}}
    text = _text_of(tmp_path, RESULTS | {"ledger": {"links": [], "mass_drift": filled}}, capsys)
    assert "Mass: mass of basin changed by +2.5 kg from none" in text
    assert "Energy" not in text


def test_show_tells_where_mass_came_from_and_went(tmp_path, capsys):
    masses = {"at the start": 10.0, "entered by the inflow x-": 2.0, "lost through the wall z-": -1}
    balance = {"water": {"kg": masses, "now": 11.0, "residual": 0.0}}
    still = {"basin": {"kg": {"at the start": 3.0}, "now": 3.0, "residual": 0.0}}
    ledger = {"links": [], "mass_balance": balance | still}
    text = _text_of(tmp_path, RESULTS | {"ledger": ledger}, capsys)
    assert (
        "Mass of water: +10 kg at the start, +2 kg entered by the inflow x-, -1 kg lost through "
        "the wall z-; 11 kg now, which differs from their sum by 0 of it\n"
    ) in text
    assert "basin" not in text, "nothing came or left"


def test_show_tells_nothing_of_energy_and_mass_where_no_component_has_them(tmp_path, capsys):
    ledger = {"links": [], "energy_balance": None, "mass_drift": {}}
    text = _text_of(tmp_path, RESULTS | {"ledger": ledger}, capsys)
    assert not any(word in text for word in ("Energy", "energy", "Mass", "mass", "Balance"))


def test_show_tells_which_time_a_run_did_not_reach(tmp_path, capsys):
    row = RESULTS["expect"][1] | {"not_reached": 0.2}
    text = _text_of(tmp_path, RESULTS | {"expect": [row]}, capsys)
    assert "not reached (t = 0.2 s)  late" in text, "it is told what the run lacks"
    assert "not met" not in text, "what was not measured is not told as missed"
    row |= {"required": False}
    assert "(t = 0.2 s), not required" in _text_of(tmp_path, RESULTS | {"expect": [row]}, capsys)


def test_show_tells_of_warnings(tmp_path, capsys):
    warning = {"source": "link water-cube", "text": "its coupling is unstable"}
    text = "Warning of link water-cube: its coupling is unstable"
    assert text in _text_of(tmp_path, RESULTS | {"warnings": [warning]}, capsys)
    assert "Warning" not in _text_of(tmp_path, RESULTS | {"warnings": []}, capsys)


def test_show_is_plain_when_piped(tmp_path, capsys):
    assert _text_of(tmp_path, RESULTS, capsys).isascii()


def test_show_tells_what_broke(tmp_path, capsys):
    results = copy.deepcopy(RESULTS) | {"status": "failed", "expect": []}
    results["fault"] = {
        "component": "water", "window": 17, "cause": "killed by signal 9",
        "log": ["step 41", "density [-1] is wrong"],
    }  # fmt: skip
    text = _text_of(tmp_path, results, capsys)
    assert "failed" in text and "component: water" in text and "window: 17" in text
    assert "killed by signal 9" in text and "    density [-1] is wrong" in text


def test_show_tells_why_a_run_was_refused(tmp_path, capsys):
    refused = {"scene": "dam", "status": "refused", "cause": "lines.0.body must be below 1 [m]"}
    text = _text_of(tmp_path, refused, capsys)
    assert "Cause: lines.0.body must be below 1 [m]" in text
    (tmp_path / "scene.toml").write_text("")
    assert "Cause: lines.0.body must be below 1 [m]" in render(Run(tmp_path))


def test_show_tells_what_little_an_interrupted_run_left(tmp_path, capsys):
    text = _text_of(tmp_path, {"scene": "s", "status": "interrupted", "windows": 3}, capsys)
    assert "s: interrupted, 3 windows" in text


def test_show_as_json_gives_back_the_results(tmp_path, capsys):
    assert json.loads(_text_of(tmp_path, RESULTS, capsys, as_json=True)) == RESULTS


def test_a_folder_without_results_is_refused(tmp_path):
    with pytest.raises(SceneError, match=r"no results\.json"):
        results(tmp_path)
    for text, word in (("{", "must be JSON"), ("[]", "one table; found a list")):
        (tmp_path / "results.json").write_text(text)
        with pytest.raises(SceneError, match=word):
            results(tmp_path)


@pytest.mark.parametrize(
    ("kind", "remedy"),
    [
        ("run", r"continue it: quintet run --resume '.*a run'"),
        ("study", "It is the folder of a study. Name that of one of its runs."),
    ],
)
def test_a_run_under_way_and_a_study_say_what_to_do(tmp_path, kind, remedy):
    folder = tmp_path / "a run"
    folder.mkdir()
    write_marker(folder, new_marker(kind, "dam", []))
    with pytest.raises(SceneError, match=remedy):
        results(folder)


def test_an_expectation_without_a_value_says_why(tmp_path, capsys):
    row = RESULTS["expect"][0] | {"value": None, "met": False, "reason": "never passed"}
    text = _text_of(tmp_path, RESULTS | {"expect": [row]}, capsys)
    assert f"{row['name']}: not met: never passed" in " ".join(text.split())


def test_show_puts_error_bars_beside_the_values_where_a_run_has_them(tmp_path, capsys):
    assert "±" not in _text_of(tmp_path, RESULTS, capsys)
    results = copy.deepcopy(RESULTS)
    results["expect"][0]["error_bar"] = 0.002
    row = {"name": "top.x [rms]", "window": 3e-6, "value": 0.002, "order": 1}
    results["error_bar"] = {
        "confidence": 0.9, "windows": [1, 125], "skipped": "dust keeps no state.", "watched": [row]
    }  # fmt: skip
    text = _text_of(tmp_path, results, capsys)
    assert _line(text, "met ")[-4:] == ["0.0437", "0.002", "0", "0.05"]
    assert _line(text, "late")[-4:] == ["-", "-", "1.5", "0.1"]
    assert "Error by the coupling, with 90 % confidence" in text
    assert "3e-06" in text
    sentence = "Error bars: from 2 of 1234 windows; then sampling ended, for dust keeps no state."
    assert sentence in text
