"""Tables of small fluids, and the same fluid on the processor and on a device."""

from copy import deepcopy

import numpy as np
from fluid_params import fluid_params

from quintet.interfaces.component import Resources

MIRRORED = {
    "spacing": 0.05,
    "sound_speed": 20.0,
    "dimensions": 2,
    "kernel": "wendland",
    "density_diffusion": 0.1,
    "negative_pressure": True,
    "fluid": [{"shape": "box", "lowest": [0.0, 0.0, 0.0], "highest": [0.3, 1.0, 0.4]}],
    "viscosity": {"artificial": 0.1},
    "boundary": {
        "method": "mdbc",
        "walls": {"lowest": [0.0, 0.0, 0.0], "highest": [0.8, 1.0, 0.6]},
    },
    "gauges": {"front_gauge": "x", "motion_gauge": True, "pressure_gauges": [[0.1, 0.5, 0.1]]},
}
DYNAMIC = {
    "spacing": 0.1,
    "sound_speed": 40.0,
    "fluid": [{"shape": "box", "lowest": [0.0, 0.0, 0.0], "highest": [0.5, 0.5, 0.5]}],
    "viscosity": {"artificial": 0.1},
    "boundary": {
        "method": "dbc",
        "walls": {"lowest": [0.0, 0.0, 0.0], "highest": [1.0, 0.5, 0.8]},
    },
}
TWICE = {"integration": "symplectic", "courant": 0.4}
DEVICE = Resources(device="opencl")


def params_of(table):
    return fluid_params(**deepcopy(table))


def advanced(fluid, steps):
    for _ in range(steps):
        fluid.step(fluid.stable_dt())
    return fluid


def difference(first, second, name):
    a, b = first.view()[name], second.view()[name]
    return np.abs(a - b).max() / np.abs(a).max()
