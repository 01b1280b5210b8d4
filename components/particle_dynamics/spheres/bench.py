"""Throughput of a gas of spheres that strike each other; they fill a fifth of their space."""

from typing import Any

from quintet.interfaces.manifest import BenchCase


def spheres(side: int) -> dict[str, Any]:
    """Table of a scene: so many spheres cubed, every other one of which flies into its neighbour.

    A lattice of them and another in the middles of its cells fly through each other along x.
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


def cases() -> tuple[BenchCase, ...]:
    """Few spheres and many."""
    return tuple(
        BenchCase(f"spheres, {side**3}", spheres(side), 20, 2_000_000 // side**3, "sphere-steps/s")
        for side in (10, 20, 40)
    )
