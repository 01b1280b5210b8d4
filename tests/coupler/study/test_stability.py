"""The search finds a limit that is known exactly, and tells the runs on its two sides apart."""

import csv
import json
from io import StringIO
from types import SimpleNamespace

import pytest
from rich.console import Console
from spring_scene import command, command_json, write

from quintet.coupler.report import stability_map
from quintet.coupler.report.stability_map import draw_maps
from quintet.coupler.report.stability_tables import print_limits
from quintet.coupler.scene.read import load_variants
from quintet.coupler.scene.stability_table import LimitTable
from quintet.coupler.study.invariants import energies, judge
from quintet.coupler.study.stability_search import VERDICTS, Search, find_limit, summary
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import read

STEP = 'parameter = "components.spring.step"\n'
ENERGY = "energy = { factor = 100.0 }\n"
INSIDE = 'bounds = [{ component = "spring", field = "motion.position", low = -1.5, high = 1.5 }]\n'


def limits(*tables):
    return "".join(f"[[stability]]\n{table}\n" for table in tables)


def test_the_limit_of_leap_frog_is_found_and_both_sides_are_told_apart(tmp_path, capsys):
    keys = 'from = 0.15\nto = 0.25\nlog = true\npredicted = 0.2\nsource = "2/ω"\nend = 20.0\n'
    status, report = command_json("stability", write(tmp_path, limits(STEP + keys + ENERGY)))
    (limit,) = report["limits"]
    assert status == 0
    assert limit["found"] == pytest.approx(0.2, rel=0.05) and limit["predicted"] == 0.2
    assert limit["ratio"] == pytest.approx(limit["found"] / 0.2)
    assert limit["holds"] < 0.2 < limit["breaks"] < 1.05 * limit["holds"]
    assert (limit["broke"], limit["state"], limit["source"]) == ("energy", "unstable", "2/ω")
    assert 4 < len(limit["runs"]) < 8
    for run in limit["runs"]:
        assert run["state"] == ("stable" if run["value"] < 0.2 else "unstable")
    assert json.loads((tmp_path / "all" / "stability.json").read_text()) == report
    output = capsys.readouterr().out
    assert "energy: the total energy rose from 50 J" in output and "1.0" in output


def test_a_limit_is_found_for_each_value_of_a_second_parameter(tmp_path):
    keys = 'from = 0.15\nto = 0.45\naccuracy = 0.5\nend = 12.0\nsource = "2/ω"\n'
    keys += "predicted = [0.2, 0.4]\n"
    keys += 'against = { parameter = "components.spring.mass", values = [1.0, 4.0] }\n'
    status, report = command_json("stability", write(tmp_path, limits(STEP + keys + INSIDE)))
    assert status == 0
    for limit, mass, exact in zip(report["limits"], (1.0, 4.0), (0.2, 0.4), strict=True):
        assert limit["against"] == {"components.spring.mass": mass}
        assert limit["predicted"] == exact and limit["broke"] == "bounds"
        assert limit["holds"] < exact < limit["breaks"]


def test_other_paths_change_along_with_the_second_parameter(tmp_path):
    keys = "from = 0.15\nto = 0.25\naccuracy = 0.5\nend = 12.0\n"
    keys += 'against = { parameter = "components.spring.mass", values = [1.0, 4.0], '
    keys += 'along = { "components.spring.stiffness" = [100.0, 400.0] } }\n'
    status, report = command_json("stability", write(tmp_path, limits(STEP + keys + INSIDE)))
    assert status == 0
    for limit in report["limits"]:  # k/m stays, and so does the limit
        assert limit["holds"] < 0.2 < limit["breaks"]


