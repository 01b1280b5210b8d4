"""Optional parts on devices as objects: sums over pairs, copies of other ranks' particles."""

from typing import TYPE_CHECKING, Any, NamedTuple

from numpy.typing import NDArray

from quintet.components.sph_solid.neighbours import SolidLists
from quintet.components.sph_solid.opencl.current_sums import DeviceCurrentSums
from quintet.components.sph_solid.opencl.device_state import MakeCopies
from quintet.components.sph_solid.opencl.images import DeviceImages
from quintet.components.sph_solid.pair_sums import CurrentSums, PairSums
from quintet.components.sph_solid.ranks.method import Ranks
from quintet.components.sph_solid.ranks.one import OneRank
from quintet.interfaces.component import Resources

if TYPE_CHECKING:
    from quintet.components.sph_solid.opencl.reference_sums import DeviceReferenceSums


def has_device_sums(sums: PairSums) -> bool:
    """Whether devices have the sums over pairs of a solid on the processor."""
    if type(sums) is CurrentSums:
        return True
    # Scenes whose neighbours change do not import sums over the neighbours of the start.
    from quintet.components.sph_solid.reference_sums import ReferenceSums

    return type(sums) is ReferenceSums


class CopiesOnDevice(NamedTuple):
    """Kernels that copies of other ranks' particles need, and what makes these copies, if any."""

    source: str
    make: MakeCopies | None


def copies_on_device(ranks: Ranks, resources: Resources, queue: Any) -> CopiesOnDevice:
    """Copies that a rank of the host finds; none on one rank."""
    if isinstance(ranks, OneRank):
        return CopiesOnDevice("", None)
    # Only a solid of several ranks loads mpi4py.
    from quintet.components.shared.opencl import halo
    from quintet.components.sph_solid.opencl.ranks import DeviceCopies
    from quintet.components.sph_solid.ranks.several import SeveralRanks

    assert isinstance(ranks, SeveralRanks)
    communicator = resources.communicator

    def make(images: DeviceImages, kernels: Any) -> DeviceCopies:
        return DeviceCopies(communicator, ranks, images, queue, kernels)

    return CopiesOnDevice(halo.source(), make)


def device_sums(
    queue: Any, kernels: Any, law: NDArray[Any], host: PairSums, lists: SolidLists
) -> "DeviceCurrentSums | DeviceReferenceSums":
    """Sums over pairs as those of the host; see their classes."""
    if not lists.are_for_good:
        return DeviceCurrentSums(queue, kernels, law)
    # Nor those on a device.
    from quintet.components.sph_solid.opencl.reference_sums import DeviceReferenceSums
    from quintet.components.sph_solid.reference_sums import ReferenceSums

    assert isinstance(host, ReferenceSums)
    return DeviceReferenceSums(queue, kernels, law, host, lists)
