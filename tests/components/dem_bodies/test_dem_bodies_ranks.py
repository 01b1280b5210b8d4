"""Bodies on several MPI ranks: the same bits on any number of ranks."""

from pathlib import Path

import numpy as np
import pytest
from dem_scenes import box, params
from rank_runs import differences, from_states, from_the_start

from quintet.components.dem_bodies.component import DemBodies
from quintet.components.dem_bodies.ranks.sparse import SparseArrays
from quintet.coupler.bench.worker import resident
from quintet.interfaces.component import Resources
from quintet.interfaces.errors import SceneError

pytestmark = pytest.mark.mpi
PROGRAM = Path(__file__).with_name("dem_on_ranks.py")
NAMES = ("heap", "rolling", "boxes", "begun")
STEPS = 60  # in which pairs are listed again, and rows change their rank
folder = from_the_start(PROGRAM, NAMES, STEPS)
resumed = from_states(PROGRAM, NAMES, 30)


@pytest.mark.parametrize("name", NAMES)
def test_two_ranks_compute_what_one_does_to_the_bit(name, folder):
    assert differences(folder, f"{name}-1", f"{name}-2") == []


@pytest.mark.parametrize("name", NAMES)
def test_a_state_of_two_ranks_goes_on_with_three_as_one_goes_on(name, resumed):
    assert differences(resumed, f"{name}-1-1", f"{name}-3-2") == []


def test_spheres_touch_each_other_and_planes_in_these_runs(folder):
    """Otherwise contact histories and loads on rows of other ranks would not be compared."""
    state = np.load(folder / "heap-2.npz")
    touching = state["state balls.history"][3] > 0.0
    on_planes = state["state balls.partner"] >= len(state["state body"])
    assert np.count_nonzero(touching & ~on_planes) > 100
    assert np.count_nonzero(touching & on_planes) > 10


def test_bodies_without_spheres_are_refused_on_several_ranks():
    class Several:
        size = 2

    boxes = params([box((0.0, 0.0, 1.0))])
    with pytest.raises(SceneError, match=r"ranks must be 1 where no body is a single sphere"):
        DemBodies(boxes, Resources(communicator=Several()))


@pytest.mark.parametrize("ranks", [1, 2])
def test_the_body_that_fails_is_named(ranks, folder):
    text = str(np.load(folder / f"heap-{ranks}.npz")["failure"])
    assert "must stay finite; body 7 is at" in text


def test_rows_that_are_not_kept_are_zero_and_take_no_memory():
    arrays = SparseArrays()
    memory_before = resident()
    motion, numbers = arrays.zeros((1_000_000, 16)), arrays.zeros((1_000_000,), np.int64)
    assert not motion[::10_000].any() and resident() - memory_before < 1e6
    motion[400_000:600_000], numbers[400_000:600_000] = 1.0, 2
    memory_written = resident() - memory_before
    assert memory_written > 0.9 * 200_000 * (16 + 1) * 8
    arrays.keep(450_000, 460_000)
    assert (motion[450_000:460_000] == 1.0).all() and (numbers[450_000:460_000] == 2).all()
    assert not motion[:440_000].any() and not numbers[470_000:].any()
    assert resident() - memory_before < 0.2 * memory_written
