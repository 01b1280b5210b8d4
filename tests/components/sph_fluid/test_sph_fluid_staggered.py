"""Staggered rows of the first lattice: their places, and that they stay at rest."""

import math

import numpy as np
import pytest
from fluid_params import fluid_params

from quintet.components.sph_fluid import build
from quintet.components.sph_fluid.component import SphFluid
from quintet.interfaces.component import outputs_of


def test_staggered_rows_are_lattice_rows_that_end_at_walls_as_others_do() -> None:
    box = ((0.0, 0.0, 0.0), (0.6, 0.1, 0.1))
    params = fluid_params(spacing=0.02, sound_speed=20.0, fluid=(box,), staggered=True)
    rows = build.box_points(box, params).reshape(5, 5, 30, 3)
    starts = rows[..., 0, 0].ravel()  # of each row; none has a wall
    assert np.diff(rows[..., 0], axis=2) == pytest.approx(0.02, abs=1e-12)
    gaps = np.diff(np.sort(starts))
    assert gaps.min() > 1e-5 and gaps.max() < 0.005 and 0.0 < starts.min() < starts.max() < 0.02
    walled = fluid_params(
        spacing=0.02,
        sound_speed=20.0,
        fluid=(box,),
        staggered=True,
        boundary__walls=((0.0, 0.0, 0.0), (2.0, 0.1, 0.2)),
    )
    rows = build.box_points(box, walled).reshape(5, 5, 30, 3)
    assert np.ptp(rows[..., 0, 0]) < 0.06 * 0.02
    assert rows[..., -1, 0] == pytest.approx(starts.reshape(5, 5) + 0.58, abs=1e-12)


@pytest.mark.parametrize("smoothing", [1.5, 2.0])
def test_staggered_water_stays_still(smoothing: float) -> None:
    """Speeds stay within 1 % of √(gH), pressure within 2 % of ρgH."""
    fluid = SphFluid(
        fluid_params(
            spacing=0.02,
            sound_speed=20.0,
            dimensions=2,
            integration="symplectic",
            boundary__method="mdbc",
            density_diffusion=0.1,
            negative_pressure=True,
            kernel="wendland",
            courant=1.0,
            fluid=(((0.0, 0.0, 0.0), (0.8, 0.1, 0.3)),),
            boundary__walls=((0.0, 0.0, 0.0), (0.8, 0.1, 0.5)),
            staggered=True,
            acoustic_damper=0.5,
            smoothing=smoothing,
            gauges__motion_gauge=True,
            gauges__pressure_gauges=((0.4, 0.05, 0.0), (0.4, 0.05, 0.15), (0.0, 0.05, 0.1)),
        )
    )
    time, speeds, pressures = 0.0, [], []
    while time < 1.0:
        dt = fluid.stable_dt()
        fluid.step(dt)
        time += dt
        if time > 0.5:
            outputs = outputs_of(fluid)
            speeds.append(outputs["motion_gauge.speed"])
            pressures.append(outputs["pressure_gauge.pressure"])
    assert np.max(speeds) < 0.01 * math.sqrt(9.81 * 0.3)
    ratios = np.mean(pressures, axis=0) / (9810.0 * 0.3)
    assert ratios == pytest.approx([1.0, 0.5, 2.0 / 3.0], abs=0.02)
