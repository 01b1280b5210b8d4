"""Gases that are computed on the processor and on a device, and what lies between them."""

import numpy as np
from gases import state

from quintet.components.meshless_gas.component import MeshlessGas
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.interfaces.component import Array, Component, Fields, Resources
from quintet.interfaces.params import read

DEVICE = Resources(device="opencl")
BOX = {"lowest": [0.0, 0.0, 0.0], "highest": [1.0, 1.0, 1.0], "spacing": 0.1, "jitter": 0.3}
WIND = {"density": 1.2, "pressure": 1.0, "velocity": [0.3, 0.0, -0.05]}
SLIP = {"kind": "slip"}
# What comes in slower than sound and faster, from rest, leaves, and passes along a wall.
STREAM = {
    "box": BOX,
    "gas": {"gas_constant": 1.0},
    "initial": WIND,
    "boundaries": {
        "x-": {"kind": "inflow", "state": state(1.3, 0.35, 1.1)},
        "x+": {"kind": "outflow", "pressure": 1.0},
        "z-": SLIP,
        "z+": {"kind": "outflow"},
    },
    "probes": [[0.5, 0.0, 0.5]],
}
FAST = WIND | {"velocity": [3.0, 0.0, -0.4]}
SUPERSONIC = STREAM | {
    "initial": FAST,
    "boundaries": {
        "x-": {"kind": "inflow", "state": FAST},
        "x+": {"kind": "outflow"},
        "z-": {"kind": "symmetry"},
        "z+": {"kind": "inflow", "state": FAST},
    },
}
FROM_REST = STREAM | {
    "boundaries": {
        "x-": {"kind": "inflow", "total": {"pressure": 1.3, "temperature": 1.0}},
        "x+": {"kind": "outflow", "pressure": 0.9},
        "z-": SLIP,
        "z+": SLIP,
    },
}
IN_SPACE = STREAM | {
    "dimensions": 3,
    "box": BOX | {"spacing": 0.2},
    "boundaries": STREAM["boundaries"] | {"y-": SLIP, "y+": SLIP},
}
# Walls that hold the gas, one of them moving and cold.
VISCOUS = STREAM | {
    "viscous": True,
    "gas": {"gas_constant": 1.0, "viscosity": 0.01, "reference_temperature": 1.0},
    "boundaries": {
        "z-": {"kind": "isothermal", "temperature": 0.7, "velocity": [0.5, 0.0, 0.0]},
        "z+": {"kind": "adiabatic"},
    },
}
SPHERE = {
    "axisymmetric": True,
    "gas": {"gas_constant": 1.0 / 1.4},
    "initial": state(1.0, 6.0, 1.0 / 1.4),
    "steady": {"steps": 50, "change": 1e-5, "force": 1e-5},
    "sphere": {"radius": 1.0, "points_around": 24, "layers": {"count": 24}},
    "boundaries": {
        "wall": {"kind": "symmetry"},
        "far": {"kind": "inflow", "state": state(1.0, 6.0, 1.0 / 1.4)},
        "exit": {"kind": "outflow"},
    },
}


def params_of(table):
    params, mistakes = read(MeshlessGasParams, table, "gas")
    assert not mistakes, mistakes
    return params


def advanced(gas: Component, steps: int) -> Component:
    for _ in range(steps):
        gas.step(gas.stable_dt())
    return gas


def both(device_class, table, steps):
    """The same gas on the processor and on a device, after so many steps."""
    params = params_of(table)
    return advanced(MeshlessGas(params), steps), advanced(device_class(params, DEVICE), steps)


def apart(first: Array, second: Array) -> float:
    """Largest difference of arrays over their largest number."""
    first, second = np.asarray(first), np.asarray(second)
    return float(np.abs(first - second).max(initial=0.0) / np.abs(first).max(initial=1e-300))


def same_bits(first: Fields, second: Fields) -> None:
    assert first.keys() == second.keys()
    for key, array in first.items():
        assert np.array_equal(array, second[key], equal_nan=True), key