def test_nothing_is_run_twice_and_a_map_is_drawn(tmp_path, capsys):
    keys = "from = 0.15\nto = 0.45\naccuracy = 0.5\nend = 12.0\n"
    keys += 'against = { parameter = "components.spring.mass", values = [1.0, 4.0] }\n'
    path = write(tmp_path, limits(STEP + keys + INSIDE))
    first_report, runs = (
        command_json("stability", path),
        tmp_path / "all" / "components.spring.step",
    )
    times = {run: run.stat().st_mtime_ns for run in runs.glob("*/*/results.json")}
    assert len(times) >= 4 and (tmp_path / "all" / "stability.png").stat().st_size > 10_000
    assert command_json("stability", path) == first_report
    assert times == {run: run.stat().st_mtime_ns for run in times}
    path.write_text(path.read_text().replace("low = -1.5", "low = -1.4"))
    command_json("stability", path)  # other bounds: other verdicts
    new_times = {run: run.stat().st_mtime_ns for run in times}
    assert all(new_times[run] > times[run] for run in times)


def test_a_search_that_was_ended_says_so():
    limit = {
        "name": "step",
        "parameter": "step",
        "against": None,
        "found": 0.2,
        "broke": "energy",
        "how": "it rose",
    }
    limit |= {"predicted": None, "ratio": None, "degraded": None, "state": "unstable"}
    for complete, words in ((True, "step: energy: it rose"), (False, "interrupted after 2 runs")):
        screen = Console(file=StringIO(), width=200, markup=False)
        print_limits([limit | {"complete": complete, "runs": [{}, {}]}], {"step": "s"}, screen)
        assert words in screen.file.getvalue() and "step [s]" in screen.file.getvalue()


def test_limits_of_other_settings_are_not_replaced(tmp_path, capsys):
    path = write(tmp_path, limits(STEP + "from = 0.15\nto = 0.25\naccuracy = 0.5\n" + INSIDE))
    out = ("--out", tmp_path / "all")
    assert command("stability", path, *out, "--set", "end=2.0") in (0, 1)
    assert command("stability", path, *out, "--set", "end=3.0") == 2
    assert "it holds limits of spring with other settings" in capsys.readouterr().err
    assert command("stability", path, *out, "--set", "end=3.0", "--force") in (0, 1)


def test_a_run_that_was_killed_from_outside_is_no_verdict(tmp_path):
    (variant,) = load_variants(str(write(tmp_path, limits(STEP + RANGE + INSIDE))))[1].stability
    child = SimpleNamespace(
        scene=str(tmp_path / "scene.toml"), preset="", settings=[], swaps=[], transport="memory",
        stop=lambda: False, run=lambda *_: {"status": "failed", "exit": -9},
    )  # fmt: skip
    (tmp_path / "runs").mkdir()
    search = Search(variant, None, child, tmp_path / "runs", True)
    assert not find_limit(search) and not search.verdicts
    assert not (tmp_path / "runs" / VERDICTS).exists()
    report = summary(search, None, False)
    assert report["found"] is None and not report["complete"]
    assert (
        draw_maps("spring", [report | {"against": {"mass": 1.0}}], {}, tmp_path / "map.png") is None
    )


def test_the_legend_of_a_map_has_what_any_panel_shows(tmp_path, monkeypatch):
    figures = []
    monkeypatch.setattr(stability_map, "save", lambda figure, out: figures.append(figure))
    runs = [{"value": 1.0, "state": "stable"}, {"value": 2.0, "state": "unstable"}]
    known = {"parameter": "step", "against": {"mass": 1.0}, "found": None, "predicted": None}
    first = known | {"name": "first", "runs": runs[:1]}
    second = known | {"name": "second", "runs": runs, "found": 1.5, "predicted": 1.4}
    draw_maps("spring", [first, second], {}, tmp_path / "map.png")
    words = [word.get_text() for word in figures[0].legends[0].get_texts()]
    assert words == ["stable", "unstable", "found", "predicted"]


