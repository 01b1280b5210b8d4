"""Places of wall particles, the depth of samples, and the drag of walls."""

import numpy as np
import pytest
from fluid_params import fluid_params

from quintet.components.sph_fluid.boundary.walls import wall_points
from quintet.components.sph_fluid.component import SphFluid
from quintet.components.sph_fluid.plan import particles

TANK = {
    "boundary.walls": ((0.0, 0.0, 0.0), (1.0, 0.5, 0.5)),
    "fluid": (((0.0, 0.0, 0.0), (0.5, 0.5, 0.3)),),
}


def params(**changes):
    return fluid_params(spacing=0.1, sound_speed=40.0, **TANK, **changes)


@pytest.mark.parametrize("wall_offset", [0.5, 1.5, 2.5])
def test_wall_particles_are_as_far_out_as_asked(wall_offset):
    parameters = params(boundary__wall_offset=wall_offset)
    wall = wall_points(parameters)
    assert wall.min(axis=0) == pytest.approx([-0.1 * wall_offset] * 3)
    assert wall[:, 0].max() == pytest.approx(1.0 + 0.1 * wall_offset)
    assert particles(parameters) == len(wall) + 5 * 5 * 3


def test_samples_are_wanted_at_their_depth():
    assert SphFluid(params(boundary__sample_depth=1.5)).describe()["surface.inset"][
        0
    ] == pytest.approx(0.15)


@pytest.mark.parametrize(("factor", "drags"), [(0.0, False), (1.0, True)])
def test_walls_drag_only_with_a_viscosity_factor(factor, drags):
    # There is no pressure at rest density: drag alone slows a fluid that slides on its wall.
    parameters = params(
        boundary__wall_viscosity_factor=factor, gravity=(0.0, 0.0, 0.0), viscosity__artificial=0.5
    )
    fluid = SphFluid(parameters)
    rows = slice(fluid.state.fluid)
    fluid.state.velocity_pressure[rows, 1] = 1.0
    before = fluid.totals().momentum[1]
    fluid.step(1e-7)
    lost = 1.0 - fluid.totals().momentum[1] / before
    assert (lost > 1e-7) == drags
    assert np.isfinite(lost)
