"""Error bars of the coupling: their estimates, and that they change no result."""

import json
import math
import shutil
import subprocess
import sys

import numpy as np
import pytest
from error_bar_cases import mechanical, springs, thermal
from error_bar_coverage import coverage, run

from quintet.coupler.cli import main
from quintet.coupler.coupling.judgement.error_bar import Orders, WindowError, sampled_window
from quintet.coupler.coupling.judgement.error_growth import DIFFERENCES, differences, nearest
from quintet.coupler.measures.error_bars import STUDENT, bar_about, window_bar
from quintet.coupler.report.diff import compare
from quintet.coupler.run import snapshots
from quintet.coupler.run.error_bars import error_bar_of, summary
from quintet.coupler.scene.read import load
from quintet.interfaces.errors import SceneError

DAMPED = {"mass": 1.0, "stiffness": 100.0, "damping": 0.4}
RIDER = {"mass": 0.5, "stiffness": 40.0, "damping": 0.1, "start": 0.1}


def status(*arguments):
    with pytest.raises(SystemExit) as exit_info:
        main([str(argument) for argument in arguments])
    return exit_info.value.code


def bars(folder):
    return json.loads((folder / "results.json").read_text())["error_bar"]


def test_one_window_of_each_stratum_is_sampled_and_never_the_first():
    windows = [sampled_window(stratum, 40) for stratum in range(100)]
    assert all(2 + 40 * n <= window < 42 + 40 * n for n, window in enumerate(windows))
    assert len({(window - 2) % 40 for window in windows}) == 40


@pytest.mark.parametrize("order", [1, 2, 3])
def test_results_of_any_order_are_extrapolated_to_windows_of_no_length(order):
    exact, leading, following = np.array([2.0, -1.0]), np.array([0.3, 0.1]), np.array([0.01, 0.02])
    results = [exact + leading * h**order + following * h ** (order + 1) for h in (1.0, 0.5, 0.25)]
    orders = Orders()
    np.testing.assert_allclose(orders.extrapolated(("a", "b.c"), *results), exact, rtol=1e-12)
    assert orders.order(("a", "b.c")) == order


def test_an_error_of_a_linear_motion_goes_on_as_its_own_changes_do():
    random = np.random.default_rng(3)
    step = np.eye(4) + 0.1 * random.standard_normal((4, 4))
    states = [random.standard_normal(4)]
    for _ in range(50):
        states.append(step @ states[-1])
    error = random.standard_normal(4)
    weights = nearest(error, differences(states[: DIFFERENCES + 1]))
    end_differences = differences(states[-DIFFERENCES - 1 :])
    extrapolated = sum(w * d for w, d in zip(weights, end_differences, strict=True))
    expected = np.linalg.matrix_power(step, 50 - DIFFERENCES) @ error
    np.testing.assert_allclose(extrapolated, expected, rtol=1e-6)


def test_nine_of_ten_of_the_errors_lie_within_the_bar_of_a_window():
    random = np.random.default_rng(5)
    inside = []
    for shape in (random.standard_normal, random.random, lambda n: np.sin(7.0 * random.random(n))):
        for _ in range(2000):
            errors = shape(41)
            inside.append(abs(errors[-1]) <= window_bar(errors[:-1]))
    assert np.mean(inside) == pytest.approx(0.9, abs=0.012)


def test_the_bar_of_few_samples_is_that_of_normal_errors():
    assert window_bar([3.0, -4.0]) == pytest.approx(STUDENT[1] * math.sqrt(12.5))
    assert math.isnan(window_bar([]))


def test_the_bar_of_a_value_holds_nine_of_ten_normal_errors():
    errors = np.random.default_rng(6).normal(1.0, 2.0, 100_000)
    assert np.mean(np.abs(errors) <= bar_about(1.0, 2.0)) == pytest.approx(0.9, abs=0.005)
    assert bar_about(-3.0, 0.0) == 3.0
    assert math.isnan(bar_about(3.0, math.nan)) and math.isnan(bar_about(math.nan, 1.0))


def test_a_run_that_ends_before_its_second_sample_has_no_order():
    """Of such a run the first window alone is sampled, which no order is measured from."""
    scene = load("two_springs", settings=["output.watch=['lower.motion.position']", "expect=[]"])
    bar = error_bar_of(scene)
    bar.samples = [WindowError(1, [0.1], [0.0] * DIFFERENCES, [0.1], [0.0])]
    (row,) = summary(bar, scene, None)["watched"]
    assert row["order"] is row["window"] is row["value"] is None and row["errors"] == [0.1]


@pytest.mark.parametrize("scheme", ["serial", "parallel", "iterated"])
def test_error_bars_change_no_bit_of_a_run(tmp_path, scheme):
    folders = tmp_path / "with", tmp_path / "without"
    arguments = ("two_springs", "--transport", "memory", "--set", "end=0.1", "--set", "expect=[]")
    arguments += ("--set", f"scheme={scheme!r}", "--set", "output.watch=['lower.motion.position']")
    status("run", *arguments, "--error-bar", "--set", "error_bar.every=5", "--out", folders[0])
    status("run", *arguments, "--out", folders[1])
    assert compare(*folders) is None
    first, second = (json.loads((path / "results.json").read_text()) for path in folders)
    assert len(first["error_bar"]["windows"]) > 5
    assert "error_bar" not in second
    for key in ("ledger", "repetitions", "windows"):
        assert first[key] == second[key]
    ledgers = [(folder / "ledger.csv").read_bytes() for folder in folders]
    assert ledgers[0] == ledgers[1]


