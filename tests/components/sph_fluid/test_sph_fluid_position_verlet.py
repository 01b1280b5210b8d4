"""Position Verlet beside the scheme of one pass: order, energy, momentum, limit."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from quintet.components.sph_fluid.component import SphFluid
from quintet.interfaces.component import Fields
from quintet.interfaces.errors import QuintetError

Make = Callable[..., SphFluid]
Join = Callable[..., Fields]
Strike = Callable[..., tuple[Any, Any]]
EDGE = 0.12  # m, of the drop
TIME = 0.02  # s, in which sound crosses it three times
FREE = {"gravity": (0.0, 0.0, 0.0), "negative_pressure": True}


def stretch(fluid: SphFluid) -> None:
    """Set a drop into smooth motion."""
    place, motion = fluid.state.position_density[:, :3] / EDGE - 0.5, fluid.state.velocity_pressure
    motion[:, 0] = 0.2 * place[:, 0] * np.cos(place[:, 1])
    motion[:, 2] = -0.2 * place[:, 2] + 0.1 * np.sin(math.pi * place[:, 0])


def energy(fluid: SphFluid) -> float:
    totals = fluid.totals()
    return totals.kinetic + totals.internal


def swing(fluid: SphFluid, steps: int) -> np.ndarray:
    stretch(fluid)
    for _ in range(steps):
        fluid.step(TIME / steps)
    return np.asarray(fluid.view()["points"])


@pytest.mark.parametrize(("integration", "order"), [("symplectic", 2), ("extrapolated", 1)])
def test_order_in_time(drop: Make, integration: str, order: int) -> None:
    exact = swing(drop(integration="symplectic", **FREE), 1600)
    errors = [
        math.sqrt(((swing(drop(integration=integration, **FREE), steps) - exact) ** 2).mean())
        for steps in (100, 200)
    ]
    assert math.log2(errors[0] / errors[1]) == pytest.approx(order, abs=0.2)
    assert errors[1] < 1e-4 * EDGE


def test_without_viscosity_energy_stays(drop: Make) -> None:
    losses = {}
    for integration in ("symplectic", "extrapolated"):
        fluid = drop(integration=integration, viscosity__artificial=0.0, **FREE)
        stretch(fluid)
        before = energy(fluid)
        for _ in range(400):
            fluid.step(fluid.stable_dt())
        losses[integration] = abs(energy(fluid) / before - 1.0)
    assert losses["symplectic"] < 2e-5
    assert losses["symplectic"] < 0.02 * losses["extrapolated"]


@pytest.mark.parametrize("changes", [{"xsph": 0.5}, {"viscosity.kinematic": 1e-3}])
def test_one_step_gives_and_takes_the_same_impulse(
    drop: Make, plate: Join, struck: Strike, changes: dict[str, float]
) -> None:
    fluid = drop(integration="symplectic", gravity=(0.0, 0.0, 0.0), **changes)
    impulse, gained = struck(fluid, plate(fluid))
    assert np.abs(impulse[:, 2]).sum() > 0.0
    assert impulse.sum(axis=0) == pytest.approx(-gained, abs=1e-12 * np.abs(impulse).sum())


def test_free_fall_is_a_parabola(drop: Make) -> None:
    fluid = drop(integration="symplectic")
    before = fluid.view()["points"].copy()
    for _ in range(100):
        fluid.step(1e-3)
    fallen = fluid.view()["points"].mean(axis=0) - before.mean(axis=0)
    assert fallen == pytest.approx([0.0, 0.0, -0.5 * 9.81 * 0.1**2], abs=1e-9)


@pytest.mark.parametrize("boundary", ["dbc", "mdbc"])
@pytest.mark.parametrize(("courant", "calm"), [(1.4, True), (2.5, False)])
def test_step_limit_is_where_rest_becomes_unstable(
    pool: Make, boundary: str, courant: float, calm: bool
) -> None:
    fluid = pool(integration="symplectic", courant=courant, boundary__method=boundary)
    weight = fluid.totals().mass * 9.81 * 0.1
    try:
        remaining = 0.3
        while remaining > 0.0:
            dt = fluid.stable_dt()
            fluid.step(dt)
            remaining -= dt
    except QuintetError:
        assert not calm
    assert (fluid.totals().kinetic < 1e-3 * weight) is calm


@pytest.mark.parametrize("damper", [0.0, 0.5])
def test_a_saved_state_goes_on_with_the_same_bits(pool: Make, damper: float) -> None:
    settings = {
        "integration": "symplectic",
        "boundary.method": "mdbc",
        "density_diffusion": 0.1,
        "acoustic_damper": damper,
    }
    first, second = pool(**settings), pool(**settings)
    for _ in range(20):
        first.step(first.stable_dt())
    second.load(first.save())
    for fluid in (first, second):
        for _ in range(20):
            fluid.step(fluid.stable_dt())
    first_state, second_state = first.save(), second.save()
    assert all(np.array_equal(first_state[name], second_state[name]) for name in first_state)
