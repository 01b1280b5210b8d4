"""What the laws of the contract are tried on: small lattices, still, driven, heated, coupled."""

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
    still = {"wall_temperature.temperature": np.zeros(WALL)}
    warm = {**LATTICE["lattice"], "cells": [6, 6, 6], "periodic": ["x", "y", "z"]}
    row = [[0.1 * k, 0.0, 0.0] for k in range(3)]
    spheres = [{"centre": one, "radius": 0.025, "density": 800.0} for one in row]
    loads = {
        "load.force": np.zeros((3, 3)),
        "load.torque": np.zeros((3, 3)),
        "heat.heat_flow": np.zeros(3),
    }
    return (
        ConformCase(
            "spheres",
            {"spheres": spheres, "longest_step": 1e-3},
            rest=loads,
            scale={"load.force": 1.0, "load.torque": 1e-3, "heat.heat_flow": 10.0},
            dt=1e-3,
            forces=("load.force",),
        ),
        ConformCase(
            "spheres on springs, Yoshida",
            {
                "spheres": [{**one, "tether": 50.0, "parcel": 2.0} for one in spheres],
                "collisions": False,
                "integrator": "yoshida",
            },
            rest=loads,
            scale={"load.force": 1.0, "load.torque": 1e-3, "heat.heat_flow": 10.0},
            dt=1e-3,
        ),
        ConformCase("lattice", LATTICE, dt=STEP),
        ConformCase("driven", driven, dt=STEP, still=False),
        ConformCase(
            "periodic, warm, Yoshida",
            {**LATTICE, "lattice": {**warm, "temperature": 3e-6}, "integrator": "yoshida"},
            dt=STEP,
            still=False,
        ),
        ConformCase(
            "wall",
            heated,
            rest=still,
            scale={"wall_temperature.temperature": 3e-6},
            dt=STEP,
            smooth=False,  # random forces
        ),
    )
