"""Acceleration of iterated windows: the speed of convergence, and its dependencies."""

import itertools
import os
import subprocess
import sys

import numpy as np
import pytest

from quintet.coupler.coupling.iteration.acceleration import make
from quintet.coupler.coupling.iteration.convergence_measure import (
    ConvergenceMeasure,
    allowed,
    converged,
)
from quintet.coupler.coupling.iteration.least_squares import combination, filtered_least_squares
from quintet.coupler.coupling.iteration.settings import IterationSettings
from quintet.interfaces.sums import dot, norm

PLACE, FORCE = ("beam", "faces.position"), ("water", "load.force")
ALL = ["constant", "aitken", "iqn-ils"]


def is_impulse(name, key):
    return key == "load.force"


def settings(kind, **keys):
    return IterationSettings(acceleration=kind, **keys)


class Problem:
    """Two fields that answer each other linearly: x̃ = A x + b, in rates."""

    def __init__(self, seed=0, size=4, strength=3.0, units=(1.0, 1.0)):
        random = np.random.default_rng(seed)
        self.matrix = -strength * np.abs(random.normal(size=(2 * size, 2 * size))) / size
        self.right, self.size, self.units = random.normal(size=2 * size), size, units

    def answer(self, guess, length):
        x = np.concatenate([guess[PLACE] / self.units[0], guess[FORCE] / (length * self.units[1])])
        y = self.matrix @ x + self.right
        first, second = y[: self.size], y[self.size :]
        return {PLACE: self.units[0] * first, FORCE: length * self.units[1] * second}

    def window(self, acceleration, guess, length=0.5, measure=None, limit=100):
        """Solve one window; return its guesses and the last answer."""
        measure = measure or ConvergenceMeasure(1e-9, {}, is_impulse)
        acceleration.begin_window(length)
        guesses = [guess]
        for _ in range(limit):
            answer = self.answer(guess, length)
            residuals = measure.compare(guess, answer, length)
            if converged(residuals):
                break
            guess = acceleration.next(guess, answer, allowed(residuals))
            guesses.append(guess)
        acceleration.end_window(guess, answer)
        return guesses, answer

    def start(self):
        return {PLACE: np.zeros(self.size), FORCE: np.zeros(self.size)}


def scalar(slope, kind, **keys):
    """Steps that the accelerated iteration of x = slope x + 1 takes to 1e-10."""
    acceleration, x = make(settings(kind, **keys), is_impulse), {PLACE: np.zeros(1)}
    acceleration.begin_window(1.0)
    for step in range(60):
        answer = {PLACE: slope * x[PLACE] + 1.0}
        if abs(answer[PLACE] - x[PLACE])[0] < 1e-10:
            return step
        x = acceleration.next(x, answer, {PLACE: 1e-10})
    return None


@pytest.mark.parametrize("kind", ["aitken", "iqn-ils"])
@pytest.mark.parametrize("slope", [-3.0, -0.9, 0.5, 0.99])
def test_one_linear_unknown_takes_two_steps(slope, kind):
    assert scalar(slope, kind) == 2


def test_constant_relaxation_converges_if_it_is_small_enough():
    assert scalar(-3.0, "constant", relaxation=0.25) == 1  # just right
    assert scalar(-3.0, "constant", relaxation=0.1) > 20
    assert scalar(-3.0, "constant", relaxation=0.6) is None


@pytest.mark.parametrize("kind", ALL)
def test_a_residual_that_does_not_change_is_survived(kind):
    acceleration, guess = make(settings(kind), is_impulse), {PLACE: np.zeros(2)}
    acceleration.begin_window(1.0)
    for _ in range(3):
        guess = acceleration.next(guess, {PLACE: guess[PLACE] + 1.0}, {PLACE: 0.0})
    assert np.isfinite(guess[PLACE]).all()


def test_aitken_goes_on_after_a_residual_that_turned_by_a_right_angle():
    """x̃ = x + b - A x, where A turns by a right angle: Aitken's next factor would be 0."""
    acceleration, turn = make(settings("aitken"), is_impulse), np.array([[0.0, 1.0], [-1.0, 0.0]])
    guess, changes = {PLACE: np.zeros(2)}, []
    acceleration.begin_window(1.0)
    for _ in range(4):
        former = guess[PLACE]
        answer = {PLACE: former + np.array([1.0, 0.0]) - turn @ former}
        guess = acceleration.next(guess, answer, {PLACE: 1e-9})
        changes.append(norm(guess[PLACE] - former))
    assert min(changes) > 0.0


def test_quasi_newton_relaxes_where_no_column_says_anything():
    acceleration, guess = make(settings("iqn-ils", relaxation=0.25), is_impulse), np.zeros(2)
    acceleration.begin_window(1.0)
    for number in range(3):
        guess = acceleration.next({PLACE: guess}, {PLACE: guess + 1.0}, {PLACE: 1e-9})[PLACE]
        np.testing.assert_array_equal(guess, 0.25 * (number + 1))


