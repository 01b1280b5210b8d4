"""Kinematic viscosity: its value in shear flow, and no effect on rigid rotation."""

from typing import Any

import numpy as np
import pytest
from fluid_params import pair_sums
from test_sph_fluid_laws import lattice, law, near

from quintet.components.sph_fluid.component import SphFluid
from quintet.components.sph_fluid.laws import KinematicViscosity
from quintet.interfaces.component import outputs_of

SPACING, NU = 0.05, 0.3
LAWS = {
    "laplacian": KinematicViscosity(True, None, 4.0 * NU),
    "stress": KinematicViscosity(True, True, 16.0 * NU),
}


def viscous_acceleration(
    points: np.ndarray, velocity: np.ndarray, viscosity: KinematicViscosity
) -> np.ndarray:
    """Acceleration (n, 3) m/s2 of a fluid in two dimensions without pressure."""
    fluid, count = law(SPACING, 1.5, 2), len(points)
    place = np.column_stack([points, np.full(count, 1000.0)])
    motion = np.column_stack([velocity, np.zeros(count)])
    lists = near(points, SPACING).arrays
    terms = fluid.fluid._replace(viscosity=viscosity)
    viscous_law = fluid._replace(fluid=terms, boundary=terms)  # compiled for other tests too
    return pair_sums(viscous_law, place, motion, lists, count)[:, :3]


@pytest.mark.parametrize("name", LAWS)
def test_shear_flow_feels_the_viscosity_asked_for(name: str) -> None:
    points, k = lattice(30, SPACING, 2), 3.0
    velocity = np.zeros_like(points)
    velocity[:, 0] = np.sin(k * points[:, 2] + 0.3)
    acceleration = viscous_acceleration(points, velocity, LAWS[name])[:, 0]
    inside = (np.abs(points) < 0.2).all(axis=1)
    u, a = velocity[inside, 0], acceleration[inside]
    assert -(a @ u) / (u @ u) / k**2 == pytest.approx(NU, rel=0.08)  # a = -νk²u


def test_stress_leaves_rigid_rotation_alone_up_to_the_free_surface() -> None:
    """Colagrossi et al., Phys. Rev. E 84 (2011) 026705: a Laplacian does not."""
    points = lattice(16, SPACING, 2)
    velocity = np.column_stack([points[:, 2], np.zeros(len(points)), -points[:, 0]])
    assert np.abs(viscous_acceleration(points, velocity, LAWS["stress"])).max() < 1e-9
    assert np.abs(viscous_acceleration(points, velocity, LAWS["laplacian"])).max() > 0.1


@pytest.mark.parametrize(
    ("name", "boundary"),
    [  # once; the others are compiled for themselves
        ("stress", "dbc"),
        pytest.param("laplacian", "mdbc", marks=pytest.mark.full),
        pytest.param("laplacian", "dbc", marks=pytest.mark.full),
        pytest.param("stress", "mdbc", marks=pytest.mark.full),
    ],
)
def test_surface_takes_the_momentum_that_friction_takes(
    drop: Any, plate: Any, name: str, boundary: str
) -> None:
    settings = {
        "viscosity.kinematic": 0.01,
        "viscosity.form": name,
        "boundary.method": boundary,
        "viscosity.artificial": 0.0,
    }
    fluid: SphFluid = drop(gravity=(0.0, 0.0, 0.0), **settings)
    fields = plate(fluid, speed=0.0)
    velocity = np.tile([0.5, 0.0, 0.0], (len(fields["surface.position"]), 1))
    mirror = fields["surface.position"] + [0.0, 0.0, 0.02]
    fluid.take(fields | {"surface.velocity": velocity, "surface.mirror": mirror})
    force, before = np.zeros(3), fluid.totals().momentum
    for _ in range(10):
        fluid.step(1e-4)
        force += 1e-4 * outputs_of(fluid)["surface_load.force"].sum(axis=0)
    gained = fluid.totals().momentum - before
    assert gained[0] > 1e-5
    assert force == pytest.approx(-gained, abs=1e-12 * np.abs(gained).max())
