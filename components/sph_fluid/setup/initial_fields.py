"""Velocity and density of a fluid at the start, as fields; imported only by a scene that asks."""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from quintet.components.sph_fluid.setup.expressions import values_at
from quintet.components.sph_fluid.setup.field_table import FieldTable, read_table
from quintet.components.sph_fluid.setup.geometry import Box

if TYPE_CHECKING:
    from quintet.components.sph_fluid.params import SphFluidParams

Array = NDArray[np.float64]
COMPRESSED = 0.1  # of ρ₀, that the density of a weakly compressible fluid may differ by


def initial_velocity(points: Array, params: "SphFluidParams") -> Array | None:
    """Velocity (n, 3) m/s at points (n, 3) m; None if nothing is said of it."""
    initial = params.initial
    assert initial is not None
    if initial.velocity is not None:
        parts = [values_at(component, points, "initial.velocity") for component in initial.velocity]
        return np.stack(parts, axis=1)
    table = _table(params)
    if table is None or not table.has("u", "v", "w"):
        return None
    return np.stack([table.at(points, name) for name in "uvw"], axis=1)


def initial_density(points: Array, params: "SphFluidParams") -> Array | None:
    """Density (n,) kg/m3 at points (n, 3) m; None if nothing is said of it."""
    initial, table = params.initial, None
    assert initial is not None
    if initial.density is not None:
        densities = values_at(initial.density, points, "initial.density")
    elif (table := _table(params)) is not None and table.has("density"):
        densities = table.at(points, "density")
    else:
        return None
    worst = int(np.argmax(np.abs(densities - params.density)))
    if abs(densities[worst] - params.density) > COMPRESSED * params.density:
        x, y, z = points[worst].tolist()
        raise ValueError(
            f"initial density must be within {100.0 * COMPRESSED:g} % of {params.density:g} kg/m3, "
            f"of a weakly compressible fluid; found {densities[worst]:.5g} at ({x:.4g}, {y:.4g}, "
            f"{z:.4g}) m. Correct it, or density."
        )
    return densities


def check_initial(params: "SphFluidParams", boxes: tuple[Box, ...]) -> None:
    """Refuse fields that are no numbers in the middle of the fluid's boxes or next to corners."""
    initial, table = params.initial, _table(params)
    ends = np.array(boxes)  # (n, 2, 3) m
    places = [ends[:, 0] + share * (ends[:, 1] - ends[:, 0]) for share in (0.01, 0.5, 0.99)]
    corners = np.concatenate(places)
    assert initial is not None
    for name, columns in (("velocity", "uvw"), ("density", ("density",))):
        if table is not None and table.has(*columns) and getattr(initial, name) is not None:
            raise ValueError(
                f"initial.{name} must be said once; found it and columns {', '.join(columns)} of "
                "the table. Remove one of them."
            )
    if params.wave is not None and initial_velocity(corners, params) is not None:
        raise ValueError(
            "initial velocity and wave both say how the fluid moves at the start. Remove one."
        )
    initial_velocity(corners, params)
    initial_density(corners, params)


def _table(params: "SphFluidParams") -> FieldTable | None:
    assert params.initial is not None
    return read_table(params.initial.table) if params.initial.table is not None else None
