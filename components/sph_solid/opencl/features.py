"""Optional physics on devices as objects: which sums over pairs a scene needs."""

from typing import TYPE_CHECKING, Any

from numpy.typing import NDArray

from quintet.components.sph_solid.neighbours import SolidLists
from quintet.components.sph_solid.opencl.current_sums import DeviceCurrentSums
from quintet.components.sph_solid.pair_sums import CurrentSums, PairSums

if TYPE_CHECKING:
    from quintet.components.sph_solid.opencl.reference_sums import DeviceReferenceSums


def has_device_sums(sums: PairSums) -> bool:
    """Whether devices have the sums over pairs of a solid on the processor."""
    if type(sums) is CurrentSums:
        return True
    # Scenes whose neighbours change do not import sums over the neighbours of the start.
    from quintet.components.sph_solid.reference_sums import ReferenceSums

    return type(sums) is ReferenceSums


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
