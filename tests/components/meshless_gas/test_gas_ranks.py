"""A gas whose nodes real MPI ranks share out: the same bits on any number of them."""

from pathlib import Path

import numpy as np
import pytest
from rank_runs import differences, from_states, from_the_start

from quintet.components.meshless_gas.ranks.several import part_of
from quintet.interfaces.errors import SceneError

pytestmark = pytest.mark.mpi
PROGRAM = Path(__file__).with_name("gas_on_ranks.py")
SUMS = Path(__file__).with_name("sums_on_ranks.py")
NAMES = ("bodies", "vortex", "steady", "sphere", "tube")
STEPS = 60  # with holes cut again
folder = from_the_start(PROGRAM, NAMES, STEPS)
resumed = from_states(PROGRAM, NAMES, 10)


@pytest.mark.parametrize("name", NAMES)
def test_two_ranks_compute_what_one_does_to_the_bit(name, folder):
    assert differences(folder, f"{name}-1", f"{name}-2") == []


@pytest.mark.parametrize("name", NAMES)
def test_a_state_of_two_ranks_goes_on_with_three_as_one_goes_on(name, resumed):
    assert differences(resumed, f"{name}-1-1", f"{name}-3-2") == []


@pytest.mark.parametrize("ranks", [1, 2, 4])
def test_sums_over_ranks_have_the_bits_of_numpys(ranks, on_ranks):
    on_ranks(SUMS, ranks)


def test_the_case_with_bodies_cuts_holes_again(folder):
    run = np.load(folder / "bodies-1.npz")
    assert run["state moving/centre"][1, 0] > -1.1
    assert run["state moving/fresh_count"] > 0


def test_a_failed_step_is_told_as_on_one_rank(folder):
    message = str(np.load(folder / "tube-2.npz")["failure"])
    assert "density and pressure must stay above 0" in message


def test_more_ranks_than_nodes_are_refused():
    assert part_of(3, 1, 3) == (1, 2)
    with pytest.raises(SceneError, match=r"ranks: each must own a node.* there are 3 for 4 ranks"):
        part_of(3, 1, 4)