def test_a_run_that_stalls_and_is_killed_is_unstable(tmp_path):
    """A window that takes too long does not end at SIGTERM: the search then kills the run."""
    (variant,) = load_variants(str(write(tmp_path, limits(STEP + RANGE + INSIDE))))[1].stability
    child = SimpleNamespace(
        scene=str(tmp_path / "scene.toml"), preset="", settings=[], swaps=[], transport="memory",
        stop=lambda: False, run=lambda *_: {"status": "stalled", "exit": -9, "time": 0.5},
    )  # fmt: skip
    (tmp_path / "runs").mkdir()
    search = Search(variant, None, child, tmp_path / "runs", True)
    assert find_limit(search)
    assert {verdict.state for verdict in search.verdicts.values()} == {"unstable"}


def test_several_paths_are_scaled_together_and_a_range_may_fall(tmp_path):
    # k and 1/m: with a step of 0.02 s the limit ω = 100 rad/s is k = 10⁴ N/m, or m = 0.01 kg.
    paths = 'parameter = ["components.spring.stiffness"]\nfrom = 60.0\nto = 150.0\nlog = true\n'
    mass = 'parameter = "components.spring.mass"\nfrom = 0.016\nto = 0.007\nlog = true\n'
    tables = limits(paths + ENERGY + "accuracy = 0.5\n", mass + ENERGY + "accuracy = 0.5\n")
    status, report = command_json("stability", write(tmp_path, tables))
    stiffness_limit, mass_limit = report["limits"]
    assert status == 0 and stiffness_limit["parameter"] == ["components.spring.stiffness"]
    assert stiffness_limit["holds"] <= 100.0 <= stiffness_limit["breaks"]
    assert mass_limit["holds"] >= 0.01 >= mass_limit["breaks"]


def test_what_only_misses_its_expectation_is_degraded(tmp_path):
    keys = 'from = 0.005\nto = 0.3\nlog = true\naccuracy = 0.5\nend = 5.0\nexpectation = ["end"]\n'
    status, report = command_json("stability", write(tmp_path, limits(STEP + keys + INSIDE)))
    (limit,) = report["limits"]
    assert status == 0 and limit["state"] == "unstable"
    assert limit["holds"] < 0.2 < limit["breaks"]
    # The error at the end is 0.544 · 1000 dt² / 24, to be within 2e-3.
    assert limit["degraded"] == pytest.approx(0.0094, rel=0.3)
    states = [run["state"] for run in limit["runs"]]
    assert states == sorted(states, key=["stable", "degraded", "unstable"].index)
    assert set(states) == {"stable", "degraded", "unstable"}


def test_a_run_that_fails_is_unstable_whatever_is_asked_for(tmp_path):
    keys = "from = 0.15\nto = 0.6\naccuracy = 0.5\nend = 200.0\n"
    status, report = command_json("stability", write(tmp_path, limits(STEP + keys)))
    (limit,) = report["limits"]
    assert status == 0 and limit["broke"] == "failed" and "finite" in limit["how"]


def test_a_range_without_a_limit_says_so(tmp_path, capsys):
    tables = limits(
        STEP + "from = 0.01\nto = 0.02\n" + ENERGY,
        STEP + 'name = "late"\nfrom = 0.3\nto = 0.4\nend = 10.0\n' + ENERGY,
    )
    status, report = command_json("stability", write(tmp_path, tables))
    assert status == 1 and [limit["found"] for limit in report["limits"]] == [None, None]
    output = " ".join(capsys.readouterr().out.split())
    assert "holds from 0.01 to 0.02" in output and "at 0.3 already: energy" in output


HEAD = "time,name,momentum_residual,kinetic,potential,internal,work\n"


def verdict(folder, rows, status="done", **rules):
    (folder / "ledger.csv").write_text(HEAD + rows.replace("\n", ",0\n"))
    table = {"parameter": "window", "from": 1.0, "to": 2.0, **rules}
    limit, mistakes = read(LimitTable, table, "limit")
    assert not mistakes
    results = {"status": status, "time": 3.0, "fault": {"cause": "it died"}}
    return judge(limit, results, folder)


