"""What the laws of the contract are tried on: small lattices, still, driven, heated, coupled."""

from dataclasses import replace
from typing import Any

import numpy as np

from quintet.interfaces.manifest import ConformCase

LATTICE: dict[str, Any] = {
    "lattice": {"cells": [3, 1, 1], "spacing": 0.01, "mass": 1e-3},
    "boltzmann": 1e-3,
    "seven_roots": {"top_frequency": 50.0},
}
STEP = 2e-4  # s
WALL = 4  # points


def cases() -> tuple[ConformCase, ...]:
    """A lattice at rest, one that is driven and damped, one in baths with a coupled wall."""
    # Loads pyopencl where it is installed; these cases alone ask for it.
    from quintet.components.shared.opencl.devices import is_any_there

    driven = {
        **LATTICE,
        "damping": {"coefficient": 3e-4},
        "frozen": [[0.03, 0.0, 0.0], [0.03, 0.0, 0.01]],
        "drive": {
            "point": [0.0, 0.01, 0.01],
            "partner": "-y",
            "frequency": 50.0,
            "amplitude": 5e-4,
        },
    }
    wall = {
        "lowest": [0.0, 0.0, 0.0],
        "highest": [0.0, 0.01, 0.01],
        "temperature": 0.0,
        "rate": 50.0,
        "tether": 1.0,
    }
    other = {**wall, "lowest": [0.03, 0.0, 0.0], "highest": [0.03, 0.01, 0.01]}
    heated = {**LATTICE, "baths": [{**wall, "coupled": True}, other], "collision_rate": 100.0}
    warm = {**LATTICE["lattice"], "cells": [6, 6, 6], "periodic": ["x", "y", "z"]}
    cases_of_devices = (
        replace(case, name=f"{case.name}, OpenCL", device="opencl")
        for case in (_driven(driven), _wall(heated))
        if is_any_there()
    )
    return (
        ConformCase("lattice", LATTICE, dt=STEP),
        _driven(driven),
        ConformCase(
            "periodic, warm, Yoshida",
            {**LATTICE, "lattice": {**warm, "temperature": 3e-6}, "integrator": "yoshida"},
            dt=STEP,
            still=False,
        ),
        _wall(heated),
        *cases_of_devices,
    )


def _driven(params: dict[str, Any]) -> ConformCase:
    return ConformCase("driven", params, dt=STEP, still=False)


def _wall(params: dict[str, Any]) -> ConformCase:
    return ConformCase(
        "wall",
        params,
        rest={"wall_temperature.temperature": np.zeros(WALL)},
        scale={"wall_temperature.temperature": 3e-6},
        dt=STEP,
        smooth=False,  # random forces
    )
