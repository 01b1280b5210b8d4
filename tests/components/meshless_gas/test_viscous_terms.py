"""Friction and conduction on plain arrays: stresses, slopes at walls, loads on walls."""

import numpy as np
import pytest
from gases import gas_in_box, run

from quintet.components.meshless_gas.clouds.box import box
from quintet.components.meshless_gas.kernels.gradients import write_gradients
from quintet.components.meshless_gas.laws.transport import Transport
from quintet.components.meshless_gas.stencils import nearest_neighbours, stencils
from quintet.components.meshless_gas.viscous.kernels.flux import (
    add_viscous,
    write_temperature_gradients,
    write_transport,
)
from quintet.components.meshless_gas.viscous.kernels.walls import write_no_slip_walls
from quintet.components.meshless_gas.viscous.laws import wall_slope
from quintet.components.shared.threads import Team

# Of a viscosity that hardly changes.
LAW = Transport(0.02, 1.0, 0.0, 3.5 / 0.72, 1.0)


def rates(x: np.ndarray, velocity: np.ndarray, temperature: np.ndarray) -> np.ndarray:
    """Viscous rates (n, 5) of a lattice of nodes in the plane."""
    cloud = box((0, 0, 0), (1, 0, 1), 0.1, dict.fromkeys(("x-", "x+", "z-", "z+"), "slip"),
                dict.fromkeys(("x-", "x+", "z-", "z+"), 1))  # fmt: skip
    near = nearest_neighbours(cloud, 8, Team(1))
    coefficients = stencils(cloud, near, True, Team(1)).coefficients
    x[:] = cloud.positions
    n = len(cloud.positions)
    rows = np.arange(n, dtype=np.int32)
    primitive = np.ones((n, 5))
    primitive[:, 1:4] = velocity
    primitive[:, 4] = temperature
    gradients, lowest = np.zeros((n, 5, 3)), np.zeros(n)
    transported, slopes, residual = np.zeros((n, 2)), np.zeros((n, 3)), np.zeros((n, 5))
    write_gradients(0, n, rows, primitive, near, coefficients, True, gradients, lowest)
    write_transport(0, n, primitive, LAW, transported)
    write_temperature_gradients(0, n, rows, near, coefficients, transported, slopes)
    add_viscous(
        0, n, rows, cloud.positions, primitive, transported, near, coefficients, gradients, slopes,
        LAW, residual,
    )  # fmt: skip
    within = ((x[:, [0, 2]] > 0.15) & (x[:, [0, 2]] < 0.85)).all(axis=1)
    return np.asarray(residual[within])


@pytest.fixture(scope="module")
def places() -> np.ndarray:
    """Places of the lattice's nodes."""
    x = np.zeros((121, 3))
    rates(x, np.zeros((121, 3)), np.ones(121))
    return x


def test_gas_that_turns_as_a_whole_has_no_friction(places: np.ndarray) -> None:
    turning = np.cross([0.0, 2.0, 0.0], places)
    assert rates(np.empty_like(places), turning, np.ones(121)) == pytest.approx(0.0, abs=1e-12)


def test_parabola_of_velocity_is_slowed_by_twice_its_viscosity(places: np.ndarray) -> None:
    z = places[:, 2]
    flow = np.stack([z * z, 0.0 * z, 0.0 * z], axis=1)
    viscous_rates = rates(np.empty_like(places), flow, np.ones(121))
    assert viscous_rates[:, 1] == pytest.approx(2.0 * LAW.viscosity, rel=1e-9)
    assert viscous_rates[:, [0, 2, 3]] == pytest.approx(0.0, abs=1e-12)


def test_heat_flows_down_a_slope_and_gathers_in_a_hollow(places: np.ndarray) -> None:
    z = places[:, 2]
    still = np.zeros_like(places)
    level = rates(np.empty_like(places), still, 1.0 + 1e-6 * z)
    assert level[:, 4] == pytest.approx(0.0, abs=1e-10)
    hollow = rates(np.empty_like(places), still, 1.0 + 1e-6 * z * z)
    assert hollow[:, 4] == pytest.approx(2e-6 * LAW.conduction * LAW.viscosity, rel=1e-4)


def test_slope_at_a_wall_is_that_of_a_parabola() -> None:
    def curve(y: float) -> float:
        return 2.0 + 3.0 * y - 0.5 * y * y

    assert wall_slope.py_func(curve(0.0), curve(0.1), curve(0.25), 0.1, 0.25) == pytest.approx(3.0)
    assert wall_slope.py_func(2.0, 2.3, 2.3, 0.1, 0.1) == pytest.approx(
        3.0
    )  # one node above it alone


@pytest.mark.parametrize(
    ("mach", "ratio"),
    [
        (0.4, 1.0),
        # Toro (2009), section 6.3.3: the shock that stops a stream of Mach 2, of γ = 1.4.
        (2.0, 1.0 + 2.8 * (1.2 + np.sqrt(2.44))),
    ],
)
def test_a_wall_without_slip_stops_a_fast_stream_by_a_shock(mach: float, ratio: float) -> None:
    primitive = np.ones((2, 5))
    primitive[1, 1:4] = [0.0, 0.0, -mach * np.sqrt(1.4)]
    write_no_slip_walls(
        np.array([0], np.int32), np.array([[1], [0]], np.int32), np.ones((1, 1)),
        np.array([[0.0, 0.0, 1.0]] * 2), np.zeros((1, 3)), np.array([2.0]), 1.4, LAW, primitive,
    )  # fmt: skip
    assert primitive[0] == pytest.approx([ratio / 2.0, 0.0, 0.0, 0.0, ratio])


def test_friction_that_is_faster_than_conduction_limits_the_step() -> None:
    thick = {"gas_constant": 1.0, "viscosity": 5.0, "sutherland": 0.0, "prandtl": 20.0}
    gas = gas_in_box(
        gas=thick | {"reference_temperature": 1.0}, viscous=True, neighbours=8,
        initial={"density": 1.0, "pressure": 1.0}, box={"jitter": 0.0, "highest": [1.0, 0.0, 1.0]},
    )  # fmt: skip
    velocities = gas.state.conservative[:, [1, 3]]  # of density 1
    velocities[:] = 1e-3 * np.random.default_rng(1).uniform(-1.0, 1.0, velocities.shape)
    gas.state.conservative[:, [1, 3]] = velocities
    run(gas, 20 * gas.stable_dt())
    assert np.abs(gas.state.primitive[:, 1:4]).max() < 2e-4
