"""Boxes with finer parts: their nodes, and flows across where the spacing doubles."""

import numpy as np
import pytest
from gases import SOD, gas_in_box, output, run, state, tube

from quintet.components.meshless_gas import stencils
from quintet.components.meshless_gas.bench import vortex
from quintet.components.meshless_gas.component import MeshlessGas
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.components.meshless_gas.stencils import graded_neighbours
from quintet.components.shared.threads import Team
from quintet.interfaces.params import read

FINER = ((0.4, 0.62), (0.72, 0.78))  # m
AIR = {"density": 1.0, "pressure": 1.0}


def part(low, high, **keys):
    return {"lowest": [low] * 3, "highest": [high] * 3} | keys


def refined_vortex(nodes, *parts):
    table = vortex(nodes)
    table["box"]["refinements"] = list(parts)
    params, mistakes = read(MeshlessGasParams, table, "gas")
    assert not mistakes, mistakes
    return MeshlessGas(params)


def test_spacings_double_level_by_level_and_volumes_fill_the_box():
    gas = gas_in_box(
        initial=AIR, box={"spacing": 0.05, "refinements": [part(0.45, 0.55, levels=3)], "jitter": 0}
    )
    cloud, params = gas.motion.domain.cloud, gas.params
    spacing = cloud.spacing[: gas.items()]
    assert cloud.volumes.sum() == pytest.approx(1.0, rel=1e-12)
    assert np.unique(spacing) == pytest.approx([0.00625, 0.0125, 0.025, 0.05])
    middle = np.abs(cloud.positions[: gas.items(), ::2] - 0.5).max(axis=1) < 0.05
    assert spacing[middle] == pytest.approx(0.00625)
    beside = cloud.spacing[gas.motion.domain.stencils.neighbours[: gas.items()]]
    assert beside.max() / beside.min() > 7.0
    assert (beside <= 2.001 * spacing[:, None]).all()
    assert (beside >= 0.499 * spacing[:, None]).all()
    assert gas.items() == pytest.approx(params.expected_count, rel=0.2)
    assert params.box.finest_spacing == pytest.approx(0.00625)


def test_nodes_beside_finer_ones_are_surrounded():
    gas = gas_in_box(
        initial=AIR, box={"spacing": 0.05, "refinements": [part(0.3, 0.7)], "jitter": 0},
        neighbours=9,
    )  # fmt: skip
    cloud, near = gas.motion.domain.cloud, gas.motion.domain.stencils.neighbours
    arms = cloud.positions[near[: gas.items()]] - cloud.positions[: gas.items(), None]
    for axis in (0, 2):
        for sign in (-1.0, 1.0):
            assert ((sign * arms[:, :, axis] > 0.0).sum(axis=1) >= 2).all()


def test_neighbours_are_those_of_the_whole_cloud_however_many_are_ordered_at_a_time(monkeypatch):
    cloud = gas_in_box(initial=AIR, box={"refinements": [part(0.3, 0.7)]}).motion.domain.cloud
    assert len(cloud.owner) > 0
    all_neighbours = graded_neighbours(cloud, 9, Team(1))
    monkeypatch.setattr(stencils, "BLOCK", 37)
    assert np.array_equal(graded_neighbours(cloud, 9, Team(1)), all_neighbours)
    assert (
        all_neighbours[cloud.nodes :] == np.arange(cloud.nodes, len(all_neighbours))[:, None]
    ).all()


def test_a_vortex_into_a_finer_part_gains_by_it():
    coarse, into, within = (
        output(run(refined_vortex(24, *parts), 2.0), "error.density")[0]
        for parts in ((), (part(6.0, 9.0),), (part(3.0, 9.0, levels=1),))
    )
    assert into < 0.85 * coarse
    assert within < 0.25 * coarse


def test_waves_of_a_tube_pass_into_finer_parts_and_out_of_them():
    refinements = [{"lowest": [a, 0.0, -1.0], "highest": [b, 0.0, 1.0]} for a, b in FINER]
    gas = tube(100, *SOD, box={"refinements": refinements})
    run(gas, 0.2)
    density, pressure = gas.state.primitive[:, 0], gas.state.primitive[:, 4]
    assert output(gas, "error.density")[0] < 7.0e-3  # 7.1e-3 without finer parts
    assert density.max() < 1.0 + 2e-3 and density.min() > 0.125 - 2e-3
    assert pressure.min() > 0.1 - 2e-3
    assert abs(output(gas, "balance.mass_drift")[0]) < 1e-3


@pytest.mark.full  # kernels in space
def test_a_stream_in_space_stays_as_it_is_where_the_spacing_doubles():
    wind = AIR | {"velocity": [1.5, 0.5, -0.3]}
    gas = gas_in_box(
        dimensions=3, neighbours=14, initial=wind,
        box={"spacing": 0.1, "refinements": [part(0.35, 0.65)]},
    )  # fmt: skip
    assert gas.motion.domain.cloud.volumes.sum() == pytest.approx(1.0, rel=1e-12)
    run(gas, 0.1)
    exact = np.tile([1.0, 1.5, 0.5, -0.3, 1.0], (gas.items(), 1))
    assert gas.state.primitive == pytest.approx(exact, abs=1e-12)


@pytest.mark.parametrize(
    ("low", "high", "keys", "sentence"),
    [
        (0.5, 0.4, {}, "highest corner must lie beyond"),
        (0.1, 0.4, {"levels": 2}, "too near to the face x-"),
        (1.2, 1.4, {}, "outside of the box"),
    ],
)
def test_parts_that_cannot_be_finer_are_refused(low, high, keys, sentence):
    inflow = {"kind": "inflow", "state": state(1.0, 1.0, 1.0)}
    table = {
        "initial": AIR,
        "boundaries": {"x-": inflow, "x+": {"kind": "outflow"}},
        "box": {"lowest": [0.0] * 3, "highest": [1.0] * 3, "spacing": 0.05}
        | {"refinements": [part(low, high, **keys)]},
    }
    mistakes = read(MeshlessGasParams, table, "gas")[1]
    assert any(sentence in mistake for mistake in mistakes), mistakes
