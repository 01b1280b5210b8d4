"""Cases for the laws of the contract: paths, a small recording, and an echo."""

from pathlib import Path
from typing import Any

import h5py
import numpy as np

from quintet.interfaces.manifest import ConformCase
from quintet.interfaces.ports import MOTION, to_json
from quintet.interfaces.recordings import seal, seal_rows

BODY = {"shape": "box", "lowest": [0.95, 1.95, 2.95], "highest": [1.05, 2.05, 3.05]}
TURNING = {**BODY, "velocity": [1.0, 0.0, 0.0], "angular_velocity": [0.0, 2.0, 1.0]}
ROWS, WINDOW = 16, 0.01  # s


def echo() -> tuple[ConformCase, ...]:
    """Four items."""
    rest = {"passed.value": np.zeros((4, 3))}
    return (ConformCase("four items", {"items": 4}, rest=rest, scale={"passed.value": 1.0}),)


def prescribed() -> tuple[ConformCase, ...]:
    """At rest, on a path, with the loads on it, and in two dimensions."""
    load = {"load.force": np.zeros((1, 3)), "load.torque": np.zeros((1, 3))}
    moved = {**TURNING, "amplitude": [0.0, 0.0, 0.1], "frequency": 2.0}
    wedge = {"shape": "polygon", "corners": [[0.0, 0.0], [0.2, 0.0], [0.0, 0.1]]}
    disc = {"shape": "disc", "centre": [1.0, 2.0, 3.0], "radius": 0.05}
    plane = [disc, {**wedge, "origin": [2.0, 0.0, 1.0]}]
    return (
        ConformCase("at rest", {"bodies": [BODY]}),
        ConformCase("moving", {"bodies": [moved]}, still=False),
        ConformCase("two dimensions", {"bodies": plane}),
        ConformCase(
            "at rest, loads measured",
            {"bodies": [BODY], "measure_loads": True},
            rest=load,
            scale={"load.force": 1.0, "load.torque": 1.0},
        ),
    )


def replay() -> tuple[ConformCase, ...]:
    """Bodies that fly and turn steadily."""
    return (ConformCase("motion", _recorded, dt=WINDOW, still=False, any_time=False),)


def _recorded(folder: Path) -> dict[str, Any]:
    """Write the smallest recording that can be replayed."""
    time = WINDOW * np.arange(ROWS)
    turn = np.array([0.5, -1.0, 0.0])  # rad/s, of two bodies about x, and one that stands
    half = 0.5 * np.outer(time, turn)
    orientation = np.zeros((ROWS, 3, 4))
    orientation[..., 0], orientation[..., 1] = np.cos(half), np.sin(half)
    velocity = np.zeros((ROWS, 3, 3))
    velocity[..., 2] = [1.0, -2.0, 0.0]  # m/s
    fields = {
        "motion.position": velocity * time[:, None, None],
        "motion.velocity": velocity,
        "motion.orientation": orientation,
        "motion.angular_velocity": np.tile(np.outer(turn, [1.0, 0.0, 0.0]), (ROWS, 1, 1)),
    }
    static = {"mass": np.ones(3)}
    with h5py.File(folder / "recording.h5", "w") as file:
        file.attrs["run"], file.attrs["tick"], file["scene"] = "", WINDOW, ""
        group = file.create_group("components/bodies")
        group.attrs["ports"] = to_json((MOTION,))
        group["times"], group["ticks"] = time, np.arange(ROWS)
        group["stable_steps"] = np.full(ROWS, np.inf)
        for key, array in fields.items():
            group[f"fields/{key}"] = array
        for name, array in static.items():
            group[f"static/motion.{name}"] = array
        seal_rows(group, "bodies", ROWS)
        seal(group)
    return {"recording": str(folder), "component": "bodies"}
