"""What the laws of the contract are tried on: small blocks, free, striking and glued."""

from dataclasses import replace
from typing import Any

import numpy as np

from quintet.interfaces.manifest import ConformCase

BLOCK: dict[str, Any] = {
    "spacing": 0.01,
    "bodies": [{"lowest": [0.0, 0.0, 0.0], "highest": [0.05, 0.04, 0.04], "material": "steel"}],
    "gauges": [[0.05, 0.0, 0.0]],
    "levels": [{"body": 0}],
}
STEP = 4e-7  # s
GLUED = 2 * 4 * 4  # particles in two layers
# A face that the block just touches from above.
CORNERS = np.array([[0.0, 0.0, 0.0], [0.05, 0.0, 0.0], [0.05, 0.04, 0.0], [0.0, 0.04, 0.0]])
FACE = {
    "contact_faces.corner": np.arange(4.0)[None],
    "contact_faces.mass": np.full(4, 0.05),
    "contact_faces.bulk": np.full(1, 7e10),
    "contact_faces.shear": np.full(1, 2.6e10),
    "contact_faces.thickness": np.full(1, 0.01),
    "contact_faces.friction": np.full(1, 0.3),
    "contact_faces.stiffness": np.full(1, 1.0),
    "contact_faces.safety": np.full(1, 0.9),
    "contact_faces.points": np.ones(1),
    "contact_faces.width": np.full(1, 0.05),
    "contact_faces.step": np.full(1, 1e-6),
}
ON_FACE = {
    "contact_faces.position": CORNERS,
    "contact_faces.velocity": np.zeros((4, 3)),
    "contact_activity.active": np.ones(1),
}
ON_DEVICES = {
    "striking block", "quarter, corrected", "quarter, neighbours of the start",
    "artificial stress", "rings", "block on a face", "glued block",
}  # fmt: skip
MOVED_FACE = {"contact_faces.position": 1e-5, "contact_faces.velocity": 1.0}


def cases() -> tuple[ConformCase, ...]:
    """Blocks of steel: one that rests, one that is struck, quarters, in a plane, rings, glued."""
    (still,) = BLOCK["bodies"]
    moving = still | {
        "lowest": [0.05, 0.0, 0.0],
        "highest": [0.08, 0.04, 0.04],
        "velocity": [-200.0, 0.0, 0.0],
        "material": "aluminium",
    }
    layers = {"lowest": [0.0, 0.0, 0.0], "highest": [0.02, 0.04, 0.04]}
    rest = {"glued.velocity": np.zeros((GLUED, 3)), "glue_activity.active": np.ones(GLUED)}
    on_processor = (
        ConformCase("block", BLOCK, dt=STEP),
        ConformCase(
            "striking block",
            {**BLOCK, "bodies": [still, moving]},
            dt=STEP,
            still=False,
            smooth=False,  # it begins to yield
        ),
        ConformCase(
            "quarter, corrected",
            {**BLOCK, "symmetry": [{"axis": "y"}, {"axis": "z"}], "kernel_correction": True},
            dt=STEP,
        ),
        ConformCase(
            "quarter, neighbours of the start",
            {**BLOCK, "symmetry": [{"axis": "y"}, {"axis": "z"}], "total_lagrangian": True},
            dt=STEP,
            still=False,  # F at rest is one to rounding, which is 1e-6 Pa of steel
        ),
        ConformCase("artificial stress", {**BLOCK, "artificial_stress": 0.3}, dt=STEP),
        ConformCase("plane strain", {**BLOCK, "dimensions": 2}, dt=STEP),
        ConformCase("rings", {**BLOCK, "dimensions": 2, "axisymmetric": True}, dt=STEP),
        ConformCase(
            "block on a face",
            {**BLOCK, "contact_with_faces": True},
            static=FACE,
            rest=ON_FACE,
            scale=MOVED_FACE,
            dt=STEP,
            smooth=False,  # it touches, or it does not
            forces=("contact_load.force",),
            activity={"contact_activity.active": ()},
        ),
        ConformCase(
            "glued block",
            {**BLOCK, "glued": [layers]},
            rest=rest,
            scale={"glued.velocity": 10.0},
            dt=STEP,
            smooth=False,  # a velocity that jumps is a force without end
            activity={"glue_activity.active": ("glued", "glued_load")},
        ),
    )
    return on_processor + on_devices(on_processor)


def on_devices(on_processor: tuple[ConformCase, ...]) -> tuple[ConformCase, ...]:
    """Some of the same blocks on a device, where there is one."""
    # Loads pyopencl where it is installed; these cases alone ask for it.
    from quintet.components.shared.opencl.devices import is_any_there

    if not is_any_there():
        return ()
    return tuple(
        replace(case, name=f"{case.name}, OpenCL", device="opencl")
        for case in on_processor
        if case.name in ON_DEVICES
    )
