"""Gas in three dimensions, and in frames that move."""

import numpy as np
import pytest
from gases import SOD, gas, given, run, state, tube

from quintet.components.meshless_gas.kernels.gradients import write_gradients
from quintet.components.meshless_gas.kernels.residuals import write_residuals
from quintet.components.meshless_gas.laws.limiters import VanAlbada

pytestmark = pytest.mark.full  # kernels of their own


def test_a_tube_in_space_is_that_in_a_plane():
    sides = [state(*one) for one in SOD]
    ends = zip(("x-", "x+"), sides, strict=True)
    spacing = 1.0 / 49
    made = gas(
        dimensions=3,
        neighbours=18,
        box={"highest": [1.0, 5.0 * spacing, 5.0 * spacing], "spacing": spacing, "jitter": 0.2},
        riemann={"position": 0.5, "left": sides[0], "right": sides[1]},
        boundaries={name: {"kind": "inflow", "state": one} for name, one in ends},
    )
    run(made, 0.2)
    plane = run(tube(50, *SOD), 0.2)
    error, other = (given(one, "error.density")[0] for one in (made, plane))
    assert error == pytest.approx(other, rel=0.25)
    assert abs(given(made, "balance.mass_drift")[0]) < 2e-3


def test_gas_at_rest_between_planes_of_symmetry_stays_so_in_space():
    sides = {f"{axis}{side}": {"kind": "symmetry"} for axis in "yz" for side in "-+"}
    made = gas(
        dimensions=3, neighbours=14, box={"spacing": 0.2},
        initial={"density": 1.0, "pressure": 1.0}, boundaries=sides,
    )  # fmt: skip
    run(made, 0.5)
    at_rest = np.tile([1.0, 0.0, 0.0, 0.0, 1.0], (made.items(), 1))
    assert made.state.primitive == pytest.approx(at_rest, abs=1e-12)


def rates(made, primitive, frame):
    """Gradients, then residuals of some states."""
    own, cloud = made.motion.domain, made.motion.domain.cloud
    gradients, lowest = np.zeros((len(primitive), 5, 3)), np.zeros(len(primitive))
    rows = np.arange(len(primitive), dtype=np.int32)
    write_gradients(0, len(rows), rows, primitive, *own.stencils, None, gradients, lowest)
    made_rates = np.zeros((len(primitive), 5))
    write_residuals(
        0, len(own.inner), own.inner, cloud.positions, primitive, gradients, lowest,
        *own.stencils, frame, None, True, made.params.gas.gamma, VanAlbada(1e-6), made_rates,
    )  # fmt: skip
    return made_rates[own.inner]


def test_nodes_that_move_with_the_gas_see_what_those_at_rest_see():
    sides = {f"{axis}{side}": {"kind": "slip"} for axis in "xyz" for side in "-+"}
    made = gas(
        dimensions=3, neighbours=14, box={"spacing": 0.25},
        initial={"density": 1.0, "pressure": 1.0}, boundaries=sides,
    )  # fmt: skip
    rng = np.random.default_rng(5)
    still = rng.uniform(0.9, 1.1, made.fluxes.primitive.shape)
    moving, speed = still.copy(), np.array([3.0, -2.0, 1.0])
    moving[:, 1:4] += speed
    frame = np.tile(speed, (len(still), 1))
    mass, *momentum, energy = rates(made, still, None).T
    found = rates(made, moving, frame).T
    assert found[0] == pytest.approx(mass, abs=1e-11)
    for axis in range(3):
        assert found[1 + axis] == pytest.approx(momentum[axis] + speed[axis] * mass, abs=1e-10)
    carried = speed @ np.array(momentum) + 0.5 * speed @ speed * mass
    assert found[4] == pytest.approx(energy + carried, abs=1e-10)