def test_a_run_without_error_bars_loads_nothing_of_them(tmp_path):
    code = (
        "import sys\nfrom quintet.coupler.cli import main\ntry:\n"
        f"    main(['run', 'two_springs', '--transport', 'memory', '--set', 'end=0.01', '--set',"
        f" 'expect=[]', '--out', {str(tmp_path / 'run')!r}])\nexcept SystemExit:\n    pass\n"
        "print([name for name in sys.modules if 'error_bar' in name or 'error_growth' in name])"
    )
    result = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )
    assert result.stdout.splitlines()[-1] == "[]"


# A window of a scheme of order p leaves an error of order p + 1 in values that follow rates.
@pytest.mark.parametrize(("scheme", "order"), [("serial", 1), ("iterated", 2)])
def test_the_estimate_shrinks_with_the_window_to_the_order_of_the_scheme(tmp_path, scheme, order):
    case = mechanical("halved", "", scheme, 4e-3, 60, DAMPED, RIDER)
    estimates = []
    for window, every in ((4e-3, 6), (2e-3, 12)):
        settings = f"window={window}", f"error_bar.every={every}"
        settings += ("output.watch=['one.motion.velocity']",)
        row = bars(run(case, tmp_path / str(every), *settings))["watched"][-1]
        assert row["order"] == order
        estimates.append(row["window"])
    assert estimates[0] / estimates[1] == pytest.approx(2 ** (order + 1), rel=0.1)


@pytest.mark.parametrize(
    "case",
    [
        springs("springs", "", "serial", 1e-3, 800),
        thermal(
            "heat", "", "parallel", 5e-3, 400,
            {"capacity": 1.0, "start": 300.0}, {"capacity": 2.0, "conductance": 0.5, "start": 200.0}
        ),
    ],
    ids=lambda case: case.name,
)  # fmt: skip
def test_estimates_are_the_true_errors_of_windows_and_most_lie_within_the_bar(tmp_path, case):
    for row in coverage(case, run(case, tmp_path / "case", "error_bar.every=20")):
        assert row["estimate"] == pytest.approx(1.0, abs=0.02)
        assert 0.8 < row["window"] < 1.0
        assert row["end_bar"] == pytest.approx(row["told"][1])
        assert row["end_error"] <= row["end_bar"] < 10.0 * row["end_error"]


@pytest.mark.zenoh
def test_error_bars_have_the_same_bits_over_zenoh(tmp_path):
    arguments = ("two_springs", "--error-bar", "--set", "end=0.1", "--set", "expect=[]")
    arguments += ("--set", "output.watch=['upper.motion.position']", "--set", "error_bar.every=8")
    for transport in ("memory", "zenoh"):
        status("run", *arguments, "--transport", transport, "--out", tmp_path / transport)
    assert bars(tmp_path / "memory") == bars(tmp_path / "zenoh")
    assert compare(tmp_path / "memory", tmp_path / "zenoh") is None


def test_a_run_that_goes_on_from_a_snapshot_has_the_same_error_bars(tmp_path, monkeypatch):
    case = mechanical("resumed", "", "serial", 4e-3, 100, DAMPED, RIDER)
    with monkeypatch.context() as patch:
        patch.setattr(snapshots, "remove", lambda paths: None)
        first = run(case, tmp_path / "case", "error_bar.every=10", "output.snapshots=0.08")
    resumed = tmp_path / "case" / "again"
    shutil.copytree(first, resumed)
    for path in snapshots.snapshots(resumed):
        if snapshots.window_of(path) > 60:
            path.unlink()
    assert status("run", "--resume", resumed) in (0, 1)
    assert bars(resumed) == bars(first)


@pytest.mark.parametrize(
    ("settings", "text"),
    [
        (("error_bar.on=true", "expect=[]"), "error_bar.on needs a quantity to watch; found none."),
        (
            ("error_bar.on=true", "links=[]"),
            "error_bar.on needs links, whose coupling errs; found none.",
        ),
        (
            ("error_bar.on=true", "output.record=false"),
            "error_bar.on needs output.record = true; found false.",
        ),
        (("error_bar.every=0",), "error_bar.every"),
        (("error_bar.evry=3",), "Did you mean every?"),
        (("output.watch=['lower.motion.positon']",), "output.watch: lower.motion.positon"),
    ],
)
def test_wrong_keys_are_refused(settings, text):
    with pytest.raises(SceneError) as error_info:
        load("two_springs", settings=settings)
    assert text in str(error_info.value)


def test_error_bars_cannot_be_added_to_a_run_that_has_begun(tmp_path, capsys):
    assert status("run", "--resume", tmp_path, "--error-bar") == 2
    assert "Remove --error-bar." in capsys.readouterr().err
