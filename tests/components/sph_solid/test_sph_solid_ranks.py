"""Bodies of particles shared out among real MPI ranks: the same bits on any number of them."""

import json
from pathlib import Path

import numpy as np
import pytest
from pydantic import TypeAdapter

from quintet.components.sph_solid.component import SphSolid
from quintet.components.sph_solid.params import SphSolidParams
from quintet.interfaces.component import Resources
from quintet.interfaces.errors import SceneError

pytestmark = pytest.mark.mpi
PROGRAM = Path(__file__).with_name("solid_on_ranks.py")
NAMES = ("impact", "quarter", "lasting", "glued")
STEPS = 100  # with lists made again, and rows that change their rank


def differences(folder, first, second):
    """Names of the arrays that differ in a bit."""
    one, other = np.load(folder / f"{first}.npz"), np.load(folder / f"{second}.npz")
    assert set(one.files) == set(other.files)
    return [name for name in one.files if one[name].tobytes() != other[name].tobytes()]


@pytest.fixture(scope="module")
def folder(tmp_path_factory, on_ranks):
    """Runs on 1 and 2 ranks."""
    folder = tmp_path_factory.mktemp("solids")
    for ranks in (1, 2):
        on_ranks(PROGRAM, ranks, folder, STEPS, 0, ",".join(NAMES), seconds=300)
    return folder


@pytest.fixture(scope="module")
def resumed(folder, on_ranks):
    """Runs on 1 and 3 ranks that go on from the states of 1 and 2."""
    for ranks, earlier in ((1, 1), (3, 2)):
        on_ranks(PROGRAM, ranks, folder, 30, earlier, ",".join(NAMES), seconds=300)
    return folder


@pytest.mark.parametrize("name", NAMES)
def test_two_ranks_compute_what_one_does_to_the_bit(name, folder):
    assert differences(folder, f"{name}-1", f"{name}-2") == []


@pytest.mark.parametrize("name", NAMES)
def test_a_state_of_two_ranks_goes_on_with_three_as_one_goes_on(name, resumed):
    assert differences(resumed, f"{name}-1-1", f"{name}-3-2") == []


def test_bodies_with_the_neighbours_of_the_start_meet_and_slide(folder):
    reached = np.load(folder / "lasting-2.npz")
    plate = reached["view body"] == 0
    assert reached["view velocity"][plate, 2].min() < -2.0
    moved = reached["view points"][~plate, 0].mean() - 0.04
    assert moved > 0.005  # further than a spacing


def test_rings_are_refused_on_several_ranks():
    class Several:
        size = 2

    body = {"lowest": [0.0] * 3, "highest": [1.0] * 3, "material": "steel"}
    table = {"spacing": 0.1, "bodies": [body], "dimensions": 2, "axisymmetric": True}
    params = TypeAdapter(SphSolidParams).validate_json(json.dumps(table))
    with pytest.raises(SceneError, match=r"axisymmetric must be false of a solid on 2 ranks"):
        SphSolid(params, Resources(communicator=Several()))
