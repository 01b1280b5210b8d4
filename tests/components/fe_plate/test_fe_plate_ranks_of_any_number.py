"""Structures on any number of MPI ranks, with any borders, from any state: the same bits."""

from pathlib import Path

import pytest
from rank_runs import MOVED, RANK_PROGRAM, differences, from_states, from_the_start
from test_fe_plate_ranks import NAMES, STEPS

pytestmark = [pytest.mark.mpi, pytest.mark.full]
PROGRAM = Path(__file__).with_name("structure_on_ranks.py")
folder = from_the_start(PROGRAM, NAMES, STEPS, ranks=(1, 2, 3))
resumed = from_states(PROGRAM, NAMES, 30, pairs=((1, 1), (1, 2), (2, 1)))


@pytest.mark.parametrize("name", NAMES)
def test_three_ranks_compute_what_one_does_to_the_bit(name, folder):
    assert differences(folder, f"{name}-1", f"{name}-3") == []


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("ranks", ["1-2", "2-1"])
def test_a_state_goes_on_with_any_number_of_ranks(name, ranks, resumed):
    assert differences(resumed, f"{name}-1-1", f"{name}-{ranks}") == []


def test_borders_elsewhere_change_no_bit(folder, tmp_path, on_ranks):
    on_ranks(RANK_PROGRAM, 2, PROGRAM, tmp_path, STEPS, 0, ",".join(NAMES), MOVED)
    for name in NAMES:
        (tmp_path / f"{name}-1.npz").symlink_to(folder / f"{name}-1.npz")
    assert [differences(tmp_path, f"{name}-1", f"{name}-2") for name in NAMES] == [[]] * len(NAMES)
