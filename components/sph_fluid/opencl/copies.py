"""What stands behind the rows of a fluid on a device: copies of other ranks' rows, and images."""

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple, Protocol

from quintet.components.shared.opencl.arrays import DeviceArray
from quintet.components.shared.search.neighbours import Around
from quintet.components.sph_fluid.boundary.method import BoundaryMethod
from quintet.components.sph_fluid.boundary.symmetry_planes import NoSymmetry, SymmetryPlanes
from quintet.components.sph_fluid.state import State


class Copies(Protocol):
    """Rows behind those that a rank owns."""

    are_there: bool  # whether there may be any; then rows are sorted on the host, which finds them

    @property
    def count(self) -> int:
        """How many there are."""

    def around(self, state: State, reach: float, boundary: BoundaryMethod) -> Around | None:
        """Make room for them in a state with lists, and find what may be near; None: all own."""

    def write(self, position: DeviceArray, velocity: DeviceArray) -> None:
        """Bring those of positions and velocities (n + count, 4) up to date."""

    def write_apparent(self, apparent: DeviceArray) -> None:
        """Bring those of velocities that viscosity sees (n + count, 4) up to date."""

    def reflect_crossed(self, split: int, *arrays: DeviceArray | None) -> None:
        """Bring back fluid that passed a plane: positions, velocities, accelerations or None."""


class NoCopies:
    """Those of one rank without planes of symmetry."""

    are_there = False

    @property
    def count(self) -> int:
        """None."""
        return 0

    def around(self, state: State, reach: float, boundary: BoundaryMethod) -> None:
        """Nothing to find: a rank's own rows are all."""

    def write(self, position: DeviceArray, velocity: DeviceArray) -> None:
        """Nothing to do."""

    def write_apparent(self, apparent: DeviceArray) -> None:
        """Nothing to do."""

    def reflect_crossed(self, split: int, *arrays: DeviceArray | None) -> None:
        """Nothing to do."""


class CopiesOnDevice(NamedTuple):
    """Kernels that a fluid's copies need, and what makes them of a queue and built kernels."""

    source: str
    make: Callable[[Any, Any], Copies]


NONE = CopiesOnDevice("", lambda queue, kernels: NoCopies())


def copies_on_device(symmetry: SymmetryPlanes, communicator: Any, repeats: bool) -> CopiesOnDevice:
    """Return what makes copies and images; `symmetry` is the host's, which finds them.

    `repeats` tells whether the tank repeats along an axis.
    """
    if isinstance(symmetry, NoSymmetry):
        return NONE
    if communicator is None or communicator.size == 1:
        return images_of_periods(symmetry) if repeats else images_of_one_rank(symmetry)
    # Only a fluid of several ranks loads mpi4py.
    from quintet.components.shared.opencl import halo
    from quintet.components.sph_fluid.opencl import images
    from quintet.components.sph_fluid.opencl.ranks import DeviceCopies
    from quintet.components.sph_fluid.ranks.halo import HaloAndImages

    assert isinstance(symmetry, HaloAndImages)
    make = partial(DeviceCopies, communicator, symmetry)
    return CopiesOnDevice(images.SOURCE.read_text() + halo.source(), make)


def images_of_one_rank(symmetry: SymmetryPlanes) -> CopiesOnDevice:
    """Return what makes images in planes of symmetry."""
    # Left out of fluids without planes of symmetry.
    from quintet.components.sph_fluid.boundary.symmetry import Symmetry
    from quintet.components.sph_fluid.opencl import images

    assert isinstance(symmetry, Symmetry)
    make = partial(images.ImagesOfOneRank, symmetry)
    return CopiesOnDevice(images.SOURCE.read_text(), make)


def images_of_periods(symmetry: SymmetryPlanes) -> CopiesOnDevice:
    """Return what makes images a period away."""
    # Left out of fluids whose tank does not repeat.
    from quintet.components.sph_fluid.open_boundaries.periodic import PeriodicImages
    from quintet.components.sph_fluid.opencl import periods

    assert isinstance(symmetry, PeriodicImages)
    make = partial(periods.DevicePeriods, symmetry)
    return CopiesOnDevice(periods.SOURCE.read_text(), make)
