"""States of nodes where gas leaves: of second order where it is smooth, else of what is near."""

import numpy as np
import pytest
from gases import gas, state

from quintet.components.meshless_gas.component import MeshlessGas
from quintet.interfaces.component import Array


def stream(speed: float) -> MeshlessGas:
    """A jittered box that a stream leaves through its end at x = 1."""
    one = state(1.0, speed, 1.0)
    sides = {"x-": {"kind": "inflow", "state": one}, "x+": {"kind": "outflow"}}
    return gas(box={"highest": [1.0, 0.0, 0.5]}, initial=one, boundaries=sides, neighbours=8)


def continued(made: MeshlessGas, states: Array) -> tuple[Array, Array]:
    """States (o, 5) that outflow nodes have among others, and those that they should have."""
    nodes, rows = made.motion.domain.cloud.nodes, made.motion.domain.outflows.rows
    made.fluxes.primitive[:nodes] = states
    made.scheme.apply_boundaries()
    return made.fluxes.primitive[rows], states[rows]


def test_what_leaves_faster_than_sound_goes_on_as_a_plane() -> None:
    made = stream(3.0)
    x = made.motion.domain.cloud.positions[: made.motion.domain.cloud.nodes, 0]
    plane = np.stack([1.0 + 0.1 * x, 3.0 + 0.2 * x, 0.0 * x, 0.1 * x, 1.0 - 0.1 * x], axis=1)
    found, wanted = continued(made, plane)
    assert found == pytest.approx(wanted, abs=1e-12)


def test_a_wave_against_slower_gas_is_not_continued() -> None:
    made = stream(0.5)
    x = made.motion.domain.cloud.positions[: made.motion.domain.cloud.nodes, 0]
    sound = np.sqrt(1.4)
    slope = 0.01 * (x - 1.0)
    rest = np.stack([1.0 + 0.0 * x, 0.5 + 0.0 * x, 0.0 * x, 0.0 * x, 1.0 + 0.0 * x], axis=1)
    leaving = np.array([1.0 / 1.4, 1.0 / sound, 0.0, 0.0, 1.0])  # δρ, δu and δp of a wave outwards
    found, wanted = continued(made, rest + slope[:, None] * leaving)
    assert found == pytest.approx(wanted, abs=2e-5)  # its coefficients are those of the node before
    coming = np.array([1.0 / 1.4, -1.0 / sound, 0.0, 0.0, 1.0])
    found, wanted = continued(made, rest + slope[:, None] * coming)
    assert np.abs(found - wanted)[:, 4].min() > 5e-4  # as the gas before it: of first order


def test_behind_a_shock_states_stay_within_those_near() -> None:
    made = stream(3.0)
    x = made.motion.domain.cloud.positions[: made.motion.domain.cloud.nodes, 0]
    before, behind = np.array([1.0, 3.0, 0.0, 0.0, 1.0]), np.array([3.0, 1.0, 0.0, 0.0, 9.0])
    found, _ = continued(made, np.where((x > 0.87)[:, None], behind, before))
    assert (found[:, 4] >= 1.0 - 1e-12).all() and (found[:, 4] <= 9.0 + 1e-12).all()
    assert (found[:, 0] >= 1.0 - 1e-12).all() and (found[:, 0] <= 3.0 + 1e-12).all()
