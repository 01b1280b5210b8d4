"""Throughput of bars that strike: all laws of the material at work, 58 neighbours each."""

from typing import Any

from quintet.interfaces.manifest import BenchCase

SPACING = 4e-4  # m
UNIT, SERIES = "particle-steps/s", "struck block"


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
    corrected = bar(37, 37, 37) | {"kernel_correction": True}
    on_processor = (
        BenchCase("struck block, 8k", bar(20, 20, 20), 20, 100, UNIT, series=SERIES),
        BenchCase("struck block, 33k", bar(32, 32, 32), 20, 60, UNIT, series=SERIES),
        BenchCase("struck block, 51k", bar(37, 37, 37), 20, 60, UNIT, series=SERIES),
        BenchCase("struck block, 51k, corrected", corrected, 20, 60, UNIT),
        BenchCase("struck block, 250k", bar(63, 63, 63), 10, 20, UNIT, series=SERIES),
        BenchCase("struck block, 300k", bar(67, 67, 67), 10, 20, UNIT),
    )
    # Loads pyopencl where it is installed; benchmarks alone ask for it.
    from quintet.components.shared.opencl.devices import is_accelerator_there, is_any_there

    on_devices = (
        BenchCase("struck block, 8k, OpenCL", bar(20, 20, 20), 20, 100, UNIT, device="opencl"),
        BenchCase("struck block, 51k, OpenCL", bar(37, 37, 37), 20, 60, UNIT, device="opencl"),
        BenchCase("struck block, 51k, corrected, OpenCL", corrected, 20, 60, UNIT, device="opencl"),
        BenchCase("struck block, 250k, OpenCL", bar(63, 63, 63), 10, 20, UNIT, device="opencl"),
    )
    # Fewer do not fill an accelerator; processors would take minutes.
    millions = BenchCase(
        "struck block, 2M, OpenCL", bar(128, 128, 128), 10, 100, UNIT, device="opencl"
    )
    return (
        *on_processor,
        *(on_devices if is_any_there() else ()),
        *([millions] if is_accelerator_there() else []),
    )
