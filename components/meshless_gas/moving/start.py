"""The gas around bodies that move from the start on."""

from typing import TYPE_CHECKING

import numpy as np

from quintet.components.meshless_gas.kernels.motion import write_conservative
from quintet.components.meshless_gas.state import State, conserved

if TYPE_CHECKING:
    from quintet.components.meshless_gas.moving.clouds import MovingClouds


def soft_start(moving: "MovingClouds", state: State) -> None:
    """Let gas near a body begin with the body's velocity, which fades over one radius."""
    positions = moving.domain.cloud.positions[: len(state.primitive)]
    for radius, centre, velocity in zip(
        moving.layout.radii, moving.pose.centre, moving.pose.velocity, strict=True
    ):
        away = np.sqrt(((positions - centre) ** 2).sum(axis=1)) / radius - 1.0
        share = 1.0 - np.clip(away, 0.0, 1.0)[:, None]
        state.primitive[:, 1:4] += share * (velocity - state.primitive[:, 1:4])
    write_conservative(state.primitive, moving.gamma, state.conservative)
    state.begun[:] = conserved(state.conservative, moving.domain.cloud.volumes, moving.team)
