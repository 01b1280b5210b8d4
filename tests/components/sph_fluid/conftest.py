"""Small fluids, each a few hundred particles."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from fluid_params import fluid_params

from quintet.components.sph_fluid.component import SphFluid
from quintet.interfaces.component import Fields, outputs_of

JOINED = frozenset({"surface", "surface_load"})
SPACING = 0.02
NOTHING = (0.0, 0.0, 0.0)


@pytest.fixture
def drop() -> Callable[..., SphFluid]:
    """Make a cube of fluid of 6³ particles in empty space."""

    def make(**changes: Any) -> SphFluid:
        edge = 6 * SPACING
        settings = {"spacing": SPACING, "sound_speed": 20.0, "fluid": ((NOTHING, (edge,) * 3),)}
        return SphFluid(fluid_params(**(settings | changes)))

    return make


@pytest.fixture
def pool() -> Callable[..., SphFluid]:
    """Make water 0.1 m deep in a tank 0.16 m wide."""

    def make(**changes: Any) -> SphFluid:
        settings = {
            "spacing": SPACING,
            "sound_speed": 20.0 * math.sqrt(9.81 * 0.1),
            "fluid": ((NOTHING, (0.16, 0.16, 0.1)),),
            "boundary.walls": (NOTHING, (0.16, 0.16, 0.16)),
        }
        return SphFluid(fluid_params(**(settings | changes)))

    return make


@pytest.fixture
def plate() -> Callable[..., Fields]:
    """Join a plate of samples below a fluid; return where it is, moving upwards."""

    def join(
        fluid: SphFluid, height: float = -0.5 * SPACING, speed: float = 0.3, share: float = 1.0
    ) -> Fields:
        x, y = np.meshgrid(np.arange(7) * SPACING, np.arange(7) * SPACING)
        position = np.stack([x.ravel(), y.ravel(), np.full(x.size, height)], axis=1)
        velocity = np.zeros_like(position)
        velocity[:, 2] = speed
        fields = {"surface.position": position, "surface.velocity": velocity}
        for array in fields.values():
            array.flags.writeable = False
        normal = np.tile([0.0, 0.0, 1.0], (len(position), 1))
        volume = np.full(len(position), share * SPACING**3)
        static = {"surface.normal": normal, "surface.volume": volume}
        fluid.bind(static | {"surface.body": np.zeros(len(position))}, JOINED)
        return fields

    return join


@pytest.fixture
def struck() -> Callable[..., tuple[Any, Any]]:
    """Let samples strike a fluid; return their impulses and the momentum that it gained."""

    def strike(fluid: SphFluid, fields: Fields) -> tuple[Any, Any]:
        fluid.take(fields)
        fluid.step(1e-4)
        before = fluid.totals().momentum
        fluid.step(0.7e-4)
        impulse = 0.7e-4 * outputs_of(fluid)["surface_load.force"]
        return impulse, fluid.totals().momentum - before

    return strike
