"""A tube with an inflow and an outflow, and runs of it."""

from typing import Any

from fluid_params import nested

from quintet.components.sph_fluid import SphFluidParams
from quintet.components.sph_fluid.component import SphFluid
from quintet.interfaces.params import read

SPEED, SPACING, LENGTH = 0.5, 0.05, 2.0
TUBE: dict[str, Any] = {  # fluid between plates that let it slip, in uniform motion
    "spacing": SPACING,
    "dimensions": 2,
    "sound_speed": 10.0,
    "gravity": [0.0, 0.0, 0.0],
    "negative_pressure": True,
    "density_diffusion": 0.1,
    "fluid": [[[0.0, 0.0, 0.0], [LENGTH, 1.0, 0.5]]],
    "initial.velocity": [SPEED, "0", "0"],
    "viscosity.artificial": 0.02,
    "boundary.walls": [[0.0, 0.0, 0.0], [LENGTH, 1.0, 0.5]],
    "boundary.open_faces": ["x-", "x+"],
    "boundary.wall_viscosity_factor": 0.0,
    "boundary.inflow": [{"face": "x-", "speed": SPEED}],
    "boundary.outflow": [{"face": "x+"}],
    "gauges.mass_gauge": True,
    "gauges.discharge_gauges": [1.0],
    "gauges.velocity_gauges": [[1.0, 0.5, 0.25], [1.0, 0.5, 0.0], [5.0, 0.5, 0.25]],
}
MASS = 1000.0 * SPACING**2  # kg, of a particle over 1 m


def params_of(table: dict[str, Any], **changes: Any) -> SphFluidParams:
    params, mistakes = read(SphFluidParams, nested(table | changes), "water")
    assert not mistakes, mistakes
    return params


def tube(**changes: Any) -> SphFluid:
    return SphFluid(params_of(TUBE, **changes))


def run(fluid: SphFluid, end: float) -> None:
    time = 0.0
    while time < end - 1e-12:
        dt = min(fluid.stable_dt(), end - time)
        fluid.step(dt)
        time += dt
