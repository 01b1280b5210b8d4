"""Gauges of a fluid: they lie where fluid can be, or they would measure nothing."""

from collections.abc import Iterator
from typing import ClassVar

from quintet.components.sph_fluid.setup.boundary import Boundary
from quintet.components.sph_fluid.setup.geometry import ROUNDING, Axis, Spot
from quintet.interfaces.params import Number, Vector, parameters


@parameters
class Gauges:
    """What is measured in a fluid; each gauge is a port of its own.

    Parameters
    ----------
    pressure_gauges : m
        Points at which the pressure is given [Pa].
    level_gauges : m
        x and y of the verticals on which the surface's height is given [m].
    velocity_gauges : m
        Points at which the fluid's velocity is given [m/s].
    discharge_gauges : m
        Places along x of sections across the flow, through which the discharge is given [m3/s].
    front_gauge
        Axis along which the position of the furthest fluid is given [m].
    motion_gauge
        Whether the largest speed [m/s], energies [J] and the centre of mass [m] are given.
    mass_gauge
        Whether the masses [kg] are given that are there, entered, left and were lost or removed.
    """

    RENAMED: ClassVar = {"front": "front_gauge"}

    pressure_gauges: tuple[Vector, ...] = ()
    level_gauges: tuple[Spot, ...] = ()
    velocity_gauges: tuple[Vector, ...] = ()
    discharge_gauges: tuple[Number, ...] = ()
    front_gauge: Axis | None = None
    motion_gauge: bool = False
    mass_gauge: bool = False

    @property
    def any_on(self) -> bool:
        """Whether anything is measured."""
        places = self.pressure_gauges or self.level_gauges
        flow = self.velocity_gauges or self.discharge_gauges
        return bool(places or flow or self.front_gauge or self.motion_gauge or self.mass_gauge)

    def check(self, boundary: Boundary, spacing: float, dimensions: int, reach: float) -> None:
        """Refuse gauges beyond a wall or inside an obstacle, and sections near a face.

        `reach` [m] is the radius of the kernel.
        """
        tolerance = ROUNDING * spacing
        for number, section in enumerate(self.discharge_gauges):
            section_name = f"gauges.discharge_gauges[{number}]"
            _require_whole_section(section_name, section, boundary, reach - tolerance)
        for name, point in self._points():
            require_within_walls(f"gauges.{name}", point, boundary, tolerance, dimensions)
            for number, (lowest, highest) in enumerate(boundary.solids):
                inside = [
                    low + tolerance < value < high - tolerance
                    for low, value, high in zip(lowest, point, highest, strict=False)
                ]
                if len(point) == 3 and all(inside):
                    raise ValueError(
                        f"gauges.{name} must not be inside boundary.obstacles[{number}]; found "
                        f"{tuple(point)} m. Move the gauge into the fluid."
                    )

    @property
    def fluid_points(self) -> list[tuple[str, Vector]]:
        """Names and places [m] of the gauges that must not be inside a solid."""
        return [
            (name, (point[0], point[1], point[2]))
            for name, point in self._points()
            if len(point) == 3
        ]

    def _points(self) -> Iterator[tuple[str, tuple[float, ...]]]:
        for number, point in enumerate(self.pressure_gauges):
            yield f"pressure_gauges[{number}]", point
        for number, point in enumerate(self.velocity_gauges):
            yield f"velocity_gauges[{number}]", point
        for number, place in enumerate(self.discharge_gauges):
            yield f"discharge_gauges[{number}]", (place,)
        for number, spot in enumerate(self.level_gauges):
            yield f"level_gauges[{number}]", spot


def require_within_walls(
    name: str, point: tuple[float, ...], boundary: Boundary, tolerance: float, dimensions: int
) -> None:
    """Refuse a gauge at x, y and, if it has one, z [m], that lies beyond a closed wall."""
    for axis, value in enumerate(point) if boundary.tank else ():
        if dimensions == 2 and axis == 1:
            continue
        assert boundary.tank is not None
        low, high = boundary.tank[0][axis], boundary.tank[1][axis]
        closed = [f"{'xyz'[axis]}{side}" not in boundary.open_faces for side in "-+"]
        below, above = value < low - tolerance, value > high + tolerance
        if (below and closed[0]) or (above and closed[1]):
            raise ValueError(
                f"{name} must be inside the walls along {'xyz'[axis]}, {low:g} to {high:g} m; "
                f"found {value:g} m, where there is no fluid. Move the gauge."
            )


def _require_whole_section(name: str, section: float, boundary: Boundary, reach: float) -> None:
    """Refuse a section x [m] whose neighbourhood, `reach` [m] to both sides, leaves the tank.

    Fluid that falls over an open face is on both sides of it: such a face is no limit.
    """
    if boundary.tank is None:
        return
    passages = [passage.face for passage in boundary.inflow]
    passages += [passage.face for passage in boundary.outflow]
    low, high = boundary.tank[0][0], boundary.tank[1][0]
    is_periodic = "x" in boundary.periodic
    depth = {"x-": section - low, "x+": high - section}  # m, inside each face
    for face, inside in depth.items():
        is_limit = is_periodic or face in passages or face not in boundary.open_faces
        least = 0.0 if is_periodic else reach
        if is_limit and inside < least:
            raise ValueError(
                f"{name} must be inside the tank, {least:.4g} m or more from its face {face}, or "
                f"it misses a part of the flow; found x = {section:g} m in a tank from {low:g} to "
                f"{high:g} m. Move the section."
            )
