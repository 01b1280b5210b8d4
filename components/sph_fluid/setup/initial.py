"""Velocity and density of a fluid at the start, as numbers, expressions or a table."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from quintet.components.shared.geometry.bounds import Bounds
from quintet.components.sph_fluid.setup.expressions import Expression, values_at
from quintet.interfaces.component import Array
from quintet.interfaces.params import DataFile, parameters

if TYPE_CHECKING:
    from quintet.components.sph_fluid.setup.field_table import FieldTable

COMPRESSED = 0.1  # of ρ₀, that the density of a weakly compressible fluid may differ by


@parameters
class InitialFields:
    """How the fluid moves at the start, and how dense it is.

    Expressions are of x, y and z [m], as "0.1 * sin(2 * pi * x)": numbers, pi, + - * / **, sin,
    cos, tan, sinh, cosh, tanh, exp, log, sqrt, abs, atan2, hypot, min, max, where(a < b, c, d).
    A table is a CSV file whose first line names its columns: of x, y, z [m] those that it depends
    on, of u, v, w [m/s] and density [kg/m3] what it gives. Its rows are the points of a rectangular
    grid; between them it is linear, beyond them as at its edge.

    Parameters
    ----------
    velocity : m/s
        Along x, y and z, each a number or an expression.
    density : kg/m3
        A number or an expression, within 10 % of ρ₀: pressure follows from it by Tait's equation,
        the mass of particles does not. Without it pressure is hydrostatic.
    table
        Name of a table, beside the scene.
    """

    velocity: tuple[Expression, Expression, Expression] | None = None
    density: Expression | None = None
    table: DataFile | None = None

    def velocity_at(self, points: Array) -> Array | None:
        """Velocity (n, 3) m/s at points (n, 3) m; None if nothing is said of it."""
        if self.velocity is not None:
            parts = [values_at(part, points, "initial.velocity") for part in self.velocity]
            return np.stack(parts, axis=1)
        table = self._read_table()
        if table is None or not table.has("u", "v", "w"):
            return None
        return np.stack([table.at(points, name) for name in "uvw"], axis=1)

    def density_at(self, points: Array, unpressed: float) -> Array | None:
        """Density (n,) kg/m3 at points (n, 3) m, near ρ₀; None if nothing is said of it."""
        if self.density is not None:
            densities = values_at(self.density, points, "initial.density")
        elif (table := self._read_table()) is not None and table.has("density"):
            densities = table.at(points, "density")
        else:
            return None
        worst = int(np.argmax(np.abs(densities - unpressed)))
        if abs(densities[worst] - unpressed) > COMPRESSED * unpressed:
            x, y, z = points[worst].tolist()
            raise ValueError(
                f"initial density must be within {100.0 * COMPRESSED:g} % of {unpressed:g} kg/m3, "
                f"of a weakly compressible fluid; found {densities[worst]:.5g} at ({x:.4g}, "
                f"{y:.4g}, {z:.4g}) m. Correct it, or density."
            )
        return densities

    def check(self, boxes: Sequence[Bounds], unpressed: float, has_wave: bool) -> None:
        """Refuse fields that are no numbers in the middle of the fluid's boxes or at corners."""
        table = self._read_table()
        ends = np.array(boxes)  # (n, 2, 3) m
        places = [ends[:, 0] + share * (ends[:, 1] - ends[:, 0]) for share in (0.01, 0.5, 0.99)]
        corners = np.concatenate(places)
        for name, columns in (("velocity", "uvw"), ("density", ("density",))):
            if table is not None and table.has(*columns) and getattr(self, name) is not None:
                raise ValueError(
                    f"initial.{name} must be given once; found it and columns {', '.join(columns)} "
                    "of the table. Remove one of them."
                )
        if has_wave and self.velocity_at(corners) is not None:
            raise ValueError(
                "initial velocity and wave both say how the fluid moves at the start. Remove one."
            )
        self.velocity_at(corners)
        self.density_at(corners, unpressed)

    def _read_table(self) -> "FieldTable | None":
        if self.table is None:
            return None
        # Left out of scenes without a table.
        from quintet.components.sph_fluid.setup.field_table import read_table

        return read_table(self.table)
