"""Copies of the particles of other ranks that a rank's own may touch, wherever they were first."""

from typing import Any

from quintet.components.shared.domain.copies import CopiesAndImages, Group
from quintet.components.sph_solid.state import Array, Whole


class ContactCopies:
    """Copies behind a rank's own rows, from one list of contact pairs to the next.

    Parameters
    ----------
    communicator : mpi4py communicator
    keys : (n,) int array
        Numbers that rise in the order in which one rank would have the rows of this one.
    """

    def __init__(self, communicator: Any, keys: Whole) -> None:
        self._rows, self._keys = CopiesAndImages(communicator, []), keys

    @property
    def rows(self) -> tuple[list[Whole], list[Whole]]:
        """For each rank the rows that it gets, and the rows into which its rows go."""
        return self._rows.sent, self._rows.received

    def find(self, places: Array, reach: float) -> tuple[Array, Whole]:
        """Copy what is within a reach [m] of the box around own places (n, 3) m.

        Returns
        -------
        (n + copies, 3) float array, m
            All places, in the order in which one rank would have them.
        (n + copies,) int array
            The row of each: own rows first, then copies.
        """
        ((points, row),) = self._rows.copy([Group(places, self._keys, places)], reach)
        return points, row

    def extend(self, *arrays: Array) -> list[Array]:
        """Own rows (n, width) of arrays with the copies (n + copies, width) as they are now."""
        extended = [self._rows.with_room(array, len(array)) for array in arrays]
        self._rows.exchange(*extended)
        return extended
