"""A dam break on a dry floor, in a thin fast layer: Ritter (1892), Z. VDI 36, 947.

Depth (2c - x/t)²/9g and speed 2(c + x/t)/3, c = √(gH), hold for shallow water without friction; the
column is nine times as long as deep, so that all but the tip is shallow.
"""

import math

import numpy as np
import pytest
from fluid_params import fluid_params

from quintet.components.sph_fluid.component import SphFluid

LENGTH, DEPTH, SPACING, END = 3.5, 0.4, 0.025, 0.7
WAVE = math.sqrt(9.81 * DEPTH)  # m/s, c
HALF = 0.15  # m, half the width of the slices


@pytest.mark.slow
@pytest.mark.parametrize(
    ("tension", "coherent"), [(True, True), (False, False)], ids=["tension", "cut"]
)
def test_layer_holds_together_with_tension_and_carries_ritters_momentum(
    tension: bool, coherent: bool
) -> None:
    fluid = SphFluid(
        fluid_params(
            spacing=SPACING,
            sound_speed=20.0 * WAVE,
            dimensions=2,
            boundary__method="mdbc",
            density_diffusion=0.1,
            negative_pressure=tension,
            viscosity__artificial=0.1,
            boundary__wall_viscosity_factor=0.0,
            courant=0.3,
            fluid=(((0.0, 0.0, 0.0), (LENGTH, 0.1, DEPTH)),),
            boundary__walls=((0.0, 0.0, 0.0), (7.0, 0.1, 0.8)),
        )
    )
    time = 0.0
    while time < END:
        dt = min(fluid.stable_dt(), END - time + 1e-12)
        fluid.step(dt)
        time += dt
    state = fluid.state
    place, motion = state.position_density[: state.fluid], state.velocity_pressure[: state.fluid]
    densities, errors = [], []
    for x in (4.0, 4.4, 4.8):
        in_slice = np.abs(place[:, 0] - x) < HALF
        similarity = (x - LENGTH) / END
        flux = (motion[in_slice, 0] ** 2).sum() * SPACING**2 / (2.0 * HALF)
        ritter = (
            (2.0 * WAVE - similarity) ** 2 / (9.0 * 9.81) * (2.0 / 3.0 * (WAVE + similarity)) ** 2
        )
        errors.append(flux / ritter - 1.0)
        densities.append(place[in_slice, 3].mean())
    assert (np.abs(errors).max() < 0.1) == coherent, errors
    assert (min(densities) > 990.0) == coherent, densities
