"""Throughput of lattices in thermal motion; each point has up to 16 pairs within the cut-off."""

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


def cases() -> tuple[BenchCase, ...]:
    """The bar of the paper; lattices that fit the processor's cache, and that do not."""
    # Loads pyopencl where it is installed; benchmarks alone ask for it.
    from quintet.components.shared.opencl.devices import is_accelerator_there, is_any_there

    sizes = {"160": (10, 4, 4), "24k": (60, 20, 20), "100k": (98, 32, 32)}
    on_processor = (case(name, size) for name, size in sizes.items())
    on_devices = (case(name, size, "opencl") for name, size in sizes.items() if is_any_there())
    # Fewer points do not fill an accelerator.
    large = (case("1M", (100, 100, 100), "opencl"),) if is_accelerator_there() else ()
    return (*on_processor, *on_devices, *large)


def case(name: str, size: tuple[int, int, int], device: str = "cpu") -> BenchCase:
    """A lattice of so many points along x, y and z, on a device."""
    return BenchCase(
        f"lattice, {name}" + (", OpenCL" if device != "cpu" else ""),
        lattice(*size),
        20,
        max(50, 2_000_000 // (size[0] * size[1] * size[2]) // 10),
        "point-steps/s",
        series="lattice" if device == "cpu" else "lattice, OpenCL",
        device=device,
    )
