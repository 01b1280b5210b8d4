"""The test of convergence of a repeated window, and its log."""

import csv

import numpy as np
import pytest

from quintet.coupler.coupling.iteration.convergence_log import ConvergenceLog, ConvergenceRow
from quintet.coupler.coupling.iteration.convergence_measure import ConvergenceMeasure, converged
from quintet.coupler.coupling.iteration.settings import IterationSettings, unknown_fields
from quintet.interfaces.params import read
from quintet.interfaces.ports import LOAD, MOTION

FORCE, TORQUE = ("cube", "load.force"), ("cube", "load.torque")


def is_impulse(name, key):
    return key.startswith("load.")


def agrees(measure, gap, fields, length=1.0):
    guess = {key: np.asarray(fields[key]) - gap[key] for key in fields}
    return converged(measure.compare(guess, fields, length))


def test_what_is_nothing_but_rounding_need_not_agree():
    measure = ConvergenceMeasure(1e-6, {}, is_impulse)
    fields = {FORCE: np.array([0.07]), TORQUE: np.array([2e-18])}
    assert agrees(measure, {FORCE: 1e-9, TORQUE: 1e-18}, fields)
    assert not agrees(measure, {FORCE: 1e-6, TORQUE: 1e-18}, fields)
    fields[TORQUE] = np.array([2e-4])
    assert not agrees(measure, {FORCE: 1e-9, TORQUE: 1e-6}, fields)


def test_agreement_is_asked_for_relative_to_the_largest_norm_so_far():
    measure = ConvergenceMeasure(1e-6, {}, is_impulse)
    big, tiny = {FORCE: np.array([1.0])}, {FORCE: np.array([1e-14])}
    assert not agrees(measure, {FORCE: 1e-3}, big)
    assert agrees(measure, {FORCE: 1e-7}, big)
    assert agrees(measure, {FORCE: 1e-12}, tiny)  # rounding of what was 1
    assert agrees(measure, {FORCE: 0.0}, {FORCE: np.zeros(1)})


def test_a_guess_that_overshot_sets_no_floor():
    measure = ConvergenceMeasure(1e-6, {}, is_impulse)
    assert not agrees(measure, {FORCE: 9e8}, {FORCE: np.array([1e9])})
    assert not agrees(measure, {FORCE: 0.5}, {FORCE: np.array([1.5])})
    assert agrees(measure, {FORCE: 1e-7}, {FORCE: np.array([1.5])})


@pytest.mark.filterwarnings("ignore:overflow")
def test_numbers_too_large_for_a_norm_have_not_converged():
    measure = ConvergenceMeasure(1e-6, {}, is_impulse)
    for size in (1e155, 1e300):
        assert not converged(
            measure.compare({FORCE: np.array([-size])}, {FORCE: np.array([size])}, 1.0)
        )


def test_a_short_window_is_measured_as_a_long_one():
    """Impulses shrink with the window; their rates, floors and shares do not."""
    measures = [ConvergenceMeasure(1e-6, {"cube.load.torque": 0.02}, is_impulse) for _ in range(2)]
    lengths = (0.5, 2.0**-9)
    shares = []
    for measure, length in zip(measures, lengths, strict=True):
        fields = {FORCE: length * np.array([3.0, 4.0]), TORQUE: length * np.array([0.1])}
        guess = {key: array * (1.0 + 1e-5) for key, array in fields.items()}
        shares.append(measure.compare(guess, fields, length))
    assert shares[0][FORCE].allowed == shares[1][FORCE].allowed
    assert shares[0][FORCE].relative == pytest.approx(1e-5)
    assert [share.converged for share in shares[0].values()] == [False, True]
    assert shares[0][TORQUE].allowed == shares[1][TORQUE].allowed == 0.02


def test_an_absolute_tolerance_is_of_the_root_mean_square():
    measure = ConvergenceMeasure(1e-9, {"cube.load.force": 0.1}, is_impulse)
    for count in (1, 100):
        fields = {FORCE: np.ones((count, 3))}
        assert agrees(measure, {FORCE: 0.099}, fields)
        assert not agrees(measure, {FORCE: 0.101}, fields)


def test_what_was_guessed_of_what_is_at_rest_has_not_converged():
    measure = ConvergenceMeasure(1e-6, {}, is_impulse)
    residual = measure.compare({FORCE: np.ones(1)}, {FORCE: np.zeros(1)}, 1.0)[FORCE]
    assert not residual.converged
    assert residual.relative == float("inf")


def test_the_measure_goes_on_where_it_was_saved():
    measure = ConvergenceMeasure(1e-6, {}, is_impulse)
    measure.compare({FORCE: np.full(3, 0.1)}, {FORCE: np.full(3, 0.1)}, 0.1)
    restored = ConvergenceMeasure(1e-6, {}, is_impulse)
    restored.load(measure.save())
    assert restored.largest == measure.largest == {FORCE: pytest.approx(3.0**0.5)}


def _row(window, repetitions):
    measure = ConvergenceMeasure(1e-6, {}, is_impulse)
    fields = {FORCE: np.ones(1), TORQUE: np.full(1, 2.0)}
    guess = {key: array * 1.25 for key, array in fields.items()}
    return ConvergenceRow(window, repetitions, measure.compare(guess, fields, 1.0))


def test_the_log_is_cut_where_a_resumed_run_goes_on(tmp_path):
    path = tmp_path / "convergence.csv"
    log = ConvergenceLog(path)
    log.write(_row(0, 5))
    size = log.size()
    log.write(_row(1, 7))
    log.close()
    resumed_log = ConvergenceLog(path, size)
    resumed_log.write(_row(1, 3))
    resumed_log.close()
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    assert rows == [
        ["window", "repetitions", "cube.load.force", "cube.load.torque"],
        ["0", "5", "0.25", "0.25"],
        ["1", "3", "0.25", "0.25"],
    ]


def test_without_a_path_no_log_is_written():
    log = ConvergenceLog(None)
    log.write(_row(0, 1))
    assert log.size() == 0
    log.close()


def test_the_keys_of_iteration_are_checked():
    table = {"acceleration": "iqn-ils", "absolute": {"cube.load.force": 1e-6}, "at_limit": "stop"}
    settings, mistakes = read(IterationSettings, table, "iteration")
    assert not mistakes
    assert settings.absolute == {"cube.load.force": 1e-6}
    wrong_table = {
        "acceleration": "iqn",
        "filter": 2.0,
        "aitken": True,
        "absolute": {"a.b.c": -1.0},
    }
    _, mistakes = read(IterationSettings, wrong_table, "iteration")
    text = "\n".join(mistakes)
    for part in ("iteration.acceleration", "iteration.filter", "iteration.aitken", "a.b.c"):
        assert part in text


def test_an_absolute_tolerance_of_a_field_that_nobody_takes_is_refused():
    settings = IterationSettings(absolute={"cube.load.forse": 1e-6, "cube.load.torque": 1e-6})
    (mistake,) = unknown_fields(settings, {"cube": (LOAD,), "water": (MOTION,)})
    assert "cube.load.forse is not known" in mistake
    assert "Did you mean cube.load.force?" in mistake