@pytest.mark.parametrize("kind", ALL)
def test_what_is_at_rest_or_empty_is_left_alone(kind):
    acceleration = make(settings(kind), is_impulse)
    guess = {PLACE: np.zeros((0, 3)), FORCE: np.zeros((2, 3))}
    acceleration.begin_window(0.1)
    for _ in range(2):
        guess = acceleration.next(guess, guess, {PLACE: 0.0, FORCE: 0.0})
    assert guess[PLACE].shape == (0, 3)
    assert not guess[FORCE].any()
    acceleration.end_window(guess, guess)


def test_quasi_newton_solves_a_linear_problem_in_as_many_steps_as_it_has_unknowns():
    problem = Problem(size=4)
    guesses, _ = problem.window(make(settings("iqn-ils", filter=1e-6), is_impulse), problem.start())
    assert len(guesses) - 1 <= 2 * problem.size + 2
    exact = np.linalg.solve(np.eye(8) - problem.matrix, problem.right)
    assert guesses[-1][PLACE] == pytest.approx(exact[:4], rel=1e-7)


def test_columns_hold_in_windows_of_another_length():
    repetitions = {}
    for lengths in ((0.5, 0.5, 0.5), (0.5, 0.0625, 3.0)):
        problem = Problem(size=4)
        acceleration = make(settings("iqn-ils", filter=1e-6), is_impulse)
        guess, last = problem.start(), lengths[0]
        for length in lengths:
            problem.right = problem.right + 1.0
            scaled = {PLACE: guess[PLACE], FORCE: guess[FORCE] * (length / last)}
            guesses, guess = problem.window(acceleration, scaled, length)
            repetitions.setdefault(lengths, []).append(len(guesses) - 1)
            last = length
    equal, uneven = repetitions.values()
    assert equal == uneven
    assert max(equal[1:]) <= 2 < equal[0]


@pytest.mark.parametrize("kind", ["aitken", "iqn-ils"])
def test_no_unit_of_a_field_changes_a_guess(kind):
    """Units are scaled by powers of two, so that not even rounding may differ."""
    runs = []
    for units in ((1.0, 1.0), (2.0**-6, 2.0**5)):
        problem = Problem(units=units)
        measure = ConvergenceMeasure(1e-9, {}, is_impulse)
        acceleration = make(settings(kind, relaxation=0.1), is_impulse)
        runs.append(problem.window(acceleration, problem.start(), 0.5, measure, limit=12)[0])
    for guess, scaled_guess in zip(*runs, strict=True):
        assert (guess[PLACE] == scaled_guess[PLACE] * 2.0**6).all()
        assert (guess[FORCE] == scaled_guess[FORCE] * 2.0**-5).all()


@pytest.mark.parametrize("kind", ["aitken", "iqn-ils"])
def test_a_field_that_long_agrees_does_not_rule_the_others(kind):
    repetitions = []
    for quiet in ([], [("gas", "load.heat")]):
        problem, noise = Problem(size=4, strength=0.3), np.random.default_rng(1)
        acceleration = make(settings(kind, relaxation=0.1), is_impulse)
        guess = problem.start() | {key: np.ones(4) for key in quiet}
        limits = {PLACE: 1e-8, FORCE: 1e-8} | dict.fromkeys(quiet, 1e-6)
        acceleration.begin_window(1.0)
        for step in range(200):
            answer = problem.answer(guess, 1.0)
            answer |= {key: np.ones(4) + 1e-15 * noise.normal(size=4) for key in quiet}
            if all(norm(answer[key] - guess[key]) <= limits[key] for key in guess):
                repetitions.append(step)
                break
            guess = acceleration.next(guess, answer, limits)
    without, together = repetitions
    assert together <= without + 1


@pytest.mark.parametrize("kind", ALL)
def test_a_saved_acceleration_goes_on_with_the_same_bits(kind):
    def run(interrupted):
        problem, guess = Problem(size=4, strength=0.9), None
        measure = ConvergenceMeasure(1e-9, {}, is_impulse)
        acceleration = make(settings(kind, relaxation=0.1), is_impulse)
        last = problem.start()
        for window in range(6):
            if interrupted and window in (0, 3):
                saved, sizes = acceleration.save(), measure.save()
                acceleration = make(settings(kind, relaxation=0.1), is_impulse)
                acceleration.load({key: np.array(array) for key, array in saved.items()})
                measure = ConvergenceMeasure(1e-9, {}, is_impulse)
                measure.load(sizes)
            problem.right = problem.right * 1.1 + 0.1
            guess, last = problem.window(acceleration, last, 0.5 + 0.1 * window, measure, 30)
        return np.concatenate([fields[key] for fields in guess for key in fields])

    assert run(False).tobytes() == run(True).tobytes()


