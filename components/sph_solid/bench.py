"""Throughput of bars that strike: all laws of the material at work, 58 neighbours each."""

from typing import Any

from quintet.interfaces.manifest import BenchCase

SPACING = 4e-4  # m


def bar(nx: int, ny: int, nz: int) -> dict[str, Any]:
    """Table of a scene: a block of steel that flies against a plane of symmetry at 200 m/s."""
    edges = [SPACING * n for n in (nx, ny, nz)]
    return {
        "spacing": SPACING,
        "bodies": [
            {
                "lowest": [0.0, 0.0, 0.0],
                "highest": edges,
                "material": "steel",
                "velocity": [0.0, 0.0, -200.0],
            }
        ],
        "symmetry": [{"axis": "z"}],
    }


def cases() -> tuple[BenchCase, ...]:
    """Blocks that fit into a processor's cache, and that do not; corrected and not.

    On four ranks that of 33k has as many on each as that of 8k on one.
    """
    unit, series = "particle-steps/s", "struck block"
    corrected = bar(37, 37, 37) | {"kernel_correction": True}
    return (
        BenchCase("struck block, 8k", bar(20, 20, 20), 20, 100, unit, series=series),
        BenchCase("struck block, 33k", bar(32, 32, 32), 20, 60, unit, series=series),
        BenchCase("struck block, 51k", bar(37, 37, 37), 20, 60, unit, series=series),
        BenchCase("struck block, 51k, corrected", corrected, 20, 60, unit),
        BenchCase("struck block, 250k", bar(63, 63, 63), 10, 20, unit, series=series),
        BenchCase("struck block, 300k", bar(67, 67, 67), 10, 20, unit),
    )
