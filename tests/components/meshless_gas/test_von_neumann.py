"""Von Neumann's analysis of waves with known limits, and of the predictions in scenes."""

import tomllib
from pathlib import Path

import numpy as np
import pytest

from quintet.components.meshless_gas.analysis.flow_limit import flow_limit, gas_of
from quintet.components.meshless_gas.analysis.von_neumann import (
    Fluid,
    block,
    cross,
    derivatives,
    largest,
    limit,
    to_conservative,
)

SCENES = Path(__file__).resolve().parents[3] / "scenarios"
STATE = np.array([1.0, 0.3, 0.0, 0.2, 1.0 / 1.4])


def test_runge_kutta_of_third_order_holds_to_its_known_limits_on_both_axes() -> None:
    assert largest(np.array([1j * 2.0])) == pytest.approx(np.sqrt(3.0) / 2.0, rel=0.02)
    assert largest(np.array([-2.0 + 0.0j])) == pytest.approx(2.5127 / 2.0, rel=2e-3)


def test_derivatives_of_the_flux_add_up_to_those_of_the_euler_equations() -> None:
    normal = np.array([0.6, 0.0, 0.8])
    jacobian = np.linalg.inv(to_conservative(STATE, 1.4)) @ sum(derivatives(STATE, normal, 1.4))
    speeds = np.sort(np.linalg.eigvals(jacobian).real)
    along = STATE[1:4] @ normal
    assert speeds == pytest.approx([along - 1.0, along, along, along, along + 1.0], abs=1e-6)


def test_first_order_along_one_line_holds_to_the_limit_of_upwind_differences() -> None:
    # Faster than sound every wave is carried by upwind differences: rates (exp(-iφ) - 1) u/h, that
    # are on a circle; the third-order scheme holds on it to 1.256. The bound's sum counts both
    # neighbours, u + a each over half of the spacing.
    courant_limit = limit(cross(ratio=1e6), np.array([50.0, 0.0, 0.0]), slopes=0.0)
    assert courant_limit == pytest.approx(1.256, rel=0.03)


@pytest.mark.parametrize("prandtl", [0.3, 20.0])
def test_diffusion_holds_to_the_limit_of_the_real_axis(prandtl: float) -> None:
    # Along one line: rates -4 D/h² at most, over a bound of 2 D/h²; D is γμ/(Pr ρ) where heat is
    # faster than friction, else 4/3 μ/ρ.
    slow = Fluid(viscosity=1e3, prandtl=prandtl)
    courant_limit = limit(cross(ratio=1e6), np.array([1e-3, 0.0, 1e-3]), 1.0, slow)
    assert courant_limit == pytest.approx(2.5127 / 2.0, rel=0.02)


def test_slopes_raise_the_limit_on_a_block_of_neighbours() -> None:
    stream = np.array([0.731, 0.0, 0.001])
    assert 1.7 < limit(block(), stream, 0.0) < 1.9 < limit(block(), stream, 1.0) < 2.4


@pytest.mark.full
@pytest.mark.parametrize(
    ("scene", "name"),
    [
        ("vortex", "Courant number"),
        ("couette", "Courant number"),
        ("flat_plate", "Courant number"),
        ("blunt_sphere", "Courant number with friction"),
    ],
)
def test_scenes_predict_what_the_analysis_of_their_flow_says(scene: str, name: str) -> None:
    path = SCENES / scene / "scene.toml"
    gas, limit_of_scene = gas_of(path, name)
    while gas.state.time < limit_of_scene["end"] and np.isfinite(dt := gas.stable_dt()):
        gas.step(dt)
    predictions = tomllib.loads(path.read_text())["stability"]
    (predicted,) = (
        prediction["predicted"] for prediction in predictions if prediction["name"] == name
    )
    assert flow_limit(gas)[0] == pytest.approx(np.max(predicted), rel=0.02)
