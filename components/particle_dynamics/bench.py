"""Throughput of lattices in thermal motion, and of a gas of spheres that strike each other.

Each point of a lattice has up to 16 pairs within the cut-off; spheres fill a fifth of their space.
"""

from typing import Any

from quintet.interfaces.manifest import BenchCase


def lattice(nx: int, ny: int, nz: int) -> dict[str, Any]:
    """Table of a scene: a warm open lattice of so many points, damped within the cut-off."""
    return {
        "lattice": {
            "cells": [nx - 1, ny - 1, nz - 1],
            "spacing": 1.0,
            "mass": 1.0,
            "temperature": 3e-5,
        },
        "boltzmann": 1.0,
        "seven_roots": {"top_frequency": 0.15915494309189535},
        "damping": {"coefficient": 1e-4},
    }


def pairs(nx: int, ny: int, nz: int) -> int:
    """Pairs of points at most two spacings apart."""
    found = 0
    for i in range(-2, 3):
        for j in range(-2, 3):
            for k in range(-2, 3):
                if 0 < i * i + j * j + k * k <= 4:
                    found += max(nx - abs(i), 0) * max(ny - abs(j), 0) * max(nz - abs(k), 0)
    return found // 2


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
    """The paper's bar, lattices in a processor's cache and not; spheres, few and many."""
    return *_lattices(), *(
        BenchCase(f"spheres, {side**3}", spheres(side), 20, 2_000_000 // side**3, "sphere-steps/s")
        for side in (10, 20, 40)
    )


def _lattices() -> tuple[BenchCase, ...]:
    sizes = {"160": (10, 4, 4), "24k": (60, 20, 20), "100k": (98, 32, 32)}
    return tuple(
        BenchCase(
            f"lattice, {name}",
            lattice(*size),
            20,
            max(50, 2_000_000 // (size[0] * size[1] * size[2]) // 10),
            "point-steps/s",
        )
        for name, size in sizes.items()
    )
