"""A gas shared out among ranks with devices: the same bits on any number of them."""

from pathlib import Path

import numpy as np
import pytest
from rank_runs import differences, from_states, from_the_start

pytest.importorskip("pyopencl")

pytestmark = pytest.mark.mpi
PROGRAM = Path(__file__).with_name("device_gas_on_ranks.py")
NAMES = ("bodies", "steady", "tube")
OTHERS = ("vortex", "sphere")
STEPS = 60  # with holes cut again
folder = from_the_start(PROGRAM, NAMES, STEPS)
of_others = from_the_start(PROGRAM, OTHERS, STEPS)
resumed = from_states(PROGRAM, (*NAMES, *OTHERS), 10)


@pytest.mark.parametrize("name", NAMES)
def test_two_devices_compute_what_one_does_to_the_bit(name, folder):
    assert differences(folder, f"{name}-1", f"{name}-2") == []


@pytest.mark.full
@pytest.mark.parametrize("name", OTHERS)
def test_other_gases_have_the_same_bits_on_two_devices(name, of_others):
    assert differences(of_others, f"{name}-1", f"{name}-2") == []


@pytest.mark.full
@pytest.mark.parametrize("name", (*NAMES, *OTHERS))
def test_a_state_of_two_devices_goes_on_with_three_as_with_one(name, resumed):
    assert differences(resumed, f"{name}-1-1", f"{name}-3-2") == []


def test_a_failed_step_is_told_on_two_devices_as_on_one(folder):
    message = str(np.load(folder / "tube-2.npz")["failure"])
    assert "density and pressure must stay above 0" in message
