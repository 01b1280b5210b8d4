"""Structures shared out among real MPI ranks: the same bits on any number of them."""

import json
from pathlib import Path

import numpy as np
import pytest
from pydantic import TypeAdapter
from rank_runs import differences, from_states, from_the_start

from quintet.components.fe_plate.build import structure
from quintet.components.fe_plate.params import FePlateParams
from quintet.components.fe_plate.ranks.partition import owners, part_of
from quintet.interfaces.errors import SceneError

pytestmark = pytest.mark.mpi
PROGRAM = Path(__file__).with_name("structure_on_ranks.py")
NAMES = ("struck", "pressed", "bent", "glued", "plane")
STEPS = 60
folder = from_the_start(PROGRAM, NAMES, STEPS, ranks=(1, 2, 3))
resumed = from_states(PROGRAM, NAMES, 30, pairs=((1, 1), (1, 2), (3, 2), (2, 1)))


@pytest.mark.parametrize("ranks", [2, 3])
@pytest.mark.parametrize("name", NAMES)
def test_several_ranks_compute_what_one_does_to_the_bit(name, ranks, folder):
    assert differences(folder, f"{name}-1", f"{name}-{ranks}") == []


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("goes_on", ["1-2", "3-2", "2-1"])
def test_a_state_goes_on_with_any_number_of_ranks(name, goes_on, resumed):
    assert differences(resumed, f"{name}-1-1", f"{name}-{goes_on}") == []


def test_elements_erode_in_what_is_compared(folder):
    reached = np.load(folder / "struck-1.npz")
    assert reached["part_gauge.eroded"][1] > 0.0


def block(elements):
    part = {
        "lowest": [0.0] * 3,
        "highest": [0.1 * n for n in elements],
        "elements": elements,
        "material": "steel",
    }
    return TypeAdapter(FePlateParams).validate_json(json.dumps({"parts": [part]}))


def test_every_node_and_element_has_one_owner_that_computes_it():
    built = structure(block([20, 8, 30]))
    owner = owners(built, 4)
    parts = [part_of(built, owner, rank)[0] for rank in range(4)]
    nodes = np.concatenate([part.node[: part.moving] for part in parts])
    elements = np.concatenate([part.element for part in parts])
    assert np.array_equal(np.sort(nodes), np.arange(len(built.mesh.node)))
    assert np.array_equal(np.sort(elements), np.arange(len(built.mesh.corner)))
    for part in parts:
        blocks = built.places.point[:, 0] // 16
        here = np.isin(blocks, part.block)
        assert here[part.element].all()
        mine = np.isin(built.mesh.corner, part.node[: part.moving]).any(axis=1)
        assert here[mine].all()  # all elements at its nodes


def test_more_ranks_than_a_mesh_can_feed_are_refused():
    with pytest.raises(SceneError, match=r"ranks: each must"):
        owners(structure(block([2, 2, 2])), 3)
