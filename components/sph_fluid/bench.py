"""What the throughput of the fluid is measured on.

The dam break has the particles of the one that other codes were measured with: 106 200 of fluid
and one layer of 36 221 in the walls; a small one has half of its edges. Channels, in which a dam
breaks across, are the same all along and grow in length alone: equal rates mean that the cost grows
with the number of particles.
In the coupled case a cube of samples stands still in the front of the column.
"""

import math
from typing import Any

import numpy as np

from quintet.components.shared.smoothing.cubic_spline import SUPPORT
from quintet.interfaces.component import Fields
from quintet.interfaces.manifest import BenchCase

SPACING = 0.01  # m
UNIT = "particle-steps/s"
LENGTHS = {"10k": 16, "100k": 199, "1M": 2028}  # spacings, of the channels of so many particles
ALL = {"density_diffusion": 0.1, "xsph": 0.5}  # what pairs of fluid may have
CUBE = 0.2  # m
NOTCHED: list[dict[str, Any]] = [
    {"shape": "box", "lowest": [0.0, 0.0, 0.0], "highest": [0.4, 0.59, 0.3]},
    {"shape": "box", "lowest": [0.4, 0.0, 0.0], "highest": [0.6, 0.2, 0.3]},
    {"shape": "box", "lowest": [0.4, 0.4, 0.0], "highest": [0.6, 0.59, 0.3]},
    {"shape": "box", "lowest": [0.4, 0.2, 0.2], "highest": [0.6, 0.4, 0.3]},
]  # m, the column without the cube


def cases() -> tuple[BenchCase, ...]:
    """All cases; the dam falls long enough for its neighbour lists to be made again."""
    dam = tank((159, 59, 60), (60, 59, 30), 20.0)
    small = tank((80, 30, 30), (30, 30, 15), 20.0)
    large = tank((500, 250, 250), (250, 250, 125), 20.0)
    mirrored = dam | {"boundary": dam["boundary"] | {"method": "mdbc"}}
    channels = [
        BenchCase(
            f"channel, {name}",
            tank((length, 40, 25), (length, 20, 20), 10.0),
            3,
            120,
            UNIT,
            series="channel",
        )
        for name, length in LENGTHS.items()
    ]
    # Loads pyopencl where it is installed; benchmarks alone ask for it.
    from quintet.components.shared.opencl.devices import is_accelerator_there, is_any_there

    none: tuple[Fields, Fields] = {}, {}
    on_devices = (
        BenchCase(f"{name}, OpenCL", params, 10, 200, UNIT, *fields, device="opencl")
        for name, params, fields in (
            ("dam break", dam, none),
            ("dam break, 22k", small, none),
            ("dam break, float32", dam | {"precision": "float32"}, none),
            ("dam break, mdbc", mirrored | ALL, none),
            ("dam break, coupled", dam | {"fluid": NOTCHED}, cube()),
        )
        if is_any_there()
    )
    # Fewer do not fill an accelerator; processors would take minutes.
    million = tank((LENGTHS["1M"], 40, 25), (LENGTHS["1M"], 20, 20), 10.0)
    on_accelerators = (
        BenchCase(f"{name}, OpenCL", params, 10, 500, UNIT, device="opencl")
        for name, params in (
            ("channel, 1M", million),
            ("channel, 1M, float32", million | {"precision": "float32"}),
            ("dam break, 8M, float32", large | {"precision": "float32"}),
        )
        if is_accelerator_there()
    )
    return (
        BenchCase("dam break", dam, 10, 600, UNIT, series="dam break"),
        BenchCase("dam break, 22k", small, 10, 600, UNIT, series="dam break"),
        BenchCase("dam break, XSPH", dam | {"xsph": 0.5}, 10, 600, UNIT),
        BenchCase("dam break, diffusion", dam | {"density_diffusion": 0.1}, 10, 600, UNIT),
        BenchCase("dam break, mdbc", mirrored | ALL, 10, 600, UNIT),
        BenchCase("dam break, float32", dam | {"precision": "float32"}, 10, 600, UNIT),
        BenchCase("dam break, coupled", dam | {"fluid": NOTCHED}, 10, 600, UNIT, *cube()),
        *channels,
        *on_devices,
        *on_accelerators,
    )


def tank(inside: tuple[int, int, int], fluid: tuple[int, int, int], sound: float) -> dict[str, Any]:
    """Table of a column of fluid in the corner of a tank, both in spacings along each edge.

    `sound` is the speed of sound in units of sqrt(g H).
    """
    start = [0.0, 0.0, 0.0]
    walls = {"lowest": start, "highest": [SPACING * n for n in inside]}
    return {
        "spacing": SPACING,
        "smoothing": 1.5,
        "viscosity": {"artificial": 0.1},
        "sound_speed": sound * math.sqrt(9.81 * SPACING * fluid[2]),
        "fluid": [{"shape": "box", "lowest": start, "highest": [SPACING * n for n in fluid]}],
        "boundary": {"method": "dbc", "walls": walls},
    }


def cube() -> tuple[Fields, Fields]:
    """Fields of a link for a cube of samples at rest: sent once, and before each step."""
    line = SPACING * (np.arange(round(CUBE / SPACING)) + 0.5)
    arm = np.stack(np.meshgrid(line, line, line), axis=-1).reshape(-1, 3)
    depth = np.minimum(arm, CUBE - arm).min(axis=1)
    arm = arm[depth < SUPPORT * 1.5 * SPACING]
    ones = np.ones(len(arm))
    static = {
        "surface.normal": np.tile([0.0, 0.0, 1.0], (len(arm), 1)),
        "surface.volume": ones * SPACING**3,
        "surface.body": ones,
    }
    corner = np.array(NOTCHED[3]["lowest"]) * [1.0, 1.0, 0.0]
    return static, {"surface.position": corner + arm, "surface.velocity": np.zeros_like(arm)}
