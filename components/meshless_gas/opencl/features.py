"""The parts of a gas on a device that its parameters ask for.

Each is imported where a scene asks for it, as on the processor.
"""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from quintet.components.meshless_gas.component import MeshlessGas
from quintet.components.meshless_gas.opencl.device_state import DeviceState
from quintet.components.meshless_gas.opencl.parts import DevicePart
from quintet.components.meshless_gas.opencl.programs import Physics
from quintet.components.meshless_gas.ranks.one import OneRank
from quintet.components.shared.opencl.limits import refuse_parts

if TYPE_CHECKING:
    from quintet.components.meshless_gas.opencl.bodies import DeviceBodies
    from quintet.components.meshless_gas.point_particles.point_particles import CoupledParticles


def physics_of(gas: MeshlessGas) -> Physics:
    """Physics for which the program of a gas is printed."""
    params, moving = gas.params, gas.params.moving
    return Physics(
        planar=params.planar,
        sloped=params.order == 2,
        viscous=params.viscous,
        slides=slides(gas),
        moves=moving is not None,
        has_axis=moving is not None and moving.axisymmetric,
        is_shared=not is_alone(gas),
    )


def slides(gas: MeshlessGas) -> bool:
    """Whether a rarefied gas slides along wall nodes of its cloud."""
    if not gas.params.viscous:
        return False
    # Left out of scenes without friction.
    from quintet.components.meshless_gas.viscous.terms import Viscous

    assert isinstance(gas.friction, Viscous)
    return len(gas.friction.rarefied) > 0


def terms(gas: MeshlessGas, state: DeviceState, device: str) -> list[DevicePart]:
    """Parts of a gas on a device, in the order of their terms.

    All parts of a gas have a counterpart on devices. A part that is new on the processor is
    refused until it has one: a step on a device would leave it out.

    Raises
    ------
    SceneError
        For parts without a counterpart.
    """
    names = [type(part).__name__ for part in gas.parts]
    refuse_parts([name for name in names if name not in {*MAKERS, *ABSENT}], device, "a gas")
    parts: list[DevicePart] = []
    for name, part in zip(names, gas.parts, strict=True):
        if name in MAKERS:
            parts.append(MAKERS[name](part, gas, state, parts))
    return parts + ranks(gas, state)


def ranks(gas: MeshlessGas, state: DeviceState) -> list[DevicePart]:
    """Exchange between ranks, which comes after all else."""
    if is_alone(gas):
        return []
    # Left out of a gas of one rank.
    from quintet.components.meshless_gas.opencl.ranks import DeviceRanks

    return [DeviceRanks(gas, state)]


def is_alone(gas: MeshlessGas) -> bool:
    """Whether a gas has one rank."""
    return type(gas.all_ranks) is OneRank


def particles_of(gas: MeshlessGas) -> "list[CoupledParticles]":
    """Point particles of a gas on the processor."""
    if gas.params.particles is None:
        return []
    # Left out of scenes without particles.
    from quintet.components.meshless_gas.point_particles.point_particles import CoupledParticles

    return [part for part in gas.parts if isinstance(part, CoupledParticles)]


def bodies_of(gas: MeshlessGas, parts: list[DevicePart]) -> "list[DeviceBodies]":
    """Bodies that carry clouds, among parts on a device."""
    if gas.params.moving is None:
        return []
    # Left out of scenes without bodies that carry clouds.
    from quintet.components.meshless_gas.opencl.bodies import DeviceBodies

    return [part for part in parts if isinstance(part, DeviceBodies)]


def friction(part: Any, gas: MeshlessGas, state: DeviceState, before: Any) -> DevicePart:
    """Viscosity and heat conduction."""
    # Left out of scenes without friction.
    from quintet.components.meshless_gas.opencl.friction import DeviceFriction

    return DeviceFriction(part, state)


def bodies(part: Any, gas: MeshlessGas, state: DeviceState, before: Any) -> DevicePart:
    """Bodies that carry clouds."""
    # Left out of scenes without such bodies.
    from quintet.components.meshless_gas.opencl.bodies import DeviceBodies

    return DeviceBodies(part, gas.all_ranks, state)


def axis(part: Any, gas: MeshlessGas, state: DeviceState, before: Any) -> DevicePart:
    """Terms of an axis of symmetry, of bodies that carry clouds."""
    # Left out of scenes without such an axis.
    from quintet.components.meshless_gas.opencl.axis import DeviceAxis

    return DeviceAxis(part.gamma, state)


def axis_stresses(
    part: Any, gas: MeshlessGas, state: DeviceState, before: list[DevicePart]
) -> DevicePart:
    """Viscous stresses about this axis."""
    # Left out of scenes without such an axis, and of those without friction.
    from quintet.components.meshless_gas.opencl.axis import DeviceAxisStresses
    from quintet.components.meshless_gas.opencl.friction import DeviceFriction

    (viscous,) = (term for term in before if isinstance(term, DeviceFriction))
    return DeviceAxisStresses(viscous, part.viscous.law.conduction)


def particles(part: Any, gas: MeshlessGas, state: DeviceState, before: Any) -> DevicePart:
    """Point particles of a partner."""
    # Left out of scenes without particles.
    from quintet.components.meshless_gas.opencl.particles import DeviceParticles

    return DeviceParticles(part, gas.motion.domain, gas.fluxes, state)


# By the class of a part on the processor: makes that on a device, from it, the gas, its state on
# the device, and the parts before it.
MAKERS: dict[str, Callable[[Any, MeshlessGas, DeviceState, list[DevicePart]], DevicePart]] = {
    "Viscous": friction,
    "MovingClouds": bodies,
    "AxisTerms": axis,
    "AxisStresses": axis_stresses,
    "CoupledParticles": particles,
}
ABSENT = ("Inviscid", "FixedNodes")  # without terms
