"""One-sided neighbourhoods are detected, and completed with more neighbours or refused."""

import numpy as np
import pytest
from gases import GAMMA, SOD, gas_in_box, output, run, state, tube

from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.components.meshless_gas.sidedness import EVEN, UNEVEN, sidedness
from quintet.components.shared.threads import Team
from quintet.interfaces.errors import SceneError, StepError
from quintet.interfaces.params import read

AIR = {"density": 1.0, "pressure": 1.0}
MACH_3 = {"density": 1.0, "velocity": [2.8977775, 0.0, -0.7764571], "pressure": 1.0 / GAMMA}


def worst(gas):
    domain = gas.motion.domain
    return sidedness(domain.cloud, domain.stencils, domain.inner, gas.params.planar, Team(1)).max()


def periodic(**keys):
    return gas_in_box(initial=AIR, **keys)


def stream_over_a_wedge(**keys):
    """Mach 3 meets a wedge of 15 degrees; pressure behind the shock is 2.8216 of that ahead."""
    wind = {"kind": "inflow", "state": MACH_3}
    box = {"highest": [1.0, 0.0, 0.5], "spacing": 0.05} | keys.pop("box")
    ends = {"x-": wind, "z+": wind, "x+": {"kind": "outflow"}, "z-": {"kind": "symmetry"}}
    return gas_in_box(initial=MACH_3, boundaries=ends, box=box, probes=[[0.8, 0.0, 0.07]], **keys)


@pytest.mark.parametrize(
    ("dimensions", "neighbours"), [(2, 4), (2, 8), (2, 12), (2, 20), (3, 6), (3, 18), (3, 26)]
)
def test_whole_shells_of_a_lattice_are_not_one_sided(dimensions, neighbours):
    gas = periodic(
        dimensions=dimensions, neighbours=neighbours, box={"jitter": 0.0, "spacing": 0.2}
    )
    assert worst(gas) == pytest.approx(0.0, abs=1e-9)
    assert gas.motion.domain.stencils.neighbours.shape[1] == neighbours and gas.notes() == ()


@pytest.mark.parametrize(
    ("dimensions", "neighbours", "complete"), [(2, 3, 4), (2, 9, 12), (3, 9, 18), (3, 14, 18)]
)
def test_a_shell_of_a_lattice_that_is_cut_is_completed_and_told(dimensions, neighbours, complete):
    gas = periodic(
        dimensions=dimensions, neighbours=neighbours, box={"jitter": 0.0, "spacing": 0.2}
    )
    assert gas.motion.domain.stencils.neighbours.shape[1] == complete
    assert worst(gas) == pytest.approx(0.0, abs=1e-9)
    (note,) = gas.notes()
    assert f"the {neighbours} nearest" in note and "Leave neighbours out" in note


@pytest.mark.parametrize("jitter", [0.0, 0.3, 0.6, 0.9])
@pytest.mark.parametrize("dimensions", [2, 3])
def test_neighbours_that_are_not_asked_for_surround_each_node(dimensions, jitter):
    gas = periodic(dimensions=dimensions, box={"jitter": jitter, "spacing": 0.1 * (dimensions - 1)})
    near = gas.motion.domain.stencils.neighbours
    assert worst(gas) <= (EVEN if jitter < 0.6 else UNEVEN)
    count = (near[: gas.items()] != np.arange(gas.items())[:, None]).sum(axis=1)
    assert np.median(count) <= (12 if dimensions == 2 else 30) and gas.notes() == ()


@pytest.mark.parametrize("neighbours", [3, 4, 8, 9])
def test_one_sided_nodes_take_more_neighbours_and_are_counted(neighbours):
    gas = periodic(neighbours=neighbours, box={"jitter": 0.9, "spacing": 0.05})
    assert worst(gas) <= UNEVEN
    (note,) = gas.notes()
    assert "of 400 nodes lie mostly on one side" in note and "lower jitter" in note


def test_a_stream_through_nodes_moved_at_random_meets_the_exact_shock():
    gas = run(stream_over_a_wedge(neighbours=8, box={"jitter": 0.9}), 0.8)
    assert output(gas, "probes.pressure")[0] * GAMMA == pytest.approx(2.8216, rel=0.06)


def test_many_neighbours_do_not_change_what_surrounds_nodes_evenly():
    gas = periodic(neighbours=9, box={"jitter": 0.3})
    assert gas.motion.domain.stencils.neighbours.shape[1] == 9 and gas.notes() == ()


def test_neighbours_are_told_of_a_resumed_gas_too():
    gas, resumed = (periodic(neighbours=9, box={"jitter": 0.0}) for _ in range(2))
    resumed.load(gas.save())
    assert resumed.notes() == gas.notes() != ()


def test_a_failed_step_below_the_limit_does_not_advise_a_lower_courant_number():
    gas = tube(50, *SOD)
    gas.fluxes.primitive[gas.motion.domain.inner[0], 4] = 1e-300
    with pytest.raises(StepError) as error:
        gas.scheme.write_rates(0.0, (0.0, 1.0, 1.0))
        gas.state.conservative[:, 4] = 0.0
        gas.step(0.5 * gas.scheme.shortest_step)
    assert "courant" not in str(error.value) and "order = 1" in str(error.value)


ROUND = {
    "axisymmetric": True,
    "sphere": {"radius": 1.0, "points_around": 16, "layers": {"count": 12, "line_stencils": False}},
    "initial": state(1.0, 6.0, 1.0 / GAMMA),
    "boundaries": {
        "wall": {"kind": "symmetry"},
        "far": {"kind": "inflow", "state": state(1.0, 6.0, 1.0 / GAMMA)},
        "exit": {"kind": "outflow"},
    },
}


def layers(**keys):
    sphere = ROUND["sphere"] | {"layers": ROUND["sphere"]["layers"] | keys}
    params, mistakes = read(MeshlessGasParams, ROUND | {"sphere": sphere}, "gas")
    if mistakes:
        raise SceneError(mistakes[0])
    from quintet.components.meshless_gas.component import MeshlessGas

    return MeshlessGas(params)


def test_layers_moved_far_at_random_are_warned_of():
    assert layers().warnings() == {} == layers(jitter=0.1).warnings()
    assert "Lower layers.jitter" in layers(jitter=0.6).warnings()["neighbours"]


def test_derivatives_along_lines_of_nodes_go_with_nodes_on_these_lines():
    with pytest.raises(SceneError, match="say line_stencils = false"):
        layers(line_stencils=True, jitter=0.1)
