"""The gas around bodies that move from the start on."""

import numpy as np

from quintet.components.meshless_gas.kernels.motion import write_conservative
from quintet.components.meshless_gas.moving.layout import Pose
from quintet.components.meshless_gas.state import State
from quintet.interfaces.component import Array


def soft_start(state: State, positions: Array, radii: Array, pose: Pose, gamma: float) -> None:
    """Start gas near a body with the body's velocity, which fades over one radius.

    Parameters
    ----------
    state : State
        Written.
    positions : (n, 3) m
        Of nodes.
    radii : (b,) m
    pose : Pose
    gamma : float, 1
    """
    for radius, centre, velocity in zip(radii, pose.centre, pose.velocity, strict=True):
        away = np.sqrt(((positions - centre) ** 2).sum(axis=1)) / radius - 1.0
        share = 1.0 - np.clip(away, 0.0, 1.0)[:, None]
        state.primitive[:, 1:4] += share * (velocity - state.primitive[:, 1:4])
    write_conservative(state.primitive, gamma, state.conservative)
