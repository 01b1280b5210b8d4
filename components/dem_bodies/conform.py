"""Cases for the laws of the contract: two weightless bodies that hover over a floor."""

from dataclasses import replace
from typing import Any

import numpy as np

from quintet.interfaces.manifest import ConformCase

WOOD = {"youngs_modulus": 1e7, "poissons_ratio": 0.3, "restitution": 0.5, "friction": 0.4}
BOX = {"shape": "box", "density": 500.0, "material": "wood"}
BALL = {"shape": "sphere", "radius": 0.05, "density": 500.0, "material": "wood"}
WEDGE = {
    "shape": "polygon",
    "corners": [[0.0, 0.0], [0.1, 0.0], [0.0, 0.1]],
    "density": 500.0,
    "material": "wood",
    "origin": [1.0 - 0.1 / 3.0, 2.0, 3.0 - 0.1 / 3.0],
}
WHEEL = {**BALL, "shape": "disc", "centre": [1.0, 2.0, 3.12]}
NONE = np.zeros((2, 3))


def cases() -> tuple[ConformCase, ...]:
    """Boxes and spheres; contact forces wanted; two spheres that collide; two dimensions."""
    boxes, balls = _above_floor(BOX, 3.2), _above_floor(BALL, 3.15)
    strike = {**balls, "contact_forces": True, "front_gauge": "z", "planes": []}
    first, second = (dict(body) for body in balls["bodies"])
    strike["bodies"] = [
        {**first, "velocity": [0.0, 0.0, 2.0], "angular_velocity": [3.0, 0.0, 0.0]},
        {**second, "centre": [1.0, 2.0, 3.1001]},
    ]
    plane = {**boxes, "dimensions": 2, "bodies": [WEDGE, WHEEL]}
    with_forces = {**balls, "contact_forces": True}
    return (
        _case("boxes", boxes),
        _case("boxes, contact forces", {**boxes, "contact_forces": True}),
        _case("spheres", balls),
        _case("spheres that collide", strike, still=False, smooth=False),
        _on_a_face({**balls, "contact_with_faces": True, "planes": []}),
        _case("two dimensions", plane, forces=()),  # the plane takes the loads across it
        *_on_devices(
            _case("spheres, contact forces", with_forces),
            _case("spheres that collide", strike, still=False, smooth=False),
        ),
    )


def _on_devices(*of_spheres: ConformCase) -> tuple[ConformCase, ...]:
    """Cases of spheres on a device, where there is one."""
    # Loads pyopencl where it is installed; these cases alone ask for it.
    from quintet.components.shared.opencl.devices import is_any_there

    if not is_any_there():
        return ()
    return tuple(replace(case, name=f"{case.name}, OpenCL", device="opencl") for case in of_spheres)


def _at(z: float, body: dict[str, Any]) -> dict[str, Any]:
    if body["shape"] == "sphere":
        return {**body, "centre": [1.0, 2.0, z]}
    return {**body, "lowest": [0.95, 1.95, z - 0.05], "highest": [1.05, 2.05, z + 0.05]}


def _above_floor(body: dict[str, Any], height: float) -> dict[str, Any]:
    floor = {"point": [0.0, 0.0, 2.9], "normal": [0.0, 0.0, 1.0], "material": "wood"}
    return {
        "gravity": [0.0, 0.0, 0.0],
        "materials": {"wood": WOOD},
        "bodies": [_at(z, body) for z in (3.0, height)],
        "planes": [floor],
    }


def _case(name: str, params: dict[str, Any], **more: Any) -> ConformCase:
    loads: dict[str, Any] = {
        "rest": {"load.force": NONE, "load.torque": NONE},
        "scale": {"load.force": 1.0, "load.torque": 0.1},
        "forces": ("load.force",),
    }
    return ConformCase(name, params, dt=1e-4, **(loads | more))


def _on_a_face(params: dict[str, Any]) -> ConformCase:
    """Spheres above a face, which may rise to them."""
    corners = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 4.0], [0.0, 4.0]])
    lowest = min(body["centre"][2] for body in params["bodies"])
    place = np.column_stack([corners, np.full(4, lowest - BALL["radius"] - 1e-9)])
    static = {
        "corner": np.arange(4.0)[None], "mass": np.full(4, 0.05), "bulk": np.full(1, 1e7),
        "shear": np.full(1, 5e6), "thickness": np.full(1, 0.1), "friction": np.full(1, 0.3),
        "stiffness": np.full(1, 1.0), "safety": np.full(1, 0.9), "points": np.ones(1),
        "step": np.full(1, 1e-3), "width": np.full(1, 4.0),
    }  # fmt: skip
    motion = {"position": place, "velocity": np.zeros((4, 3))}
    case = _case("spheres on a face", params, smooth=False)
    return replace(
        case,
        static={**case.static, **{f"contact_faces.{key}": field for key, field in static.items()}},
        rest={
            **case.rest,
            **{f"contact_faces.{key}": field for key, field in motion.items()},
            "contact_activity.active": np.ones(1),
        },
        scale={**case.scale, "contact_faces.position": 1e-4},
        forces=("load.force", "contact_load.force"),
    )
