"""Gas in three dimensions, and in frames that move."""

import numpy as np
import pytest
from gases import SOD, gas_in_box, output, run, state, tube

from quintet.components.meshless_gas.kernels.gradients import write_gradients
from quintet.components.meshless_gas.kernels.residuals import write_residuals
from quintet.components.meshless_gas.laws.limiters import limiter_of

pytestmark = pytest.mark.full  # kernels of their own


def test_a_tube_in_space_is_that_in_a_plane():
    sides = [state(*side) for side in SOD]
    ends = zip(("x-", "x+"), sides, strict=True)
    spacing = 1.0 / 49
    gas = gas_in_box(
        dimensions=3,
        neighbours=18,
        box={"highest": [1.0, 5.0 * spacing, 5.0 * spacing], "spacing": spacing, "jitter": 0.2},
        riemann={"position": 0.5, "left": sides[0], "right": sides[1]},
        boundaries={name: {"kind": "inflow", "state": side} for name, side in ends},
    )
    run(gas, 0.2)
    plane = run(tube(50, *SOD), 0.2)
    error, plane_error = (output(solver, "error.density")[0] for solver in (gas, plane))
    assert error == pytest.approx(plane_error, rel=0.25)
    assert abs(output(gas, "balance.mass_drift")[0]) < 2e-3


def test_gas_at_rest_between_planes_of_symmetry_stays_so_in_space():
    sides = {f"{axis}{side}": {"kind": "symmetry"} for axis in "yz" for side in "-+"}
    gas = gas_in_box(
        dimensions=3, neighbours=14, box={"spacing": 0.2},
        initial={"density": 1.0, "pressure": 1.0}, boundaries=sides,
    )  # fmt: skip
    run(gas, 0.5)
    at_rest = np.tile([1.0, 0.0, 0.0, 0.0, 1.0], (gas.items(), 1))
    assert gas.state.primitive == pytest.approx(at_rest, abs=1e-12)


def rates(gas, primitive, frame):
    """Gradients, then residuals of some states."""
    domain, cloud = gas.motion.domain, gas.motion.domain.cloud
    gradients, lowest = np.zeros((len(primitive), 5, 3)), np.zeros(len(primitive))
    rows = np.arange(len(primitive), dtype=np.int32)
    write_gradients(0, len(rows), rows, primitive, *domain.stencils, None, gradients, lowest)
    residual = np.zeros((len(primitive), 5))
    write_residuals(
        0, len(domain.inner), domain.inner, cloud.positions, primitive, gradients, lowest,
        *domain.stencils, frame, None, True, gas.params.gas.gamma, limiter_of("van_albada", 1e-6),
        residual,
    )  # fmt: skip
    return residual[domain.inner]


def test_nodes_that_move_with_the_gas_see_what_those_at_rest_see():
    sides = {f"{axis}{side}": {"kind": "slip"} for axis in "xyz" for side in "-+"}
    gas = gas_in_box(
        dimensions=3, neighbours=14, box={"spacing": 0.25},
        initial={"density": 1.0, "pressure": 1.0}, boundaries=sides,
    )  # fmt: skip
    rng = np.random.default_rng(5)
    still = rng.uniform(0.9, 1.1, gas.fluxes.primitive.shape)
    moving, speed = still.copy(), np.array([3.0, -2.0, 1.0])
    moving[:, 1:4] += speed
    frame = np.tile(speed, (len(still), 1))
    mass, *momentum, energy = rates(gas, still, None).T
    moving_rates = rates(gas, moving, frame).T
    assert moving_rates[0] == pytest.approx(mass, abs=1e-11)
    for axis in range(3):
        assert moving_rates[1 + axis] == pytest.approx(
            momentum[axis] + speed[axis] * mass, abs=1e-10
        )
    carried = speed @ np.array(momentum) + 0.5 * speed @ speed * mass
    assert moving_rates[4] == pytest.approx(energy + carried, abs=1e-10)
