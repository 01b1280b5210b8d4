"""The amplitude of an answer to waves of a known period, whatever part of a curve is measured."""

import math
from pathlib import Path

import numpy as np
import pytest

from quintet.coupler.files.recording import Instant, Recorder, Recording
from quintet.coupler.measures.evaluation import check, evaluate
from quintet.coupler.measures.expectation import Expectation
from quintet.coupler.measures.harmonic import amplitude
from quintet.coupler.measures.time_series import Curve
from quintet.interfaces.component import Port
from quintet.interfaces.ports import POSITION

PERIOD, AMPLITUDE = 1.4, 0.06


def heave(times):
    """Heave (m,) m about a mean, with a second harmonic as in steep waves."""
    phase = 2.0 * math.pi / PERIOD * times
    return 0.4 + AMPLITUDE * np.cos(phase + 0.3) + 0.2 * AMPLITUDE * np.cos(2.0 * phase)


@pytest.mark.parametrize("cycles", [1.0, 1.6, 3.0])
@pytest.mark.parametrize("begin", [0.0, 3.21])
def test_the_amplitude_is_that_of_the_first_harmonic(begin, cycles):
    times = np.linspace(begin, begin + cycles * PERIOD, 200)
    assert amplitude(Curve(times, heave(times)), PERIOD) == pytest.approx(AMPLITUDE, rel=1e-9)


@pytest.mark.parametrize("cycles", [1.0, 2.5])
def test_a_body_that_drifts_has_the_same_amplitude(cycles):
    times = np.linspace(0.0, cycles * PERIOD, 200)
    values = heave(times) + 0.03 / PERIOD * times
    assert amplitude(Curve(times, values), PERIOD) == pytest.approx(AMPLITUDE, rel=1e-9)


def test_too_few_values_in_a_period_have_no_amplitude():
    times = np.linspace(0.0, 6.0 * PERIOD, 6 * 4 + 1)
    assert math.isnan(amplitude(Curve(times, heave(times)), PERIOD))


def test_less_than_a_period_has_no_amplitude():
    times = np.linspace(0.0, 0.9 * PERIOD, 100)
    assert math.isnan(amplitude(Curve(times, heave(times)), PERIOD))


def expectation(**settings):
    base = {
        "name": "heave", "component": "hull", "field": "motion.position", "axis": 2,
        "measure": "amplitude", "period": PERIOD, "value": AMPLITUDE, "within": 1e-6, "unit": "m",
        "source": "by hand",
    }  # fmt: skip
    return Expectation(**(base | settings))


@pytest.mark.parametrize(("begin", "reason"), [(0.5, ""), (2.0, "holds no whole period of 1.4 s")])
def test_a_recording_of_a_body_gives_its_amplitude(tmp_path, begin, reason):
    times = np.linspace(0.0, 2.0 * PERIOD, 150)
    with Recorder(tmp_path / "recording.h5", "", "") as recorder:
        recorder.component("hull", (Port("motion", (POSITION,)),), {})
        for k, (t, z) in enumerate(zip(times, heave(times), strict=True)):
            recorder.add("hull", Instant(t, k), {"motion.position": np.array([[0.1 * t, 0.0, z]])})
    with Recording(tmp_path / "recording.h5") as recording:
        outcome = evaluate(expectation(begin=begin), recording, tmp_path)
    assert outcome.met == (not reason)
    assert reason in outcome.reason


@pytest.mark.parametrize("settings", [{"period": None}, {"measure": "mean"}])
def test_an_amplitude_needs_a_period_and_nothing_else_has_one(settings):
    with pytest.raises(ValueError, match="period belongs to an amplitude, which needs one"):
        expectation(**settings)


def test_an_amplitude_is_of_a_curve_that_is_not_smoothed():
    with pytest.raises(ValueError, match="moving_mean lowers an amplitude; remove it"):
        expectation(moving_mean=0.7)


def test_an_amplitude_of_a_vector_needs_its_axis():
    ports = (Port("motion", (POSITION,)),)
    mistakes = check(expectation(axis=None), {"hull": ports}, Path())
    assert "an amplitude of motion.position needs its axis, 0 to 2" in str(mistakes)
