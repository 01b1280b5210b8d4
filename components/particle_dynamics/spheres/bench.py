"""Throughput of spheres in flight with drag, and of a gas of spheres that strike each other."""

from typing import Any

import numpy as np

from quintet.interfaces.manifest import BenchCase


def spheres(side: int) -> dict[str, Any]:
    """Table of a scene: so many spheres cubed, every other one of which flies into its neighbour.

    They fill a fifth of their space. A lattice of them and another in the middles of its cells fly
    through each other along x.
    """
    half = {"radius": 0.36, "density": 1.0}
    return {
        "spheres": [
            {
                **half,
                "centre": [0.5 * k, 0.4 * k, 0.3 * k],
                "velocity": [1.0 - 2.0 * k, 0.1 * k, 0.0],
                "copies": {"number": [side // 2, side, side], "spacing": [2.0, 1.0, 1.0]},
            }
            for k in range(2)
        ],
        "longest_step": 0.02,
        "restitution": 0.9,
    }


def dust(layers: int) -> dict[str, Any]:
    """Table of a scene: layers of 2500 spheres in two streams that pass through each other."""
    streams = [
        {
            "radius": 0.05,
            "density": 1.0,
            "centre": [0.5 * k, 0.4 * k, 0.3 * k],
            "velocity": [1.0 - 2.0 * k, 0.1 * k, 0.0],
            "copies": {"number": [layers // 2, 50, 50], "spacing": [1.0, 1.0, 1.0]},
        }
        for k in range(2)
    ]
    return {"spheres": streams, "longest_step": 0.02}


def drag(layers: int) -> dict[str, np.ndarray[Any, Any]]:
    """Forces [N] against the velocities of `dust`, so small that these hardly change."""
    half = np.tile([-1e-9, 0.0, 0.0], (1250 * layers, 1))
    return {"load.force": np.concatenate([half, -half])}


def cases() -> tuple[BenchCase, ...]:
    """Few spheres that strike each other and many; many that do not."""
    return (
        *(
            BenchCase(
                f"spheres, {side**3}", spheres(side), 20, 2_000_000 // side**3, "sphere-steps/s"
            )
            for side in (10, 20, 40)
        ),
        BenchCase("flight with drag, 100k", dust(40), 20, 60, "sphere-steps/s", fields=drag(40)),
    )
