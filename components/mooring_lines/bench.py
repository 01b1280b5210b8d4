"""Throughput of lines that hang from one body each."""

from typing import Any

import numpy as np

from quintet.interfaces.manifest import BenchCase

COUNT = 10_000


def farm(count: int) -> dict[str, Any]:
    """Table of a scene: so many lines, each with a body of its own."""
    line = {"length": 9.0, "stiffness": 1e5, "weight": 50.0}
    return {
        "lines": [
            {**line, "body": k, "anchor": [0.0, 20.0 * k, 0.0], "fairlead": [7.5, 20.0 * k, 3.0]}
            for k in range(count)
        ]
    }


def motion(count: int) -> dict[str, np.ndarray[Any, Any]]:
    """Motion of bodies at the fairleads of `farm`."""
    place = np.zeros((count, 3))
    place[:, 0], place[:, 1], place[:, 2] = 7.5, 20.0 * np.arange(count), 3.0
    turn = np.tile([1.0, 0.0, 0.0, 0.0], (count, 1))
    still = np.zeros((count, 3))
    return {
        "motion.position": place,
        "motion.velocity": still,
        "motion.orientation": turn,
        "motion.angular_velocity": still,
    }


def cases() -> tuple[BenchCase, ...]:
    """Many catenaries."""
    static = {"motion.mass": np.ones(COUNT)}
    return (
        BenchCase(f"{COUNT} catenaries", farm(COUNT), 2, 50, "line-steps/s", static, motion(COUNT)),
    )
