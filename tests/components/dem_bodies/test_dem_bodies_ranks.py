"""Bodies shared out among real MPI ranks: the same bits on any number of them."""

from pathlib import Path

import numpy as np
import pytest
from dem_scenes import box, params
from rank_runs import differences, from_states, from_the_start

from quintet.components.dem_bodies.component import DemBodies
from quintet.interfaces.component import Resources
from quintet.interfaces.errors import SceneError

pytestmark = pytest.mark.mpi
PROGRAM = Path(__file__).with_name("dem_on_ranks.py")
NAMES = ("heap", "rolling", "boxes")
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
    """So that histories of contacts, and loads on rows of other ranks, are compared."""
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
