"""Gauges lie where fluid can be: one outside the tank would measure nothing, without a word."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from quintet.components.sph_fluid.params import SphFluidParams

ROUNDING = 1e-6  # of a spacing


def check_gauges(params: "SphFluidParams") -> None:
    """Refuse gauges beyond a wall of the tank or inside an obstacle."""
    walls, tolerance = params.boundary.tank, ROUNDING * params.spacing
    for name, point in _points(params):
        for axis, value in enumerate(point) if walls else ():
            if params.dimensions == 2 and axis == 1:
                continue
            assert walls is not None
            low, high = walls[0][axis], walls[1][axis]
            closed = [f"{'xyz'[axis]}{side}" not in params.boundary.open_faces for side in "-+"]
            below, above = value < low - tolerance, value > high + tolerance
            if (below and closed[0]) or (above and closed[1]):
                raise ValueError(
                    f"gauges.{name} must be inside the walls along {'xyz'[axis]}, {low:g} to "
                    f"{high:g} m; found {value:g} m, where there is no fluid. Move the gauge."
                )
        for number, (lowest, highest) in enumerate(params.boundary.solids):
            inside = [
                low + tolerance < value < high - tolerance
                for low, value, high in zip(lowest, point, highest, strict=False)
            ]
            if len(point) == 3 and all(inside):
                raise ValueError(
                    f"gauges.{name} must not be inside boundary.obstacles[{number}]; found "
                    f"{tuple(point)} m. Move the gauge into the fluid."
                )


def _points(params: "SphFluidParams") -> Iterator[tuple[str, tuple[float, ...]]]:
    for number, point in enumerate(params.gauges.pressure_gauges):
        yield f"pressure_gauges[{number}]", point
    for number, spot in enumerate(params.gauges.level_gauges):
        yield f"level_gauges[{number}]", spot
