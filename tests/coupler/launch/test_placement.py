"""Ranks are placed by their cost, on nodes that have cores for them."""

import pytest

from quintet.coupler.launch.placement import Program, place
from quintet.interfaces.errors import SceneError

COUPLER = Program("coupler")


def test_the_costliest_gets_a_node_of_its_own_and_the_coupler_the_other():
    programs = [COUPLER, Program("cubes", 1, seconds=2.0), Program("water", 2, seconds=80.0)]
    assert place(programs, 2) == {"water": [0], "cubes": [1], "coupler": [1]}
    assert place(programs, 1) == {"water": [0], "cubes": [0], "coupler": [0]}


def test_ranks_of_one_component_are_spread_in_the_order_of_the_nodes():
    nodes = place([COUPLER, Program("gas", 4, 6, 100.0)], 3)
    assert nodes == {"gas": [0, 0, 1, 1, 2, 2], "coupler": [0]}


def test_no_node_gets_more_than_its_cores():
    programs = [COUPLER, Program("a", 3, seconds=9.0), Program("b", 3, seconds=1.0)]
    assert place(programs, 2, 4) == {"a": [0], "b": [1], "coupler": [1]}
    with pytest.raises(SceneError, match=r"b needs 3 cores .* finds none free\. Ask for more"):
        place(programs, 1, 4)


def test_idle_nodes_are_refused():
    with pytest.raises(SceneError, match=r"--nodes must be at most .* 1; found 3, of which 2"):
        place([COUPLER], 3)
