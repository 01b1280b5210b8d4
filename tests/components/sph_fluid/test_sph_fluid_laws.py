"""Kernel, gradients, and the equations on lattices."""

from typing import Any

import numpy as np
import pytest
from fluid_params import fluid_params, pair_sums

from quintet.components.shared.search.cells import grid_around, sorted_into
from quintet.components.shared.search.neighbours import NeighbourLists, neighbours_within
from quintet.components.shared.threads import Team
from quintet.components.sph_fluid import laws
from quintet.components.sph_fluid.constants import pair_law
from quintet.components.sph_fluid.kernels import write_pressure
from quintet.components.sph_fluid.laws import PairLaw
from quintet.components.sph_fluid.pairs.shepard_filter import filter_density

REACH = 3.3  # spacings


def lattice(n: int, spacing: float, dimensions: int = 3) -> np.ndarray:
    """Points around the origin, sorted for `near`; in two dimensions, all y are equal."""
    line = (np.arange(n) - 0.5 * (n - 1)) * spacing
    axes = [line, line if dimensions == 3 else np.zeros(1), line]
    points = np.stack([a.ravel() for a in np.meshgrid(*axes, indexing="ij")], axis=1)
    order = sorted_into(points, grid_around(points, REACH * spacing))[2]
    return points[order]


def near(points: np.ndarray, spacing: float) -> NeighbourLists:
    return neighbours_within(REACH * spacing, points, len(points), Team(1))


def law(spacing: float, smoothing: float = 1.5, dimensions: int = 3, **changes: Any) -> PairLaw:
    box = ((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
    settings = {
        "spacing": spacing,
        "smoothing": smoothing,
        "sound_speed": 40.0,
        "viscosity.artificial": 0.0,
    }
    changes = {**settings, **{name.replace("__", "."): value for name, value in changes.items()}}
    return pair_law(fluid_params(fluid=(box,), dimensions=dimensions, **changes))


def rates(
    points: np.ndarray, velocity: np.ndarray, density: np.ndarray, fluid: PairLaw
) -> np.ndarray:
    """Acceleration and dρ/dt (n, 4) without gravity."""
    place = np.column_stack([points, density])
    motion = np.column_stack([velocity, np.zeros(len(points))])
    write_pressure(fluid.constants, place, motion)
    lists = near(points, fluid.constants.smoothing.length / 1.5).arrays
    return pair_sums(fluid, place, motion, lists, len(points))


def test_continuity_converges_to_the_divergence_at_second_order() -> None:
    errors = []
    for spacing in (0.1, 0.05):
        points = lattice(round(1.2 / spacing), spacing)
        velocity = np.zeros_like(points)
        velocity[:, 0] = np.sin(3.0 * points[:, 0])
        density_rate = rates(points, velocity, np.full(len(points), 1000.0), law(spacing))[:, 3]
        inside = (np.abs(points) < 0.15).all(axis=1)
        exact = -1000.0 * 3.0 * np.cos(3.0 * points[inside, 0])
        errors.append(np.abs(density_rate[inside] - exact).max() / 3000.0)
    assert errors[1] < 0.01
    assert errors[0] > 2.5 * errors[1]


def test_pressure_gradient_converges_at_second_order() -> None:
    errors = []
    for spacing in (0.1, 0.05):
        fluid = law(spacing)
        points = lattice(round(1.2 / spacing), spacing)
        # Small waves on a small pressure, for the lattice's mass per volume is ρ₀ exactly.
        pressure = 1000.0 * (2.0 + np.sin(3.0 * points[:, 0]))
        density = 1000.0 * (pressure / fluid.constants.stiffness + 1.0) ** (1.0 / 7.0)
        acceleration = rates(points, np.zeros_like(points), density, fluid)[:, 0]
        inside = (np.abs(points) < 0.15).all(axis=1)
        exact = -3.0 * np.cos(3.0 * points[inside, 0])
        errors.append(np.abs(acceleration[inside] - exact).max() / 3.0)
    assert errors[1] < 0.02
    assert errors[0] > 2.5 * errors[1]


def test_viscosity_acts_on_approach_only() -> None:
    terms = law(0.1).fluid._replace(artificial=1.0)
    assert laws.pair_pressure.py_func(0.0, -2.0, 1.0 / 2000.0, terms) == pytest.approx(1e-3)
    assert laws.pair_pressure.py_func(0.0, 2.0, 1.0 / 2000.0, terms) == 0.0


def test_pressure_is_cut_unless_it_may_be_negative() -> None:
    numbers = law(0.1).constants
    assert laws.tait.py_func(990.0, numbers) == 0.0
    assert laws.tait.py_func(990.0, law(0.1, negative_pressure=True).constants) < 0.0
    slope = (laws.tait.py_func(1000.001, numbers) - 0.0) / 0.001
    assert slope == pytest.approx(40.0**2, rel=1e-4)


def test_shepard_filter_keeps_a_uniform_density() -> None:
    points = lattice(6, 0.1)
    fluid = law(0.1)
    place = np.column_stack([points, np.full(len(points), 1003.0)])
    density = np.empty(len(points))
    lists = near(points, 0.1).arrays
    filter_density(0, len(points), place, lists, fluid.constants, density)
    assert density == pytest.approx(1003.0, rel=1e-12)
