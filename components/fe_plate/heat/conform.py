"""What the laws of the contract are tried on: a small block, heated, held, and steady."""

from typing import Any

import numpy as np

from quintet.interfaces.manifest import ConformCase

PART: dict[str, Any] = {
    "lowest": [0.0, 0.0, 0.0],
    "highest": [0.03, 0.02, 0.02],
    "elements": [3, 2, 2],
    "conductivity": 237.0,
    "density": 2700.0,
    "specific_heat": 900.0,
    "temperature": 300.0,
}
END = {"lowest": [0.0, 0.0, 0.0], "highest": [0.0, 0.02, 0.02]}
NODES = 36 - 2  # of its surface
FACE_NODES = 9  # of its other end


def cases() -> tuple[ConformCase, ...]:
    """A block that is insulated; one that is held at an end; the same, steady."""
    held = {"parts": [PART], "fixed_temperatures": [{**END, "temperature": 300.0}]}
    far = {"lowest": [0.03, 0.0, 0.0], "highest": [0.03, 0.02, 0.02]}
    coupled = {**held, "coupled_faces": [far], "node_gauges": [[0.01, 0.0, 0.0]]}
    return (
        _case("insulated", {"parts": [PART]}),
        _case("held at an end", coupled, nodes=FACE_NODES),
        _case("steady", {**held, "steady": True}, smooth=False),  # it has no time
    )


def _case(
    name: str, params: dict[str, Any], nodes: int = NODES, smooth: bool = True
) -> ConformCase:
    return ConformCase(
        name,
        params,
        rest={"node_heat.heat_flow": np.zeros(nodes)},
        scale={"node_heat.heat_flow": 1.0},
        dt=0.1,
        smooth=smooth,
    )
