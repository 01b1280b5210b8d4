"""Places over time in a CSV file, with units in the heads of its columns."""

import re
from functools import lru_cache
from pathlib import Path

import numpy as np

from quintet.components.sph_fluid.setup.csv_table import read_csv
from quintet.interfaces.component import Array

UNITS = {"time": "s", "x": "m", "y": "m", "z": "m", "angle": "rad"}
HEAD = re.compile(r"\s*(\w+)\s*(?:\[([^\]]*)\]\s*)?")


@lru_cache(maxsize=8)
def read_motion(file: str) -> tuple[Array, Array]:
    """Read times (n,) s and places (n, 4) m, m, m, rad; columns that are missing are 0.

    Raises
    ------
    ValueError
        Where it is no table of finite numbers with known columns and units.
    """
    name = Path(file).name
    head, numbers = read_csv(file, "motion.file")
    matches = [HEAD.fullmatch(cell) for cell in head]
    columns = [match[1] if match else "" for match in matches]
    right = len(set(columns)) == len(columns) and "time" in columns and len(columns) > 1
    if not (right and set(columns) <= set(UNITS)):
        raise ValueError(
            f"motion.file {name} must have columns time and one or more of x, y, z, angle, each "
            f"once, as in time [s], angle [deg]; found {', '.join(head)[:80]}. Correct its heads."
        )
    if numbers.ndim != 2 or numbers.shape[1] != len(columns) or not np.isfinite(numbers).all():
        raise ValueError(
            f"motion.file {name} must have {len(columns)} finite numbers in each of its lines; "
            f"found {len(numbers)} lines that are not all such. Correct it."
        )
    values = {
        match[1]: column * _factor(name, match[1], match[2])
        for match, column in zip(matches, numbers.T, strict=True)
        if match
    }
    none = np.zeros(len(numbers))
    places = np.stack([values.get(axis, none) for axis in ("x", "y", "z", "angle")], axis=1)
    return values["time"], places


def _factor(name: str, column: str, unit: str | None) -> float:
    """What one unit of a column is in SI."""
    if unit is None or unit.strip() == UNITS[column]:
        return 1.0
    # Left out of tables in SI units: it loads the library of units.
    from quintet.interfaces.quantities import number_in

    return number_in(f"1 {unit.strip()}", UNITS[column], f"motion.file {name}: column {column}")
