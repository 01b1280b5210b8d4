"""Inflows let waves out or are warned of; probes and fronts lie among the nodes."""

import numpy as np
import pytest
from gases import GAMMA, SOD, gas_in_box, output, run, state, tube
from test_sidedness import ROUND

from quintet.components.meshless_gas.blunt_bodies import normal_shock
from quintet.components.meshless_gas.component import MeshlessGas
from quintet.components.meshless_gas.exact.riemann import Side, star
from quintet.components.meshless_gas.monitors import OUTGOING, shock_strength
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.interfaces.params import read


def test_a_wave_leaves_through_an_inflow_that_is_slower_than_sound():
    left, right = (1.0, 0.0, 1.5), (1.0, 0.0, 1.0)
    gas = run(tube(100, left, right, box={"jitter": 0.0}), 1.2)  # both waves have left
    pressure, velocity = star(Side(*left), Side(*right), GAMMA)
    states = gas.state.primitive[gas.motion.domain.inner]
    assert np.abs(states[:, 4] - pressure).max() < 0.02 * (pressure - 1.0)  # 0.19 if it is held
    assert states[:, 1] == pytest.approx(velocity, abs=0.02 * velocity)


def test_gas_at_the_state_of_an_inflow_keeps_its_bits():
    gas = tube(50, (1.0, 0.5, 1.0), (1.0, 0.5, 1.0), box={"jitter": 0.0})
    edges = gas.motion.domain.edges
    run(gas, 0.2)
    assert (gas.state.primitive[edges] == gas.state.primitive[edges[0]]).all()


def test_a_shock_that_reaches_a_supersonic_inflow_is_warned_of():
    wind = state(1.0, 3.0, 1.0 / GAMMA)
    ends = {"x-": {"kind": "inflow", "state": wind}, "x+": {"kind": "slip"}}
    gas = gas_in_box(
        initial=wind, boundaries=ends, box={"highest": [1.0, 0.0, 0.3], "spacing": 0.05}
    )
    assert run(gas, 0.3).warnings() == {}
    warning = run(gas, 4.0).warnings()["boundaries.x-"]
    assert "Move the boundary further away" in warning


def test_a_shock_runs_out_against_a_stream_where_gas_beside_it_is_above_a_standing_shock():
    stream = Side(1.0, 3.0, 1.0 / GAMMA)
    density, pressure = normal_shock(3.0, GAMMA)
    for factor, runs_out in ((0.5, False), (0.99, False), (1.1, True), (3.0, True)):
        beside = Side(density, 3.0 / density, factor * pressure / GAMMA)
        assert (shock_strength(stream, beside, GAMMA) > OUTGOING) is runs_out
    at_rest = Side(density, 0.0, pressure / GAMMA)  # throttled: less leaves than comes in
    assert shock_strength(stream, at_rest, GAMMA) > OUTGOING


@pytest.mark.parametrize(("outer", "is_warned"), [(10.0, False), (1.12, True)])
def test_a_bow_shock_in_the_last_layer_stands_and_one_beyond_it_is_warned_of(outer, is_warned):
    layers = {"count": 24, "line_stencils": True}
    cloud = {"radius": 1.0, "points_around": 24, "margin": 1.02, "layers": layers}
    keys = ROUND | {"sphere": cloud | {"outer_radius": outer}, "limiter": "van_albada"}
    params, mistakes = read(MeshlessGasParams, keys, "gas")
    assert not mistakes
    gas = run(MeshlessGas(params), 1.0)
    assert ("boundaries.far" in gas.warnings()) is is_warned
    drag = output(gas, "body.drag_coefficient")[0]
    assert (abs(drag / 0.875 - 1.0) < 0.02) is not is_warned  # that of 128 layers and margin 1.35


@pytest.mark.parametrize(
    ("keys", "sentence"),
    [
        ({"probes": [[0.5, 0.0, 0.5], [0.5, 0.0, 1.2]]}, "probes, item 1"),
        ({"fronts": [{"begin": [0, 0, 0.5], "end": [3, 0, 0.5], "level": 1.0}]}, "item 0: end"),
    ],
)
def test_places_outside_the_box_are_refused_before_the_start(keys, sentence):
    box = {"lowest": [0.0] * 3, "highest": [1.0, 0.0, 1.0], "spacing": 0.1}
    table = {"box": box, "initial": {"density": 1.0, "pressure": 1.0}, **keys}
    (mistake,) = read(MeshlessGasParams, table, "gas")[1]
    assert sentence in mistake and "among the nodes" in mistake


def test_a_front_that_is_not_met_has_numbers_of_none():
    lines = [
        {"begin": [0.1, 0.0, 0.5], "end": [0.9, 0.0, 0.5], "level": level} for level in (0.5, 5.0)
    ]
    gas = run(tube(50, *SOD, box={"highest": [1.0, 0.0, 1.0]}, fronts=lines), 0.05)
    assert list(output(gas, "fronts.found")) == [1.0, 0.0]
    assert output(gas, "fronts.distance")[0] > 0.0 > output(gas, "fronts.distance")[1]
    assert output(gas, "fronts.angle")[1] == -np.pi
