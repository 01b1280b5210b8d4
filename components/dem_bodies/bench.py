"""Throughput of many spheres in lasting contact: a lattice pressed into a corner.

As in the common benchmark of granular codes: 27 × 27 × 28 spheres of 10 mm, E = 5 MPa, μ = 0.5,
each in contact with its six neighbours. Others make the sides periodic and let the spheres overlap
at the start; here they just touch, move towards a corner of three planes, and weigh towards it.
"""

from itertools import product
from typing import Any

import numpy as np

from quintet.interfaces.manifest import BenchCase

DIAMETER = 0.01  # m
SQUEEZE = 0.2  # 1/s, rate at which the lattice shrinks, so that all contacts begin at once
UNEVEN = 1e-3  # m/s, of single spheres, so that contacts slip and roll
CORNER = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
STUFF = {"youngs_modulus": 5e6, "poissons_ratio": 0.3, "restitution": 0.5, "friction": 0.5}


def lattice(nx: int, ny: int, nz: int) -> dict[str, Any]:
    """Table of a scene with spheres that touch at the start."""
    numbers = np.array([(x, y, z) for z, y, x in product(range(nz), range(ny), range(nx))])
    position = (numbers + 0.5) * DIAMETER * (1.0 + 1e-9)  # (n, 3) m
    random = np.random.default_rng(1)
    velocity = UNEVEN * random.uniform(-1.0, 1.0, position.shape) - SQUEEZE * position  # m/s
    sphere = {"shape": "sphere", "radius": 0.5 * DIAMETER, "density": 2500.0, "material": "grain"}
    motions = zip(position.tolist(), velocity.tolist(), strict=True)
    return {
        "bodies": [{**sphere, "centre": x, "velocity": v} for x, v in motions],
        "planes": [{"point": [0.0] * 3, "normal": list(n), "material": "grain"} for n in CORNER],
        "materials": {"grain": STUFF},
        "gravity": [-4.0, -4.0, -8.0],
        "impact_speed": 0.5,
    }


def cases() -> tuple[BenchCase, ...]:
    """Return the benchmark, and smaller and larger ones that show how the cost grows."""
    sizes = {"small": (21, 21, 22), "common": (27, 27, 28), "large": (46, 46, 47)}
    tables = {name: lattice(*size) for name, size in sizes.items()}
    # Loads pyopencl where it is installed; benchmarks alone ask for it.
    from quintet.components.shared.opencl.devices import is_any_there

    on_devices = [case(name, table, "opencl") for name, table in tables.items() if is_any_there()]
    return (*(case(name, table) for name, table in tables.items()), *on_devices)


def case(name: str, table: dict[str, Any], device: str = "cpu") -> BenchCase:
    """A lattice on a device."""
    tail = "" if device == "cpu" else ", OpenCL"
    unit, series = "sphere-steps/s", f"lattice{tail}"
    return BenchCase(f"lattice, {name}{tail}", table, 20, 200, unit, series=series, device=device)
