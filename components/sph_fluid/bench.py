"""What the throughput of the fluid is measured on.

The dam break has the particles of the one that other codes were measured with: 106 200 of fluid
and one layer of 36 221 in the walls. Channels, in which a dam breaks across, are the same all
along and grow in length alone: equal rates mean that the cost grows with the number of particles.
"""

import math
from typing import Any

from quintet.interfaces.manifest import BenchCase

SPACING = 0.01  # m
UNIT = "particle-steps/s"
LENGTHS = {"10k": 16, "100k": 199, "1M": 2028}  # spacings, of the channels of so many particles


def cases() -> tuple[BenchCase, ...]:
    """All cases; the dam falls long enough for its neighbour lists to be made again."""
    dam = tank((159, 59, 60), (60, 59, 30), 20.0)
    channels = [
        BenchCase(f"channel, {name}", tank((length, 40, 25), (length, 20, 20), 10.0), 3, 120, UNIT)
        for name, length in LENGTHS.items()
    ]
    return (
        BenchCase("dam break", dam, 10, 600, UNIT),
        BenchCase("dam break, XSPH", dam | {"xsph": 0.5}, 10, 600, UNIT),
        *channels,
    )


def tank(inside: tuple[int, int, int], fluid: tuple[int, int, int], sound: float) -> dict[str, Any]:
    """Table of a column of fluid in the corner of a tank, both in spacings along each edge.

    `sound` is the speed of sound in units of sqrt(g H).
    """
    start = [0.0, 0.0, 0.0]
    return {
        "spacing": SPACING,
        "smoothing": 1.5,
        "viscosity": 0.1,
        "sound_speed": sound * math.sqrt(9.81 * SPACING * fluid[2]),
        "fluid": [[start, [SPACING * n for n in fluid]]],
        "walls": [start, [SPACING * n for n in inside]],
    }
