"""Bodies shared out among ranks with devices: the same bits on any number of them."""

from pathlib import Path

import numpy as np
import pytest
from device_solids import FAST, RINGS, params_of
from rank_runs import differences, from_states, from_the_start

from quintet.components.sph_solid import MANIFEST
from quintet.interfaces.errors import SceneError

pytest.importorskip("pyopencl")

PROGRAM = Path(__file__).with_name("solid_devices_on_ranks.py")
NAMES = ("impact", "quarter", "lasting", "glued")
STEPS = 60  # enough for new lists and for rows that change their rank
folder = from_the_start(PROGRAM, NAMES, STEPS)
long = from_the_start(PROGRAM, NAMES, 1000, ranks=(1, 2, 3))
resumed = from_states(PROGRAM, NAMES, 30)


@pytest.mark.mpi
@pytest.mark.parametrize("name", NAMES)
def test_two_devices_compute_what_one_does_to_the_bit(name, folder):
    assert differences(folder, f"{name}-1", f"{name}-2") == []
    assert np.load(folder / f"{name}-1.npz")["view velocity"].max() > 5.0


@pytest.mark.mpi
@pytest.mark.full
@pytest.mark.parametrize("ranks", [2, 3])
@pytest.mark.parametrize("name", NAMES)
def test_a_thousand_steps_on_several_devices_are_those_of_one(name, ranks, long):
    assert differences(long, f"{name}-1", f"{name}-{ranks}") == []


@pytest.mark.mpi
@pytest.mark.full
@pytest.mark.parametrize("name", NAMES)
def test_a_state_of_two_devices_goes_on_with_three_as_with_one(name, resumed):
    assert differences(resumed, f"{name}-1-1", f"{name}-3-2") == []


@pytest.mark.parametrize(
    ("table", "rule"),
    [
        (RINGS, "axisymmetric must be false of a solid on 2 ranks; it is true"),
        (FAST | {"contact_with_faces": True}, "contact_with_faces must be false of a solid on 2"),
    ],
)
def test_what_needs_one_device_is_refused(table, rule):
    MANIFEST.check_device(params_of(FAST), "opencl", 2)
    MANIFEST.check_device(params_of(table), "opencl", 1)
    with pytest.raises(SceneError, match=rule):
        MANIFEST.check_device(params_of(table), "opencl", 2)
