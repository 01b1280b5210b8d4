"""Inflows let waves out or are warned of; probes and fronts lie among the nodes."""

import numpy as np
import pytest
from gases import GAMMA, SOD, gas, given, run, state, tube

from quintet.components.meshless_gas.exact.riemann import Side, star
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.interfaces.params import read


def test_a_wave_leaves_through_an_inflow_that_is_slower_than_sound():
    left, right = (1.0, 0.0, 1.5), (1.0, 0.0, 1.0)
    made = run(tube(100, left, right, box={"jitter": 0.0}), 1.2)  # both waves have left
    pressure, velocity = star(Side(*left), Side(*right), GAMMA)
    within = made.state.primitive[made.motion.domain.inner]
    assert np.abs(within[:, 4] - pressure).max() < 0.02 * (pressure - 1.0)  # 0.19 if it is held
    assert within[:, 1] == pytest.approx(velocity, abs=0.02 * velocity)


def test_gas_at_the_state_of_an_inflow_keeps_its_bits():
    made = tube(50, (1.0, 0.5, 1.0), (1.0, 0.5, 1.0), box={"jitter": 0.0})
    edges = made.motion.domain.edges
    run(made, 0.2)
    assert (made.state.primitive[edges] == made.state.primitive[edges[0]]).all()


def test_a_shock_that_reaches_a_supersonic_inflow_is_warned_of():
    wind = state(1.0, 3.0, 1.0 / GAMMA)
    ends = {"x-": {"kind": "inflow", "state": wind}, "x+": {"kind": "slip"}}
    made = gas(initial=wind, boundaries=ends, box={"highest": [1.0, 0.0, 0.3], "spacing": 0.05})
    assert run(made, 0.3).warnings() == {}
    warned = run(made, 4.0).warnings()["boundaries.x-"]
    assert "Move the boundary further away" in warned


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ({"probes": [[0.5, 0.0, 0.5], [0.5, 0.0, 1.2]]}, "probes, item 1"),
        ({"fronts": [{"begin": [0, 0, 0.5], "end": [3, 0, 0.5], "level": 1.0}]}, "item 0: end"),
    ],
)
def test_places_outside_the_box_are_refused_before_the_start(keys, said):
    box = {"lowest": [0.0] * 3, "highest": [1.0, 0.0, 1.0], "spacing": 0.1}
    table = {"box": box, "initial": {"density": 1.0, "pressure": 1.0}, **keys}
    (mistake,) = read(MeshlessGasParams, table, "gas")[1]
    assert said in mistake and "among the nodes" in mistake


def test_a_front_that_is_not_met_has_numbers_of_none():
    lines = [
        {"begin": [0.1, 0.0, 0.5], "end": [0.9, 0.0, 0.5], "level": level} for level in (0.5, 5.0)
    ]
    made = run(tube(50, *SOD, box={"highest": [1.0, 0.0, 1.0]}, fronts=lines), 0.05)
    assert list(given(made, "fronts.found")) == [1.0, 0.0]
    assert given(made, "fronts.distance")[0] > 0.0 > given(made, "fronts.distance")[1]
    assert given(made, "fronts.angle")[1] == -np.pi
