"""Cases for the laws of the contract: three spheres, free and on springs."""

import numpy as np

from quintet.interfaces.manifest import ConformCase


def cases() -> tuple[ConformCase, ...]:
    """Spheres that fly freely; parcels on tethers, stepped by Yoshida's scheme."""
    centres = [[0.1 * k, 0.0, 0.0] for k in range(3)]
    spheres = [{"centre": centre, "radius": 0.025, "density": 800.0} for centre in centres]
    loads = {
        "load.force": np.zeros((3, 3)),
        "load.torque": np.zeros((3, 3)),
        "heat.heat_flow": np.zeros(3),
    }
    scale = {"load.force": 1.0, "load.torque": 1e-3, "heat.heat_flow": 10.0}
    tethered = {
        "spheres": [{**sphere, "tether": 50.0, "parcel": 2.0} for sphere in spheres],
        "collisions": False,
        "integrator": "yoshida",
    }
    return (
        ConformCase(
            "spheres",
            {"spheres": spheres, "longest_step": 1e-3},
            rest=loads,
            scale=scale,
            dt=1e-3,
            forces=("load.force",),
        ),
        ConformCase("spheres on springs, Yoshida", tethered, rest=loads, scale=scale, dt=1e-3),
    )
