"""What the laws of the contract are tried on: gas at rest, a stream over a wall, a shock tube."""

from dataclasses import replace
from typing import Any

import numpy as np

from quintet.interfaces.manifest import ConformCase

BOX = {"lowest": [0.0, 0.0, 0.0], "highest": [1.0, 1.0, 1.0], "spacing": 0.1, "jitter": 0.3}
AIR: dict[str, Any] = {"density": 1.2, "pressure": 1.0}
STEP = 0.02  # s


def cases() -> tuple[ConformCase, ...]:
    """Gas at rest in a box of walls; moving gas between inflow, outflow and a wall."""
    closed = {"kind": "slip"}
    wind = AIR | {"velocity": [3.0, 0.0, -0.2]}
    rest = {
        "box": BOX,
        "initial": AIR,
        "boundaries": {"x-": closed, "x+": closed, "z-": closed, "z+": closed},
        "probes": [[0.5, 0.0, 0.5]],
    }
    stream = {
        "box": BOX,
        "initial": wind,
        "boundaries": {
            "x-": {"kind": "inflow", "state": wind},
            "x+": {"kind": "outflow"},
            "z-": closed,
            "z+": {"kind": "inflow", "state": wind},
        },
    }
    tube = {
        "box": BOX,
        "riemann": {
            "position": 0.5,
            "left": {"density": 1.0, "pressure": 1.0},
            "right": {"density": 0.125, "pressure": 0.1},
        },
        "boundaries": {"x-": closed, "x+": closed},
    }
    return (
        ConformCase("gas at rest", rest, dt=STEP),
        _dusty(),
        _body(),
        ConformCase(
            "stream over a wall",
            stream,
            dt=0.2 * STEP,
            still=False,
            smooth=False,  # it is limited, and the wall stops what strikes it
        ),
        ConformCase("shock tube", tube, dt=STEP, still=False, smooth=False),
        *_on_devices(stream),
    )


def _on_devices(stream: dict[str, Any]) -> tuple[ConformCase, ...]:
    """A stream and a body on a device, where there is one."""
    # Loads pyopencl where it is installed; these cases alone ask for it.
    from quintet.components.shared.opencl.devices import is_any_there

    if not is_any_there():
        return ()
    name = "stream over a wall, OpenCL"
    step = 0.2 * STEP
    return (
        ConformCase(name, stream, dt=step, still=False, smooth=False, device="opencl"),
        replace(_body(), name="a body in a gas, OpenCL", device="opencl"),
    )


def _dusty() -> ConformCase:
    """Particles that nodes do not resolve, in a gas at rest."""
    return ConformCase(
        "particles in a gas",
        {
            "box": {**BOX, "jitter": 0.0},
            "neighbours": 8,
            "initial": {"temperature": 300.0, "pressure": 1e5},
            "particles": {"heat": "fox"},
        },
        static={
            "particles.mass": np.full(2, 0.02),
            "particles.heat_capacity": np.full(2, 20.0),
            "particles.number": np.full(2, 1e7),
        },
        rest={
            "particles.position": np.array([[0.52, 0.0, 0.33], [0.61, 0.0, 0.77]]),
            "particles.velocity": np.zeros((2, 3)),
            "particles.acceleration": np.zeros((2, 3)),
            "particles.temperature": np.full(2, 300.0),
            "particles.diameter": np.full(2, 1e-5),
            "particles.launched": np.ones(2),
        },
        scale={
            "particles.position": 0.02,
            "particles.velocity": 10.0,
            "particles.temperature": 20.0,
        },
        dt=5e-5,
        still=False,  # temperatures are those of the gas to rounding
        smooth=False,  # its change is that of the last stage
    )


def _body() -> ConformCase:
    """A body with a cloud of its own, which a partner moves, in a gas at rest."""
    closed = {"kind": "slip"}
    body = {
        "centre": [0.0, 0.0, 0.0],
        "radius": 0.2,
        "is_driven": True,
        "points_around": 16,
        "thickness": 0.25,
        "spacing": 0.1,
    }
    return ConformCase(
        "a body in a gas",
        {
            "box": {"lowest": [-1.0, 0.0, -1.0], "highest": [1.0, 0.0, 1.0], "spacing": 0.1},
            "neighbours": 8,
            "initial": AIR,
            "boundaries": {"x-": closed, "x+": closed, "z-": closed, "z+": closed},
            "moving": {"bodies": [body]},
        },
        static={
            "motion.radius": np.full(1, 0.2),
            "motion.mass": np.ones(1),
        },
        rest={
            "motion.position": np.zeros((1, 3)),
            "motion.velocity": np.zeros((1, 3)),
            "motion.orientation": np.array([[1.0, 0.0, 0.0, 0.0]]),
            "motion.angular_velocity": np.zeros((1, 3)),
        },
        scale={
            "motion.position": (0.01, 0.0, 0.01),  # in the plane
            "motion.velocity": (0.1, 0.0, 0.1),
            "motion.angular_velocity": 0.1,
        },
        dt=0.2 * STEP,
        still=False,  # rings and lattice do not balance each other to rounding
        smooth=False,  # its change is that of the last stage
    )
