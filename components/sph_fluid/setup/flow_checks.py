"""Checks of the buffers of inflows and outflows; imported only by a scene that has some."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from quintet.components.shared.geometry.bounds import Bounds
from quintet.components.sph_fluid.setup.geometry import Face
from quintet.components.sph_fluid.setup.inflow_outflow import Outflow, buffer_layers
from quintet.components.sph_fluid.setup.initial import COMPRESSED
from quintet.components.sph_fluid.setup.tait import TAIT

if TYPE_CHECKING:
    from quintet.components.sph_fluid.setup.mesh_surfaces import Surface


def check_buffers(
    faces: list[Face], tank: Bounds, solids: tuple[Bounds, ...], spacing: float, smoothing: float
) -> None:
    """Refuse buffers that overlap, that leave no room for fluid, or that hold obstacles."""
    depth = buffer_layers(smoothing) * spacing  # m
    if len({face[0] for face in faces}) > 1:
        raise ValueError(
            "boundary.inflow and boundary.outflow must all be across the same axis, or their "
            f"buffers overlap along the edge between two faces; found {', '.join(faces)}. Move "
            "them to one face or to two opposite ones."
        )
    for axis in range(3):
        sides = sorted({face[1] for face in faces if face[0] == "xyz"[axis]})
        low, high = tank[0][axis], tank[1][axis]
        least = len(sides) * depth + 4.0 * smoothing * spacing
        if sides and high - low < least:
            raise ValueError(
                f"boundary.walls must be {least:.4g} m or longer along {'xyz'[axis]}, for the "
                f"buffers of inflows and outflows, {depth:.4g} m each, and fluid; found "
                f"{high - low:g} m. Lengthen the tank, or refine the spacing."
            )
    for number, box in enumerate(solids):
        require_clear(f"boundary.obstacles[{number}]", box, faces, tank, depth)


def check_meshes_in_buffers(
    faces: list[Face], tank: Bounds, surfaces: "Sequence[Surface]", smoothing: float
) -> None:
    """Refuse boundaries from files that reach into buffers."""
    for number, surface in enumerate(surfaces):
        corners, depth = surface.triangles.corner, buffer_layers(smoothing) * surface.spacing
        (x, y, z), (u, v, w) = corners.min(axis=(0, 1)).tolist(), corners.max(axis=(0, 1)).tolist()
        require_clear(f"boundary.meshes[{number}]", ((x, y, z), (u, v, w)), faces, tank, depth)


def require_clear(name: str, box: Bounds, faces: list[Face], tank: Bounds, depth: float) -> None:
    """Refuse a solid, by the box around it, in buffers `depth` [m] behind faces."""
    for face in faces:
        axis = "xyz".index(face[0])
        before = face[1] == "-" and box[0][axis] < tank[0][axis] + depth
        after = face[1] == "+" and box[1][axis] > tank[1][axis] - depth
        if before or after:
            raise ValueError(
                f"{name} must stand outside of the buffers of inflows and outflows, {depth:.4g} m "
                f"from their faces; found {box}. Move it."
            )


def check_pressures(
    outflow: Sequence[Outflow], density: float, sound_speed: float, negative_pressure: bool
) -> None:
    """Refuse pressures of outflows that the fluid cannot have; by Tait's equation.

    Parameters
    ----------
    outflow : list of Outflow
    density : float, kg/m3
        At no pressure.
    sound_speed : float, m/s
    negative_pressure : bool
        Whether pressure may fall below zero.
    """
    stiffness = sound_speed**2 * density / TAIT  # Pa
    least = stiffness * ((1.0 - COMPRESSED) ** TAIT - 1.0) if negative_pressure else 0.0
    most = stiffness * ((1.0 + COMPRESSED) ** TAIT - 1.0)
    for outlet in outflow:
        if outlet.pressure is None or least <= outlet.pressure <= most:
            continue
        advice = "Raise sound_speed, or lower the pressure"
        if outlet.pressure < 0.0:
            advice = "Raise it" if negative_pressure else "Raise it, or set negative_pressure"
        raise ValueError(
            f"boundary.outflow {outlet.face}: pressure must be from {least:.4g} to {most:.4g} Pa, "
            f"for densities within {100.0 * COMPRESSED:g} % of {density:g} kg/m3 and no pressure "
            f"below 0 without negative_pressure; found {outlet.pressure:g} Pa. {advice}."
        )
