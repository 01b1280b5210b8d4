"""Structures shared out among real MPI ranks: the same bits on any number of them."""

import json
from pathlib import Path

import numpy as np
import pytest
from pydantic import TypeAdapter
from rank_runs import differences, from_states, from_the_start

from quintet.components.fe_plate.build import structure
from quintet.components.fe_plate.params import FePlateParams
from quintet.components.fe_plate.ranks.partition import at_once, owners, part_of
from quintet.components.shared.domain import bisection
from quintet.interfaces.errors import SceneError

pytestmark = pytest.mark.mpi
PROGRAM = Path(__file__).with_name("structure_on_ranks.py")
NAMES = ("struck", "pressed", "tetrahedra", "bent", "glued", "plane")
STEPS = 60  # other numbers of ranks, and borders: test_fe_plate_ranks_of_any_number.py
folder = from_the_start(PROGRAM, NAMES, STEPS)
resumed = from_states(PROGRAM, NAMES, 30)


@pytest.mark.parametrize("name", NAMES)
def test_two_ranks_compute_what_one_does_to_the_bit(name, folder):
    assert differences(folder, f"{name}-1", f"{name}-2") == []


@pytest.mark.parametrize("name", NAMES)
def test_a_state_of_two_ranks_goes_on_with_three_and_other_borders(name, resumed):
    assert differences(resumed, f"{name}-1-1", f"{name}-3-2") == []


def test_elements_erode_in_what_is_compared(folder):
    results = np.load(folder / "struck-1.npz")
    assert results["part_gauge.eroded"][1] > 0.0


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
        in_part = np.isin(blocks, part.block)
        assert in_part[part.element].all()
        at_own_nodes = np.isin(built.mesh.corner, part.node[: part.moving]).any(axis=1)
        assert in_part[at_own_nodes].all()  # all elements at its nodes


def test_more_ranks_than_a_mesh_can_feed_are_refused():
    with pytest.raises(SceneError, match=r"ranks: each must"):
        owners(structure(block([2, 2, 2])), 3)


@pytest.mark.parametrize("shift", [0, 1, -7])
def test_ranks_step_few_blocks_twice_and_most_without_waiting(shift, monkeypatch):
    """The cut lies between two layers, or within one; then its edge is stepped twice too."""
    cut = bisection._cut
    monkeypatch.setattr(bisection, "_cut", lambda *arguments: cut(*arguments) + shift)
    built = structure(block([20, 16, 32]))  # 640 blocks, 32 in a layer
    owner = owners(built, 2)
    numbers = []
    for rank in range(2):
        part, inner, border = part_of(built, owner, rank)
        (run,), (before, after) = inner, border
        ends = [before.first, before.last, run.first, run.last, after.first, after.last]
        assert ends == [0, run.first, run.first, run.last, run.last, len(part.block)]
        assert at_once(inner, border) == [(0, 0, len(part.block))]
        corner = built.model.corner.reshape(640, -1)[part.block]
        assert (owner.node[corner[run.first : run.last]] == rank).all()
        assert run.last - run.first > 0.8 * len(part.block)
        numbers.append(part.block)
    assert all((np.diff(blocks) > 0).all() for blocks in numbers)
    twice = len(np.intersect1d(*numbers))
    assert 640 == len(np.union1d(*numbers))
    assert twice <= 32 + 4  # two rows
    assert abs(len(numbers[0]) - len(numbers[1])) <= 4 + 2 * abs(shift)
