"""A lattice shared out among ranks with devices: the same bits on any number of them."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from rank_runs import differences, from_states, from_the_start

pytest.importorskip("pyopencl")
from quintet.components.particle_dynamics import MANIFEST
from quintet.components.particle_dynamics.params import (
    Damping,
    Lattice,
    ParticleLatticeParams,
    SevenRootForce,
)
from quintet.interfaces.errors import SceneError

PROGRAM = Path(__file__).with_name("lattice_devices_on_ranks.py")
NAMES = ("driven", "heated", "periodic", "breaks up")
FROM_THE_START = (*NAMES, "begun")
folder = from_the_start(PROGRAM, FROM_THE_START, 45)
resumed = from_states(PROGRAM, NAMES, 12)
long = from_the_start(PROGRAM, NAMES, 1000, ranks=(1, 2, 3))


@pytest.mark.mpi
@pytest.mark.parametrize("name", FROM_THE_START)
def test_two_devices_compute_what_one_does_to_the_bit(name, folder):
    assert differences(folder, f"{name}-1", f"{name}-2") == []
    state = np.load(folder / f"{name}-2.npz")
    assert state["state velocity"].any()


@pytest.mark.mpi
@pytest.mark.parametrize("name", NAMES)
def test_a_state_of_two_devices_goes_on_with_three_as_with_one(name, resumed):
    assert differences(resumed, f"{name}-1-1", f"{name}-3-2") == []


@pytest.mark.mpi
@pytest.mark.full
@pytest.mark.parametrize("ranks", [2, 3])
@pytest.mark.parametrize("name", NAMES)
def test_a_thousand_steps_on_several_devices_are_those_of_one(name, ranks, long):
    assert differences(long, f"{name}-1", f"{name}-{ranks}") == []


LATTICE = ParticleLatticeParams(
    lattice=Lattice(cells=(3, 1, 1), spacing=0.01, mass=1e-3),
    seven_roots=SevenRootForce(top_frequency=50.0),
)


def test_collisions_are_refused_on_several_devices():
    params = replace(LATTICE, collision_rate=100.0)
    MANIFEST.check_device(params, "opencl", 1)
    MANIFEST.check_device(LATTICE, "opencl", 2)
    words = "collision_rate must be 0 on devices of 2 ranks, .*; found 100. Set ranks = 1"
    with pytest.raises(SceneError, match=words):
        MANIFEST.check_device(params, "opencl", 2)


def test_damping_of_all_pairs_is_refused_on_several_ranks():
    params = replace(LATTICE, damping=Damping(coefficient=1e-3, range="all"))
    MANIFEST.check_ranks(params, 1)
    with pytest.raises(SceneError, match="so the lattice cannot be shared out; found 2 ranks"):
        MANIFEST.check_ranks(params, 2)
