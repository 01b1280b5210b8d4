"""Contact of particles on a device with the faces of a partner's mesh.

The host finds the faces and computes the forces, as on the processor: a step copies places and
velocities to it, and the velocities that contact changed back.
"""

from typing import TYPE_CHECKING

from quintet.components.sph_solid.opencl.device_state import DeviceState
from quintet.components.sph_solid.state import State

if TYPE_CHECKING:  # scenes without contact of two components do not import it
    from quintet.components.sph_solid.partner_faces import PartnerFaces


def kick_by_faces(
    faces: "PartnerFaces", rows: DeviceState, state: State, is_read: bool, dt: float
) -> None:
    """Change velocities by contact in a step of dt [s], with its forces at the begin.

    `state` is that of the host; `is_read` tells whether it has places and velocities of the device.
    """
    if not is_read:
        state.position = rows.arrays["position"].get()
        state.velocity = rows.arrays["velocity"].get()
    faces.kick(state, dt)
    if faces.penalty.near is not None and len(faces.penalty.near.row):
        rows.arrays["velocity"].put(state.velocity)
