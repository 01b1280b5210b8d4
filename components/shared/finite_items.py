"""Numbers of items that no step reads again at once, checked at the end of every window."""

from collections.abc import Mapping

import numpy as np

from quintet.interfaces.component import Array
from quintet.interfaces.errors import StepError
from quintet.interfaces.sums import finite


def require_finite_items(
    item: str, fields: Mapping[str, Array], identity: Array, places: Array, advice: str
) -> None:
    """Refuse the first item of which a number is not finite.

    Parameters
    ----------
    item : str
        What an item is: ``"particle"``.
    fields : mapping of (n, ...) float arrays
        By names as a user reads them.
    identity : (n,) int array
        The number by which each item is known through the run.
    places : (n, 3) float array, m
    advice : str
        What to do: a sentence.

    Raises
    ------
    StepError
        With the lowest number, its place and the value found.
    """
    for name, array in fields.items():
        if finite(array):
            continue
        rows = np.flatnonzero(~np.isfinite(array.reshape(len(array), -1)).all(axis=1))
        row = rows[np.argmin(identity[rows])]
        x, y, z = places[row]
        raise StepError(
            f"{name} must be finite; {item} {identity[row]} at ({x:.4g}, {y:.4g}, {z:.4g}) m has "
            f"{np.array2string(np.asarray(array[row]), precision=4)}. {advice}",
            places[row],
        )
