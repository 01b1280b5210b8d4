"""Cases for the laws of the contract: a straight line and catenaries that hold two bodies."""

from typing import Any

import numpy as np

from quintet.interfaces.manifest import ConformCase

SCALE = {
    "motion.position": 0.05,
    "motion.velocity": 0.1,
    "motion.orientation": 0.1,
    "motion.angular_velocity": 0.1,
}


def rest() -> dict[str, np.ndarray[Any, Any]]:
    """Two bodies at rest."""
    return {
        "motion.position": np.array([[7.0, 0.0, 3.0], [9.0, 0.0, 3.0]]),
        "motion.velocity": np.zeros((2, 3)),
        "motion.orientation": np.tile([1.0, 0.0, 0.0, 0.0], (2, 1)),
        "motion.angular_velocity": np.zeros((2, 3)),
    }


def cases() -> tuple[ConformCase, ...]:
    """Lines without weight; lines that lie on the bed, hang, and are taut."""
    static = {"motion.mass": np.ones(2)}
    straight = {"anchor": [0.0, 0.0, 0.0], "length": 7.0, "stiffness": 1e4}
    heavy = {"stiffness": 1e5, "weight": 50.0}
    first = {"body": 0, "fairlead": [6.9, 0.1, 3.0]}
    second = {"body": 1, "fairlead": [9.1, 0.1, 3.0]}
    hanging = [
        {**heavy, **first, "anchor": [0.0, 0.0, 0.0], "length": 9.5},
        {**heavy, **first, "anchor": [12.0, 1.0, 0.0], "length": 5.7},
        {**heavy, **second, "anchor": [12.0, 0.0, 4.0], "length": 5.0, "on_bed": False},
    ]
    # A case holds positions while velocities are not 0; the gauge is read half a step ahead.
    common: dict[str, Any] = {
        "static": static, "rest": rest(), "scale": SCALE, "dt": 1e-2, "still": False,
        "smooth": False,
    }  # fmt: skip
    return (
        ConformCase(
            "straight lines", {"lines": [{**straight, **first}, {**straight, **second}]}, **common
        ),
        ConformCase("catenaries", {"lines": hanging}, **common),
    )