def test_the_first_invariant_that_broke_is_told(tmp_path):
    rows = "0,link,1e-16,,,\n0,a,,1,1,0\n0,b,,1,0,0\n1,link,1e-3,,,\n1,a,,4,1,0\n1,b,,1,0,0\n"
    rules = {"energy": {"amount": 2.5}, "momentum": 1e-9}
    assert verdict(tmp_path, rows).state == "stable"
    assert verdict(tmp_path, rows, energy={"amount": 3.5}).state == "stable"
    assert verdict(tmp_path, rows, energy={"factor": 1.5}).how.endswith("from 3 J to 6 J")
    assert verdict(tmp_path, rows, "failed", **rules).broke == "energy"
    later_rows = rows.replace("1,link,1e-3", "1,link,1e-16") + "2,link,1e-3,,,\n2,a,,1,1,0\n"
    judgement = verdict(tmp_path, later_rows, "failed", momentum=1e-9)
    assert (judgement.broke, judgement.time) == ("momentum", 2.0)
    judgement = verdict(tmp_path, rows, "failed")
    assert (judgement.state, judgement.broke, judgement.how, judgement.time) == (
        "unstable",
        "failed",
        "it died",
        3,
    )
    assert "takes too long" in verdict(tmp_path, rows, "stalled").how


def test_energies_that_nobody_tells_cannot_be_judged(tmp_path):
    with pytest.raises(SceneError, match=r"all are 0 J at all times. Give it totals\(\), or use"):
        verdict(tmp_path, "0,a,,0,0,0\n1,a,,0,0,0\n", "done", energy={"factor": 2.0})


def test_a_factor_of_no_energy_is_told(tmp_path):
    rows = "0,a,,0,0,0\n1,a,,1e-12,0,0\n"
    assert verdict(tmp_path, rows, energy={"factor": 2.0}).how == (
        "the total energy rose from 0 J to 1e-12 J; energy.factor of 0 J allows no rise, give "
        "energy.amount"
    )
    assert verdict(tmp_path, rows, energy={"amount": 1e-3}).state == "stable"


def test_energies_that_are_not_finite_break(tmp_path):
    for value in ("nan", "inf"):
        rows = f"0,a,,1,0,0\n1,a,,{value},0,0\n"
        assert verdict(tmp_path, rows, energy={"factor": 2.0}).broke == "energy"


