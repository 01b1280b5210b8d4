"""Throughput of implicit steps of a bar that is heated at one end."""

from typing import Any

from quintet.interfaces.manifest import BenchCase


def bar(n: int) -> dict[str, Any]:
    """Table of a scene: an aluminium bar of 30 x 10 x 10 mm, n elements across."""
    part = {
        "lowest": [0.0, 0.0, 0.0],
        "highest": [0.03, 0.01, 0.01],
        "elements": [3 * n, n, n],
        "conductivity": 237.0,
        "density": 2700.0,
        "specific_heat": 900.0,
    }
    end = {"lowest": [0.0, 0.0, 0.0], "highest": [0.0, 0.01, 0.01]}
    held = [{**end, "temperature": 400.0}]
    return {"parts": [part], "fixed_temperatures": held, "longest_step": 1e-2}


def cases() -> tuple[BenchCase, ...]:
    """Bars that fit into a processor's cache, and that do not."""
    return tuple(
        BenchCase(f"heated bar, {name}", bar(n), 2, 5, "element-steps/s")
        for name, n in {"5k": 12, "41k": 24}.items()
    )
