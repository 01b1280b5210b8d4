"""What a fluid on a device asks of copies of other ranks' rows; a fluid on one rank has none."""

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any, Protocol

from quintet.components.shared.opencl.arrays import DeviceArray
from quintet.components.sph_fluid.boundary.method import BoundaryMethod
from quintet.components.sph_fluid.boundary.symmetry_planes import SymmetryPlanes
from quintet.components.sph_fluid.state import State

if TYPE_CHECKING:  # loads mpi4py
    from quintet.components.sph_fluid.ranks.halo import Around


class Copies(Protocol):
    """Rows behind a rank's own."""

    are_there: bool  # whether there may be any: of several ranks

    @property
    def count(self) -> int:
        """How many there are."""

    def around(self, state: State, reach: float, boundary: BoundaryMethod) -> "Around | None":
        """Make room for copies in a state with lists, and find what may be near; None: all own."""

    def exchange(self, *arrays: DeviceArray) -> None:
        """Bring the copies in arrays (rows + copies, ...) up to date."""


class NoCopies:
    """Those of one rank."""

    are_there = False

    @property
    def count(self) -> int:
        """None."""
        return 0

    def around(self, state: State, reach: float, boundary: BoundaryMethod) -> None:
        """Nothing to find: a rank's own rows are all."""

    def exchange(self, *arrays: DeviceArray) -> None:
        """Nothing to do."""


MakeCopies = Callable[[Any, Any], Copies]  # of a queue and the kernels of its device


def make_copies(symmetry: SymmetryPlanes, communicator: Any) -> MakeCopies | None:
    """Return what makes copies behind the rows of a fluid on several ranks; None on one.

    `symmetry` is the host's, which finds copies where there are several ranks.
    """
    if communicator is None or communicator.size == 1:
        return None
    # Only a fluid of several ranks loads mpi4py.
    from quintet.components.sph_fluid.opencl.ranks import DeviceCopies
    from quintet.components.sph_fluid.ranks.halo import HaloAndImages

    assert isinstance(symmetry, HaloAndImages)
    return partial(DeviceCopies, communicator, symmetry)