RANGE = "from = 0.1\nto = 0.3\n"
WRONG = {
    "unknown key": (STEP + RANGE + "ende = 1.0", "0.ende is not known. Did you mean end?"),
    "misspelt from": (
        STEP + "form = 0.1\nto = 0.3",
        "0.form is not known. Did you mean from?",
        "0.from is needed. Add from to it.",
    ),
    "unknown path": (
        'parameter = "components.spring.stp"\n' + RANGE,
        "0: components.spring.stp is not known. Did you mean step?",
    ),
    "unknown scaled path": (
        'parameter = ["components.spring.stp"]\n' + RANGE,
        "0: components.spring.stp has no value in the scene. Did you mean step?",
    ),
    "scaled text": (
        'parameter = ["name"]\n' + RANGE,
        "0: name must be a number to be scaled; found 'spring'. Name another.",
    ),
    "end of the range": (
        STEP + "from = 0.1\nto = -0.3",
        "0: components.spring.step should be greater than 0; found -0.3. Correct it.",
    ),
    "no range": (STEP + "from = 0.1\nto = 0.1", "0: from and to must differ; both are 0.1."),
    "log": (
        STEP + "from = -0.1\nto = 0.1\nlog = true",
        "0: log needs positive ends; found -0.1 and 0.1. Remove log.",
    ),
    "accuracy": (
        STEP + RANGE + "accuracy = 0.0",
        "0.accuracy should be greater than 0; found 0.0. Correct it.",
    ),
    "no source": (STEP + RANGE + "predicted = 1.0", "0: predicted needs a source."),
    "predictions": (
        STEP + RANGE + 'predicted = [1.0, 2.0]\nsource = "x"',
        "0: predicted must be one number, or one for each of against.values; found 2 for 0.",
    ),
    "against": (
        STEP + RANGE + 'against = { parameter = "components.spring.mas", values = [1.0] }',
        "0: components.spring.mas is not known. Did you mean mass?",
    ),
    "along": (
        STEP
        + RANGE
        + 'against = { parameter = "components.spring.mass", values = [1.0], '
        + 'along = { "components.spring.stiffness" = [1.0, 2.0] } }',
        "0: against.along must have as many values as against.values, 1, for each path; "
        "components.spring.stiffness has other numbers of them.",
    ),
    "energy": (
        STEP + RANGE + "energy = { factor = 0.5 }",
        "0.energy.factor must be above 1; found 0.5. Raise it.",
    ),
    "momentum": (
        STEP + RANGE + "momentum = 1e-9",
        "0: momentum is that of links; the scene has none. Remove it.",
    ),
    "expectation": (
        STEP + RANGE + 'expectation = ["ende"]',
        "0: expectation ende is not known. Did you mean end?",
    ),
    "bounds": (
        STEP + RANGE + 'bounds = [{ component = "spring", field = "motion.positon", low = 0.0 }]',
        "0: bounds.field motion.positon is not known. Did you mean motion.position?",
    ),
    "bounds axis": (
        STEP + RANGE + 'bounds = [{ component = "spring", field = "motion.position", axis = 3 }]',
        "0: bounds.axis must be below 3; found 3.",
        "0: bounds must have low or high; found neither. Give one.",
    ),
    "windows": (
        'parameter = "window"\nfrom = 0.01\nto = 0.1',
        "0: end must be 20 windows or more, as windows are whole; found 1 s for windows up to "
        "0.1 s. Raise end.",
    ),
}


@pytest.mark.parametrize("case", WRONG)
def test_a_wrong_limit_is_refused_with_the_scene(tmp_path, capsys, case):
    text, *sentences = WRONG[case]
    assert command("check", "--import", write(tmp_path, limits(text))) == 2
    message = capsys.readouterr().err
    for sentence in sentences:
        assert f"quintet: scene.toml: stability.{sentence}\n" in message


def test_a_scene_without_limits_says_so(tmp_path, capsys):
    assert command("stability", write(tmp_path)) == 2
    assert "Add a [[stability]] for each." in capsys.readouterr().err


def test_work_from_outside_is_no_rise_of_the_energy(tmp_path):
    rows = "0,a,,1,0,0\n1,a,,9,0,0\n"
    assert verdict(tmp_path, rows, energy={"factor": 2.0}).broke == "energy"
    (tmp_path / "ledger.csv").write_text(HEAD + "0,a,,1,0,0,0\n1,a,,9,0,0,8\n")
    assert energies(list(csv.DictReader((tmp_path / "ledger.csv").read_text().splitlines()))) == {
        0.0: 1.0,
        1.0: 1.0,
    }


def test_what_is_set_need_not_suit_limits_that_are_not_looked_for(tmp_path, capsys):
    table = 'parameter = "window"\nfrom = 0.005\nto = 0.05\n' + ENERGY
    path, out = write(tmp_path, limits(table)), tmp_path / "out"
    assert command("check", "--import", path) == 0, "the scene as it stands must suit its limits"
    assert command("check", "--import", path, "--set", "end=0.5") == 0, "check looks for no limit"
    assert command("run", path, "--set", "end=0.5", "--out", out) == 1, "the run looks for none"
    assert "spring: done" in capsys.readouterr().out
    assert command("stability", path, "--set", "end=0.5") == 2, "what looks for it must refuse"
    assert "stability.0: end must be 20 windows or more" in capsys.readouterr().err
