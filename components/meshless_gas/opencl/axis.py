"""Terms of an axis of symmetry on a device; only for scenes of bodies with clouds about one."""

import numpy as np

from quintet.components.meshless_gas.opencl.device_state import DeviceState
from quintet.components.meshless_gas.opencl.friction import DeviceFriction
from quintet.components.meshless_gas.opencl.parts import DevicePart
from quintet.components.meshless_gas.parts import Stage
from quintet.components.shared.opencl.arrays import DeviceArray


class DeviceAxis(DevicePart):
    """Inviscid fluxes across growing circles.

    Parameters
    ----------
    gamma : float, 1
    state : DeviceState
    """

    def __init__(self, gamma: float, state: DeviceState) -> None:
        self.state, self._gamma = state, np.float64(gamma)

    def add_rates(self, dt: float, stage: Stage) -> None:
        """Add rates of density, momentum and energy."""
        state, cloud = self.state, self.state.cloud
        sizes = map(np.int32, (cloud.inner.shape[0], cloud.nodes, cloud.whole))
        state.run(
            "add_axis", cloud.inner.shape[0], *sizes, cloud.inner, cloud.positions,
            state.primitive, self._gamma, state.residual,
        )  # fmt: skip


class DeviceAxisStresses(DevicePart):
    """Viscous stresses and heat across growing circles; acts after `DeviceFriction`.

    Parameters
    ----------
    friction : DeviceFriction
    conduction : float
        As `Transport` has it.
    """

    def __init__(self, friction: DeviceFriction, conduction: float) -> None:
        self.friction, self._conduction = friction, np.float64(conduction)
        cloud = friction.state.cloud
        self._swelling = DeviceArray(friction.state.queue, (cloud.whole,))  # Pa

    def add_rates(self, dt: float, stage: Stage) -> None:
        """Add rates of momentum and energy."""
        friction, state, cloud = self.friction, self.friction.state, self.friction.state.cloud
        whole = np.int32(cloud.whole)
        state.run(
            "write_swelling", cloud.whole, whole, cloud.positions, state.primitive,
            friction.transported, self._swelling,
        )  # fmt: skip
        count = cloud.inner.shape[0]
        state.run(
            "add_axis_stresses", count, *map(np.int32, (count, cloud.nodes)), whole,
            np.int32(cloud.width), cloud.inner, cloud.positions, state.primitive,
            friction.transported, self._swelling, cloud.neighbours, cloud.coefficients,
            state.gradients, friction.slopes, self._conduction, state.residual,
        )  # fmt: skip
