"""What the laws of the contract are tried on: a small block, free, clamped, seen in part."""

from dataclasses import replace
from typing import Any

import numpy as np

from quintet.interfaces.manifest import ConformCase

BLOCK: dict[str, Any] = {
    "parts": [
        {
            "lowest": [0.0, 0.0, 0.0],
            "highest": [0.03, 0.02, 0.02],
            "elements": [3, 2, 2],
            "material": {"density": 2700.0, "youngs_modulus": 7e10, "poissons_ratio": 0.3},
        }
    ],
}
NODES = 36 - 2  # of its surface
STEP = 2e-7  # s


def cases() -> tuple[ConformCase, ...]:
    """An elastic block, free; yielding steel, clamped, of hexahedra and tetrahedra."""
    steel = {**BLOCK["parts"][0], "material": "steel"}
    clamped = {
        "parts": [steel],
        "fixed": [{"lowest": [0.0, 0.0, 0.0], "highest": [0.0, 0.02, 0.02]}],
    }
    return (
        _case("free block", BLOCK, forces=("node_load.force",)),
        _case("clamped steel", clamped),
        _case("eight points", {**clamped, "integration": "full"}),
        _case("tetrahedra", {**clamped, "parts": [{**steel, **TETRAHEDRA}]}, nodes=130),
        _case("plane strain", PLANE, nodes=10),
        _case("face of a block", {**BLOCK, "coupled_faces": [FACE]}, nodes=9),
        _case("eroding block", {"parts": [FRAGILE]}, touched=True),
        _on_a_face(_case("block on a face", {**BLOCK, "contact_with_faces": True})),
    )


TETRAHEDRA = {"elements": [3, 2, 2], "tetrahedra": True}  # 175 nodes, less 5 x 3 x 3 inside
PLANE = {
    "parts": [{**BLOCK["parts"][0], "highest": [0.03, 1.0, 0.02], "elements": [3, 1, 2]}],
    "dimensions": 2,
}
FRAGILE = {**BLOCK["parts"][0], "material": {**BLOCK["parts"][0]["material"], "spall_stress": 1e8}}
FACE = {"lowest": [0.03, 0.0, 0.0], "highest": [0.03, 0.02, 0.02]}


# A face that the block just touches from above.
CORNERS = np.array([[-0.1, -0.1, 0.0], [0.1, -0.1, 0.0], [0.1, 0.1, 0.0], [-0.1, 0.1, 0.0]])
TOUCHED = {
    "corner": np.arange(4.0)[None], "mass": np.full(4, 0.05), "bulk": np.full(1, 7e10),
    "shear": np.full(1, 2.6e10), "thickness": np.full(1, 0.01), "width": np.full(1, 0.02),
    "friction": np.full(1, 0.3), "stiffness": np.ones(1), "safety": np.full(1, 0.9),
    "points": np.zeros(1), "step": np.full(1, 1e-6),
}  # fmt: skip


def _on_a_face(case: ConformCase) -> ConformCase:
    """The same above a face of a partner, which may rise to it."""
    motion = {"position": CORNERS, "velocity": np.zeros((4, 3))}
    return replace(
        case,
        static={
            **case.static,
            **{f"contact_faces.{key}": array for key, array in TOUCHED.items()},
        },
        rest={
            **case.rest,
            **{f"contact_faces.{key}": array for key, array in motion.items()},
            "contact_activity.active": np.ones(1),
        },
        scale={"contact_faces.position": 1e-5, "contact_faces.velocity": 1.0},
        smooth=False,  # it touches, or it does not
        forces=("contact_load.force",),
        activity={"contact_activity.active": ()},
    )


def _case(
    name: str, params: dict[str, Any], nodes: int = NODES, forces: tuple[str, ...] = (),
    touched: bool = False,
) -> ConformCase:  # fmt: skip
    load = "contact_surface_load.force" if touched else "node_load.force"
    return ConformCase(
        name,
        params,
        static={"node_load.added_mass": np.zeros(nodes)},
        rest={load: np.zeros((nodes, 3)), "node_mass.added": np.zeros(nodes)},
        scale={load: 100.0},
        dt=STEP,
        forces=forces,
    )
