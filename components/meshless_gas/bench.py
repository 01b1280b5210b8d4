"""Throughput of a vortex in a periodic box: of second order, nine neighbours in the plane."""

from typing import Any

from quintet.interfaces.manifest import BenchCase

UNIT = "node-steps/s"  # of three stages each


def vortex(nodes: int, **keys: Any) -> dict[str, Any]:
    """Table of a scene: a vortex in a box of nodes squared."""
    return {
        "box": {
            "lowest": [0.0, 0.0, 0.0],
            "highest": [10.0, 10.0, 10.0],
            "spacing": 10.0 / nodes,
            "jitter": 0.3,
        },
        "gas": {"gas_constant": 1.0},
        "initial": {"density": 1.0, "velocity": [1.0, 0.0, 1.0], "pressure": 1.0},
        "vortex": {"centre": [5.0, 0.0, 5.0], "strength": 5.0},
        "neighbours": 9,
        "limiter": "van_albada",
        "limiter_threshold": 1e-2,
        **keys,
    }


def cases() -> tuple[BenchCase, ...]:
    """Clouds that fit into a processor's cache, and that do not; first order; boxes in space."""
    space, plane = {"dimensions": 3, "neighbours": 14}, "vortex, 9 neighbours"
    # Loads pyopencl where it is installed; benchmarks alone ask for it.
    from quintet.components.shared.opencl.devices import is_any_there

    on_devices = (
        BenchCase(f"{name}, OpenCL", params, *steps, UNIT, device="opencl")
        for name, params, steps in (
            ("vortex, 10k nodes, 9 neighbours", vortex(100), (20, 60)),
            ("vortex, 64k nodes, 9 neighbours", vortex(253), (10, 30)),
            ("box, 64k nodes, 14 neighbours", vortex(40, **space), (5, 15)),
            ("box, 300k nodes, 14 neighbours", vortex(67, **space), (2, 6)),
            (
                "box, 64k nodes, 14 neighbours, viscous",
                vortex(40, **space, viscous=True),
                (5, 15),
            ),
        )
        if is_any_there()
    )
    return (
        BenchCase("vortex, 10k nodes, 9 neighbours", vortex(100), 20, 60, UNIT, series=plane),
        BenchCase("vortex, 64k nodes, 9 neighbours", vortex(253), 10, 30, UNIT, series=plane),
        BenchCase("vortex, 64k nodes, first order", vortex(253, order=1), 10, 30, UNIT),
        BenchCase("box, 64k nodes, 14 neighbours", vortex(40, **space), 5, 15, UNIT),
        BenchCase("box, 300k nodes, 14 neighbours", vortex(67, **space), 2, 6, UNIT),
        BenchCase(
            "box, 64k nodes, 14 neighbours, viscous", vortex(40, **space, viscous=True), 5, 15, UNIT
        ),
        *on_devices,
    )
