"""A fluid shared out among ranks with devices: the same bits on any number of them."""

from pathlib import Path

import numpy as np
import pytest
from rank_runs import differences, from_states, from_the_start

pytest.importorskip("pyopencl")
from quintet.components.shared.opencl.ranks import name_of_rank
from quintet.interfaces.errors import SceneError

PROGRAM = Path(__file__).with_name("device_on_ranks.py")
NAMES = ("dam", "body")
# With terms that are compiled for them alone.
OTHERS = (
    "rolling", "pushed", "absorbing", "spilling", "block", "symmetric", "single", "swaying",
    "uneven", "filmed", "reloaded",
)  # fmt: skip
folder = from_the_start(PROGRAM, NAMES, 120, ranks=(1, 2, 3))
of_others = from_the_start(PROGRAM, OTHERS, 120)
long = from_the_start(PROGRAM, NAMES, 1000, ranks=(1, 2, 3))
resumed = from_states(PROGRAM, NAMES, 40)


@pytest.mark.mpi
@pytest.mark.parametrize("ranks", [2, 3])
@pytest.mark.parametrize("name", NAMES)
def test_several_devices_compute_what_one_does_to_the_bit(name, ranks, folder):
    assert differences(folder, f"{name}-1", f"{name}-{ranks}") == []
    assert np.load(folder / f"{name}-1.npz")["view velocity"].max() > 0.5
    assert "particle" in str(np.load(folder / f"{name}-{ranks}.npz")["failure"])


@pytest.mark.mpi
@pytest.mark.full
@pytest.mark.parametrize("ranks", [2, 3])
@pytest.mark.parametrize("name", NAMES)
def test_a_thousand_steps_on_several_devices_are_those_of_one(name, ranks, long):
    assert differences(long, f"{name}-1", f"{name}-{ranks}") == []


@pytest.mark.mpi
@pytest.mark.full
@pytest.mark.parametrize("name", OTHERS)
def test_other_terms_have_the_same_bits_on_two_devices(name, of_others):
    assert differences(of_others, f"{name}-1", f"{name}-2") == []
    has_films = (np.load(of_others / f"{name}-1.npz")["state film"] != 0.0).any()
    assert has_films == (name == "filmed")


@pytest.mark.mpi
@pytest.mark.full
@pytest.mark.parametrize("name", NAMES)
def test_a_state_of_two_devices_goes_on_with_three_as_with_one(name, resumed):
    assert differences(resumed, f"{name}-1-1", f"{name}-3-2") == []


def test_each_rank_takes_the_device_of_its_number():
    assert [name_of_rank("opencl:0,2,1", rank, 3) for rank in range(3)] == [
        "opencl:0", "opencl:2", "opencl:1",
    ]  # fmt: skip
    assert [name_of_rank("opencl:4", rank, 2) for rank in range(2)] == ["opencl:4"] * 2
    assert name_of_rank("opencl", 1, 2) == "opencl"
    with pytest.raises(SceneError, match=r"one number, or one for each rank; found 2 numbers and"):
        name_of_rank("opencl:0,1", 0, 1)
