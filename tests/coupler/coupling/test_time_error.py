"""The error of a coupling in time, estimated from windows that were stepped twice."""

from types import SimpleNamespace

import numpy as np
import pytest

from quintet.coupler.coupling.judgement.settling_watch import UNSETTLED, Settling
from quintet.coupler.coupling.judgement.time_check import _text
from quintet.coupler.coupling.judgement.time_error import FieldError, TimeErrors, is_sampled, sample

KEY = ("body", "motion.position")


def estimated(error, window=0.01, windows=64, period=1.0, scatter=0.0, seed=1):
    """Errors of an oscillation whose change in each window is wrong by a share, with noise."""
    errors, random = TimeErrors(), np.random.default_rng(seed)
    for number in filter(is_sampled, range(1, windows + 1)):
        ends = np.array([number - 1, number]) * window
        start, end = (np.array([[np.sin(2.0 * np.pi * t / period), 0.0, 0.0]]) for t in ends)
        noise = scatter * random.standard_normal(start.shape)
        errors.add(number, {KEY: sample(end, end - error * (end - start) + noise, start, "value")})
    return errors


def test_an_error_of_every_window_is_found_whole():
    estimate = estimated(0.04).fields[KEY]
    assert estimate.local == pytest.approx(0.04)
    assert estimate.bias == pytest.approx(0.04)


def test_the_error_of_a_motion_to_and_fro_adds_up_over_its_way():
    short, long = (estimated(0.01, windows=count).fields[KEY].drift for count in (100, 4096))
    assert short < 0.05
    assert long > 0.3


def test_noise_adds_up_to_nothing():
    estimates = [estimated(0.0, windows=4096, scatter=0.01, seed=n).fields[KEY] for n in range(20)]
    assert sum(estimate.bias == 0.0 for estimate in estimates) >= 18
    assert all(estimate.local > 0.05 for estimate in estimates)


def test_what_does_not_move_is_not_judged():
    errors = TimeErrors()
    rest, rounding = np.ones((3, 3)), 1e-13
    for number in (1, 2, 4):
        samples = {KEY: sample(rest + rounding, rest, rest, "value")}
        errors.add(number, samples)
    assert errors.fields[KEY].motion == 0.0


def test_a_quaternion_and_its_negative_are_the_same():
    start, end = np.array([[1.0, 0.0, 0.0, 0.0]]), np.array([[0.8, 0.6, 0.0, 0.0]])
    error_sample = sample(end, -end, -start, "rotation")
    assert error_sample.difference == 0.0
    assert error_sample.change == pytest.approx(np.sqrt(0.4))


def test_a_load_is_said_to_be_wrong_by_the_estimate_that_is_above_its_limit():
    """The difference is nearly across the load: it has a bias, but far below the limit of one."""
    estimate = FieldError()
    estimate.add(1, sample(np.array([[1.0, 0.0]]), np.array([[0.9999, 0.6]]), None, "value"))
    assert 0.0 < estimate.bias < 1e-3 and estimate.local == pytest.approx(0.6)
    coupling = SimpleNamespace(
        carries=lambda link: None, last_dt=1e-3, plan=SimpleNamespace(name="", scheme="serial")
    )
    text = _text(coupling, "link", ("body", "load.force"), estimate)
    assert "by about 60 % of its change or more" in text and text.endswith(
        "Set window to 2e-05 s or less."
    )


def test_estimates_come_back_from_a_snapshot():
    errors, restored = estimated(0.04, windows=8), TimeErrors()
    restored.load(errors.save())
    assert restored.summary() == errors.summary()
    assert restored.save()["window"] == 8


def test_windows_are_sampled_at_powers_of_two_and_then_evenly():
    numbers = [number for number in range(1, 2049) if is_sampled(number)]
    assert numbers == [1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 1536, 2048]


def swung(factor, noise=0.0, windows=24, seed=2):
    """Changes by a factor from window to window, of the mean of many points with noise."""
    random = np.random.default_rng(seed)
    values = 100.0 * np.cumsum(float(factor) ** np.arange(windows))
    settling = Settling(np.full(16, values[0]))
    for value in values[1:]:
        settling.add(value + noise * random.standard_normal(16))
    return settling


def test_a_swing_from_window_to_window_that_does_not_decay_is_seen():
    assert swung(-1.0).persists
    assert swung(-1.0, noise=20.0).persists
    assert swung(-1.2).ratio == pytest.approx(-1.0)


def test_what_comes_to_rest_is_no_swing():
    assert not swung(-0.6).persists
    assert not swung(0.8).persists
    assert not any(swung(0.0, noise=20.0, seed=n).persists for n in range(20))


def relaxed(gain, relaxation, windows, noise=0.0, seed=2):
    """A field that answers a change of the value handed on by -gain times it; its rest is 0."""
    random = np.random.default_rng(seed)
    settling = Settling(np.full(16, 100.0))
    for _ in range(windows):
        settling.add(-gain * settling.handed + noise * random.standard_normal(16), relaxation)
    return settling


@pytest.mark.parametrize(("relaxation", "windows"), [(0.5, 2), (0.02, 16)])
def test_a_run_that_ends_before_its_link_has_settled_is_seen(relaxation, windows):
    assert relaxed(1.0, relaxation, windows).distance > UNSETTLED


@pytest.mark.parametrize("relaxation", [0.2, 0.5])
def test_noisy_answers_that_are_handed_on_in_part_are_settled_and_no_swing(relaxation):
    for seed in range(20):
        settling = relaxed(1.0, relaxation, 24, noise=30.0, seed=seed)
        assert settling.distance < UNSETTLED and not settling.persists
