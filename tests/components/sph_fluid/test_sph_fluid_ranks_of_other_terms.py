"""Fluids whose terms are compiled for these runs alone have the same bits on several ranks."""

from pathlib import Path

import numpy as np
import pytest
from rank_runs import differences, from_states, from_the_start

pytestmark = [pytest.mark.mpi, pytest.mark.full]
PROGRAM = Path(__file__).with_name("fluid_on_ranks.py")
NAMES = ("symmetric", "single", "block")
folder = from_the_start(PROGRAM, NAMES, 120)
resumed = from_states(PROGRAM, NAMES, 40)


@pytest.mark.parametrize("name", NAMES)
def test_two_ranks_compute_what_one_does_to_the_bit(name, folder):
    assert differences(folder, f"{name}-1", f"{name}-2") == []
    assert "particle" in str(np.load(folder / f"{name}-2.npz")["failure"])
    assert np.load(folder / f"{name}-1.npz")["view velocity"].max() > 0.5


@pytest.mark.parametrize("name", NAMES)
def test_a_state_of_two_ranks_goes_on_with_three_as_one_goes_on(name, resumed):
    assert differences(resumed, f"{name}-1-1", f"{name}-3-2") == []
