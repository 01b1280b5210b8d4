"""Throughput of a block of steel that is struck: all laws of the material at work."""

from typing import Any

from quintet.interfaces.manifest import BenchCase


def block(nx: int, ny: int, nz: int, tetrahedra: bool = False) -> dict[str, Any]:
    """Table of a scene: a block of cubes of 0.4 mm, or six in each, that flies against a wall."""
    edge = 4e-4  # m
    return {
        "parts": [
            {
                "lowest": [0.0, 0.0, 0.0],
                "highest": [nx * edge, ny * edge, nz * edge],
                "elements": [nx, ny, nz],
                "tetrahedra": tetrahedra,
                "material": "steel",
                "velocity": [0.0, 0.0, -100.0],
            }
        ],
        "rigid_walls": [{"point": [0.0, 0.0, 0.0], "normal": [0.0, 0.0, 1.0]}],
    }


def cases() -> tuple[BenchCase, ...]:
    """Blocks that fit into a processor's cache, and that do not."""
    series = "struck block"
    unit = "element-steps/s"
    sizes = {"6k": (18, 18, 18), "55k": (38, 38, 38), "262k": (64, 64, 64)}
    return (
        *(
            BenchCase(f"{series}, {name}", block(*size), 20, 100, unit, series=series)
            for name, size in sizes.items()
        ),
        *(
            BenchCase(
                f"tetrahedra, {name}",
                block(*size, tetrahedra=True),
                10,
                40,
                unit,
                series="tetrahedra",
            )
            for name, size in {"6k": (10, 10, 10), "55k": (21, 21, 21)}.items()
        ),
        BenchCase(f"{series}, 1M", block(100, 100, 100), 10, 20, unit, series=series),
    )
