"""Bodies of particles on several MPI ranks: the same bits on any number of ranks."""

import json
from pathlib import Path

import numpy as np
import pytest
from pydantic import TypeAdapter
from rank_runs import differences, from_states, from_the_start

from quintet.components.sph_solid.component import SphSolid
from quintet.components.sph_solid.params import SphSolidParams
from quintet.interfaces.component import Resources
from quintet.interfaces.errors import SceneError

pytestmark = pytest.mark.mpi
PROGRAM = Path(__file__).with_name("solid_on_ranks.py")
NAMES = ("impact", "quarter", "lasting", "glued")
STEPS = 100  # enough for new lists and for rows that change their rank
folder = from_the_start(PROGRAM, NAMES, STEPS)
resumed = from_states(PROGRAM, NAMES, 30)


@pytest.mark.parametrize("name", NAMES)
def test_two_ranks_compute_what_one_does_to_the_bit(name, folder):
    assert differences(folder, f"{name}-1", f"{name}-2") == []


@pytest.mark.parametrize("name", NAMES)
def test_a_state_of_two_ranks_goes_on_with_three_as_one_goes_on(name, resumed):
    assert differences(resumed, f"{name}-1-1", f"{name}-3-2") == []


def test_bodies_with_the_neighbours_of_the_start_meet_and_slide(folder):
    results = np.load(folder / "lasting-2.npz")
    plate = results["view body"] == 0
    assert results["view velocity"][plate, 2].min() < -2.0
    shift = results["view points"][~plate, 0].mean() - 0.04
    assert shift > 0.005  # more than one spacing


def test_rings_are_refused_on_several_ranks():
    class Several:
        size = 2

    body = {"lowest": [0.0] * 3, "highest": [1.0] * 3, "material": "steel"}
    table = {"spacing": 0.1, "bodies": [body], "dimensions": 2, "axisymmetric": True}
    params = TypeAdapter(SphSolidParams).validate_json(json.dumps(table))
    with pytest.raises(SceneError, match=r"axisymmetric must be false of a solid on 2 ranks"):
        SphSolid(params, Resources(communicator=Several()))
