"""Water is removed where bodies begin beside pistons, and pushes them as beside walls."""

import numpy as np
import pytest
from fluid_params import fluid_params
from sampled_bodies import BOX, mirrors
from test_sph_fluid_pistons import BASE, OBSTACLE, SPACING, STAY, piston

from quintet.components.sph_fluid.component import SphFluid
from quintet.interfaces.component import outputs_of

TANK_WITH_BLOCK = BASE | OBSTACLE | {"remove_inside_bodies": True}
PISTON = piston("obstacles.0", STAY)


def floating(tables):
    """Fluid in which a square of 4 spacings is held, half under water, and its samples."""
    fluid = SphFluid(fluid_params(**TANK_WITH_BLOCK | tables))
    edge, centre = 4.0 * SPACING, np.array([0.22, 0.5, 0.2])
    coordinates = (np.arange(4) - 1.5) * SPACING
    arm = np.array([[x, 0.0, z] for x in coordinates for z in coordinates])
    outermost = np.abs(arm) == np.abs(arm).max(axis=1, keepdims=True)
    normal = np.where(outermost, np.sign(arm), 0.0)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    image = mirrors(BOX, np.array([edge, 1.0, edge]), arm, normal)
    count = len(arm)
    static = {"normal": normal, "volume": np.full(count, SPACING**2), "body": np.zeros(count)}
    fluid.bind({f"surface.{k}": v for k, v in static.items()}, frozenset({"surface"}))
    fields = {"position": centre + arm, "velocity": 0.0 * arm, "mirror": centre + image}
    fields = {f"surface.{k}": v for k, v in fields.items()}
    fluid.prime(fields)
    return fluid, fields


def test_water_is_removed_inside_bodies_and_not_beside_pistons():
    """A piston at rest pushes as an obstacle does, and the body alone displaces water."""
    loads = []
    for tables in ({}, PISTON):
        fluid, fields = floating(tables)
        assert fluid.notes() == (
            "body 0 stood in the fluid: 8 particles inside it, 3.2 kg, were removed",
        )
        for _ in range(400):
            fluid.take(fields)
            fluid.step(5e-4)
            loads.append(outputs_of(fluid)["surface_load.force"].sum(axis=0))
    beside_obstacle, beside_piston = np.array(loads).reshape(2, 400, 3)
    assert beside_piston == pytest.approx(beside_obstacle, abs=1e-6 * np.abs(beside_obstacle).max())
    weight = 9810.0 * 0.08 * 0.04  # N, of the water that 1 m of the square displaces
    assert beside_piston[200:, 2].mean() == pytest.approx(weight, rel=0.1)
