"""A gas whose nodes real MPI ranks share out: the same bits on any number of them."""

from pathlib import Path

import numpy as np
import pytest

pytestmark = pytest.mark.mpi
PROGRAM = Path(__file__).with_name("gas_on_ranks.py")
NAMES = ("bodies", "vortex", "steady")
STEPS = 60  # with holes cut again


def differences(folder, first, second):
    """Names of the arrays that differ in a bit."""
    one, other = np.load(folder / f"{first}.npz"), np.load(folder / f"{second}.npz")
    assert set(one.files) == set(other.files)
    return [name for name in one.files if one[name].tobytes() != other[name].tobytes()]


@pytest.fixture(scope="module")
def folder(tmp_path_factory, on_ranks):
    """Runs on 1 and 2 ranks."""
    folder = tmp_path_factory.mktemp("gases")
    for ranks in (1, 2):
        on_ranks(PROGRAM, ranks, folder, STEPS, 0, ",".join(NAMES))
    return folder


@pytest.fixture(scope="module")
def resumed(folder, on_ranks):
    """Runs on 1 and 3 ranks that go on from the states of 1 and 2."""
    for ranks, earlier in ((1, 1), (3, 2)):
        on_ranks(PROGRAM, ranks, folder, 10, earlier, ",".join(NAMES))
    return folder


@pytest.mark.parametrize("name", NAMES)
def test_two_ranks_compute_what_one_does_to_the_bit(name, folder):
    assert differences(folder, f"{name}-1", f"{name}-2") == []


@pytest.mark.parametrize("name", NAMES)
def test_a_state_of_two_ranks_goes_on_with_three_as_one_goes_on(name, resumed):
    assert differences(resumed, f"{name}-1-1", f"{name}-3-2") == []


def test_the_case_with_bodies_cuts_holes_again(folder):
    run = np.load(folder / "bodies-1.npz")
    assert run["moving/centre"][1, 0] > -1.1
    assert run["moving/fresh_count"] > 0
