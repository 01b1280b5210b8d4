"""A gas shared out among ranks with devices: the same bits on any number of them."""

from pathlib import Path

import numpy as np
import pytest
from device_gases import STREAM, params_of
from rank_runs import differences, from_states, from_the_start

from quintet.components.meshless_gas import MANIFEST
from quintet.components.meshless_gas.ranks.several import part_of
from quintet.interfaces.errors import SceneError

pytest.importorskip("pyopencl")
PROGRAM = Path(__file__).with_name("device_gas_on_ranks.py")
NAMES = ("bodies", "steady", "tube")
OTHERS = ("vortex", "sphere")
STEPS = 60  # with holes cut again
folder = from_the_start(PROGRAM, NAMES, STEPS)
of_others = from_the_start(PROGRAM, OTHERS, STEPS)
resumed = from_states(PROGRAM, NAMES, 10)


@pytest.mark.mpi
@pytest.mark.parametrize("name", NAMES)
def test_two_devices_compute_what_one_does_to_the_bit(name, folder):
    assert differences(folder, f"{name}-1", f"{name}-2") == []


@pytest.mark.mpi
@pytest.mark.full
@pytest.mark.parametrize("name", OTHERS)
def test_other_gases_have_the_same_bits_on_two_devices(name, of_others):
    assert differences(of_others, f"{name}-1", f"{name}-2") == []


@pytest.mark.mpi
@pytest.mark.full
@pytest.mark.parametrize("name", NAMES)
def test_a_state_of_two_devices_goes_on_with_three_as_with_one(name, resumed):
    assert differences(resumed, f"{name}-1-1", f"{name}-3-2") == []


@pytest.mark.mpi
def test_a_failed_step_is_told_on_two_devices_as_on_one(folder):
    message = str(np.load(folder / "tube-2.npz")["failure"])
    assert "density and pressure must stay above 0" in message


@pytest.mark.mpi
def test_the_case_with_bodies_cuts_holes_again_on_devices(folder):
    assert np.load(folder / "bodies-2.npz")["state moving/fresh_count"] > 0


def test_ranks_own_whole_groups_of_nodes_that_a_device_adds_up():
    assert [part_of(200, rank, 3, 64) for rank in range(3)] == [(0, 64), (64, 128), (128, 200)]
    with pytest.raises(SceneError, match=r"must own 64 nodes that are .* there are 100 for 2"):
        part_of(100, 0, 2, 64)


def test_particles_on_several_devices_are_refused():
    params = params_of(STREAM | {"particles": {}})
    MANIFEST.check_device(params, "opencl", 1)
    with pytest.raises(SceneError, match=r"particles must be left out .* of 2 ranks; found loth"):
        MANIFEST.check_device(params, "opencl", 2)
