"""States of outflow nodes: of second order in smooth gas, else within those nearby."""

import numpy as np
import pytest
from gases import gas_in_box, state

from quintet.components.meshless_gas.component import MeshlessGas
from quintet.interfaces.component import Array


def stream(speed: float) -> MeshlessGas:
    """A jittered box that a stream leaves through its end at x = 1."""
    inflow = state(1.0, speed, 1.0)
    sides = {"x-": {"kind": "inflow", "state": inflow}, "x+": {"kind": "outflow"}}
    return gas_in_box(
        box={"highest": [1.0, 0.0, 0.5]}, initial=inflow, boundaries=sides, neighbours=8
    )


def outflow_states(gas: MeshlessGas, states: Array) -> tuple[Array, Array]:
    """States (o, 5) that outflow nodes have among others, and those that they should have."""
    nodes, rows = gas.motion.domain.cloud.nodes, gas.motion.domain.outflows.rows
    gas.fluxes.primitive[:nodes] = states
    gas.scheme.apply_boundaries()
    return gas.fluxes.primitive[rows], states[rows]


def test_what_leaves_faster_than_sound_goes_on_as_a_plane() -> None:
    gas = stream(3.0)
    x = gas.motion.domain.cloud.positions[: gas.motion.domain.cloud.nodes, 0]
    plane = np.stack([1.0 + 0.1 * x, 3.0 + 0.2 * x, 0.0 * x, 0.1 * x, 1.0 - 0.1 * x], axis=1)
    states, expected = outflow_states(gas, plane)
    assert states == pytest.approx(expected, abs=1e-12)


def test_a_wave_against_slower_gas_is_not_continued() -> None:
    gas = stream(0.5)
    x = gas.motion.domain.cloud.positions[: gas.motion.domain.cloud.nodes, 0]
    sound = np.sqrt(1.4)
    slope = 0.01 * (x - 1.0)
    rest = np.stack([1.0 + 0.0 * x, 0.5 + 0.0 * x, 0.0 * x, 0.0 * x, 1.0 + 0.0 * x], axis=1)
    leaving = np.array([1.0 / 1.4, 1.0 / sound, 0.0, 0.0, 1.0])  # δρ, δu and δp of a wave outwards
    states, expected = outflow_states(gas, rest + slope[:, None] * leaving)
    # Its coefficients are those of the node before.
    assert states == pytest.approx(expected, abs=2e-5)
    coming = np.array([1.0 / 1.4, -1.0 / sound, 0.0, 0.0, 1.0])
    states, expected = outflow_states(gas, rest + slope[:, None] * coming)
    assert np.abs(states - expected)[:, 4].min() > 5e-4  # as the gas before it: of first order


def test_behind_a_shock_states_stay_within_those_near() -> None:
    gas = stream(3.0)
    x = gas.motion.domain.cloud.positions[: gas.motion.domain.cloud.nodes, 0]
    before, behind = np.array([1.0, 3.0, 0.0, 0.0, 1.0]), np.array([3.0, 1.0, 0.0, 0.0, 9.0])
    states, _ = outflow_states(gas, np.where((x > 0.87)[:, None], behind, before))
    assert (states[:, 4] >= 1.0 - 1e-12).all() and (states[:, 4] <= 9.0 + 1e-12).all()
    assert (states[:, 0] >= 1.0 - 1e-12).all() and (states[:, 0] <= 3.0 + 1e-12).all()
