"""Spheres shared out among ranks with devices: the same bits on any number of them."""

from pathlib import Path

import numpy as np
import pytest
from dem_scenes import FLOOR, params, sphere
from rank_runs import differences, from_states, from_the_start

pytest.importorskip("pyopencl")
from quintet.components.dem_bodies import MANIFEST
from quintet.components.dem_bodies.component import DemBodies
from quintet.components.dem_bodies.opencl.several_devices import total_of
from quintet.components.dem_bodies.state import BLOCK
from quintet.interfaces.component import Resources
from quintet.interfaces.errors import SceneError

PROGRAM = Path(__file__).with_name("dem_devices_on_ranks.py")
NAMES = ("heap", "rolling", "begun", "few", "one block")
RESUMED, LONG = ("heap", "rolling"), ("crowd", "rolling")
folder = from_the_start(PROGRAM, NAMES, 60)
resumed = from_states(PROGRAM, RESUMED, 30)
long = from_the_start(PROGRAM, LONG, 1000, ranks=(1, 2, 3), moved=(3,))


@pytest.mark.mpi
@pytest.mark.parametrize("name", NAMES)
def test_two_devices_compute_what_one_does_to_the_bit(name, folder):
    assert differences(folder, f"{name}-1", f"{name}-2") == []
    assert "must stay finite; body 7 is at" in str(np.load(folder / f"{name}-2.npz")["failure"])


@pytest.mark.mpi
def test_spheres_touch_each_other_and_planes_in_these_runs(folder):
    """Otherwise contact histories and loads on rows of other ranks would not be compared."""
    state = np.load(folder / "heap-2.npz")
    touching = state["state balls.history"][3] > 0.0
    on_planes = state["state balls.partner"] >= len(state["state body"])
    assert np.count_nonzero(touching & ~on_planes) > 100
    assert np.count_nonzero(touching & on_planes) > 10
    assert np.load(folder / "rolling-2.npz")["state balls.rolling_moment"].any()


@pytest.mark.mpi
def test_the_last_of_two_devices_owns_no_sphere_of_one_block(folder):
    assert len(np.load(folder / "one block-2.npz")["state body"]) == BLOCK + 1


@pytest.mark.mpi
@pytest.mark.parametrize("name", RESUMED)
def test_a_state_of_two_devices_goes_on_with_three_as_with_one(name, resumed):
    assert differences(resumed, f"{name}-1-1", f"{name}-3-2") == []


@pytest.mark.mpi
@pytest.mark.full
@pytest.mark.parametrize("ranks", [2, 3])
@pytest.mark.parametrize("name", LONG)
def test_a_thousand_steps_on_several_devices_are_those_of_one(name, ranks, long):
    assert differences(long, f"{name}-1", f"{name}-{ranks}") == []


def test_a_single_sphere_is_refused_on_devices_of_several_ranks():
    class Several:
        size = 2

    alone = params([sphere([0.0, 0.0, 0.2])], planes=[FLOOR])
    words = r"bodies must be two spheres or more on devices of 2 ranks; found 1\. Set ranks = 1"
    with pytest.raises(SceneError, match=words):
        MANIFEST.check_device(alone, "opencl", 2)
    with pytest.raises(SceneError, match=words):
        DemBodies(alone, Resources(communicator=Several(), device="opencl"))


def test_sums_of_groups_are_added_in_the_order_of_the_device():
    random = np.random.default_rng(4)
    groups = random.normal(size=(200, 2)) * 10.0 ** random.integers(-8, 8, (200, 2))
    items = np.zeros((64, 2))
    for number, group in enumerate(groups):
        items[number % 64] += group
    total = np.zeros(2)
    for item in items:
        total = total + item
    assert np.array_equal(total_of(groups), total)
