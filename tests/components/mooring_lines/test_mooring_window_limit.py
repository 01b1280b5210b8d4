"""Longest stable windows of a ball on mooring lines."""

from pathlib import Path

import numpy as np
import pytest

from quintet.components.mooring_lines.analysis.window_limit import lines_of, load, window_limit

BUOY = Path(__file__).resolve().parents[3] / "scenarios" / "moored_buoy" / "scene.toml"
MASS, RADIUS = 36.75, 0.2  # kg, m


@pytest.mark.parametrize(("height", "limit"), [(3.36, 0.342), (3.6, 0.315)])
def test_a_buoy_is_held_stiffest_where_its_chains_are_up(height: float, limit: float) -> None:
    lines = lines_of(BUOY, MASS)
    place = np.array([0.0, 0.0, height])
    assert window_limit(lines, place, MASS, RADIUS) == pytest.approx(limit, abs=1e-3)


def test_chains_carry_the_lift_of_the_buoy_at_rest() -> None:
    pull = load(lines_of(BUOY, MASS), np.array([0.0, 0.0, 3.359, 0.0, 0.0, 0.0]))
    assert pull[2] == pytest.approx(-132.6, abs=0.2)
