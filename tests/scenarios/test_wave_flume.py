"""The flume with waves: its reference is the theory that moves the paddle; coarse it is met."""

import csv
import math
from collections.abc import Callable
from pathlib import Path

import pytest

from quintet.components.sph_fluid.setup.wave_theory import bound_amplitude, wave_number
from quintet.scenarios.wave_flume import theory

Run = Callable[..., dict]
FOLDER = Path(theory.__file__).parent


def test_the_profile_is_a_wave_of_the_paddles_theory() -> None:
    omega = 2.0 * math.pi / theory.PERIOD
    k = wave_number(omega, theory.DEPTH, theory.GRAVITY)
    second = bound_amplitude(theory.HEIGHT, k, theory.DEPTH)
    rows = list(csv.reader((FOLDER / "theory.csv").read_text().splitlines()[2:]))
    assert len(rows) == 89
    for time, level in ((float(a), float(b)) for a, b in rows):
        phase = omega * time - k * theory.PLACE
        expected = 0.5 * theory.HEIGHT * math.cos(phase) + second * math.cos(2.0 * phase)
        assert level == pytest.approx(expected, abs=1e-6)


@pytest.mark.full
@pytest.mark.parametrize("name", ["height", "length", "reflection", "profile"])
def test_coarse_waves_are_those_of_theory(quick: dict, name: str) -> None:
    expected = quick["by_name"][name]
    assert expected["met"], expected


@pytest.fixture(scope="module")
def quick(run_scene: Run) -> dict:
    return run_scene("wave_flume", "--preset", "quick")