def test_columns_are_forgotten_after_so_many_windows_that_made_some():
    problem, ages = Problem(size=4), []
    acceleration = make(settings("iqn-ils", reuse=2), is_impulse)
    last = problem.start()
    for _ in range(5):
        problem.right = problem.right + np.arange(8.0)
        problem.matrix = 0.9 * problem.matrix
        last = problem.window(acceleration, last)[1]
        ages.append(max(acceleration.save()["ages"]))
    assert max(ages) == 2
    saved = acceleration.save()
    acceleration.begin_window(0.5)
    acceleration.end_window(last, last)  # agreed at once: nothing is learned, nothing forgotten
    assert acceleration.save()["ages"].tolist() == saved["ages"].tolist()
    without_reuse = make(settings("iqn-ils", reuse=0), is_impulse)
    problem.window(without_reuse, problem.start())
    assert without_reuse.save()["ages"].size == 0


def test_columns_that_no_longer_hold_are_dropped_when_the_residual_grows():
    problem = Problem(size=4, strength=0.5)
    acceleration = make(settings("iqn-ils"), is_impulse)
    last = problem.window(acceleration, problem.start())[1]
    problem.matrix = -40.0 * problem.matrix
    guesses, _ = problem.window(acceleration, last)
    assert len(guesses) - 1 <= 2 * problem.size + 6


def test_least_squares_are_those_of_lapack():
    random = np.random.default_rng(2)
    columns, target = random.normal(size=(7, 50)), random.normal(size=50)
    columns[3] += 1e5 * columns[0]  # ill-conditioned, yet nothing to leave out
    coefficients, is_kept = filtered_least_squares(columns, target, 1e-8)
    exact = np.linalg.lstsq(columns.T, target, rcond=None)[0]
    assert is_kept.all()
    np.testing.assert_allclose(coefficients, exact, rtol=1e-8)
    np.testing.assert_allclose(
        combination(coefficients, columns), columns.T @ coefficients, atol=1e-10
    )


def test_a_column_that_says_nothing_new_is_left_out():
    random = np.random.default_rng(3)
    columns, target = random.normal(size=(5, 30)), random.normal(size=30)
    columns[2] = columns[0] - 2.0 * columns[1] + 1e-4 * columns[4]
    columns[3] = 0.0
    coefficients, is_kept = filtered_least_squares(columns, target, 1e-3)
    assert is_kept.tolist() == [True, True, False, False, True]
    assert not coefficients[~is_kept].any()
    exact = np.linalg.lstsq(columns[is_kept].T, target, rcond=None)[0]
    np.testing.assert_allclose(coefficients[is_kept], exact, rtol=1e-10)


def test_inner_products_are_exact_to_rounding_whatever_the_layout():
    a, b = np.random.default_rng(4).normal(size=(2, 300, 90))
    assert dot(a, b) == pytest.approx(float(np.vdot(a, b)), rel=1e-10)
    assert dot(np.asfortranarray(a), np.asfortranarray(b)) == dot(a, b)
    assert norm(a) == pytest.approx(float(np.linalg.norm(a)), rel=1e-14)
    assert dot(a[:0], b[:0]) == 0.0


MANY = """
import hashlib
import numpy as np
from quintet.coupler.coupling.iteration.acceleration import make
from quintet.coupler.coupling.iteration.convergence_measure import ConvergenceMeasure, allowed
from quintet.coupler.coupling.iteration.settings import IterationSettings

key = ("water", "load.force")
seen = hashlib.sha256()
for kind in ("constant", "aitken", "iqn-ils"):
    random = np.random.default_rng(5)
    slope, curve, push = random.uniform(-2.0, 0.5, (3, 24_000))
    acceleration = make(IterationSettings(acceleration=kind), lambda *_: True)
    measure = ConvergenceMeasure(1e-6, {}, lambda *_: True)
    for window in range(3):
        guess = {key: np.full(24_000, 0.1 * window)}
        acceleration.begin_window(0.5)
        for _ in range(8):
            outputs = {key: push + slope * guess[key] + 0.1 * curve * np.roll(guess[key], 1)}
            residuals = measure.compare(guess, outputs, 0.5)
            guess = acceleration.next(guess, outputs, allowed(residuals))
            seen.update(guess[key].tobytes() + repr(residuals).encode())
        acceleration.end_window(guess, outputs)
    for array in acceleration.save().values():
        seen.update(array.tobytes())
print(seen.hexdigest())
"""


def test_no_number_of_threads_changes_a_bit():
    outputs = set()
    for threads in ("1", "2"):
        names = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")
        environment = {**os.environ, **dict.fromkeys(names, threads)}
        run = subprocess.run(
            [sys.executable, "-c", MANY], env=environment, capture_output=True, text=True
        )
        assert run.returncode == 0, run.stderr
        outputs.add(run.stdout)
    assert len(outputs) == 1


def test_no_library_of_linear_algebra_has_a_part_in_it():
    """The code of an exchange uses neither a matrix product nor numpy's linear algebra."""
    from quintet.coupler.coupling.iteration import (
        acceleration,
        convergence_measure,
        least_squares,
        residual_scaling,
    )

    modules = (acceleration, convergence_measure, least_squares, residual_scaling)
    words = (" @ ", "np.dot", "np.linalg", "np.matmul", "np.vdot", "np.inner", "einsum")
    for module, word in itertools.product(modules, words):
        with open(module.__file__) as file:
            assert word not in file.read(), (module.__name__, word)
