"""Velocities of a scene that point where nothing can go: out of the plane, or through a wall."""

from collections.abc import Mapping

from quintet.components.meshless_gas.boundaries import Boundary, GasState
from quintet.interfaces.params import Vector


def off_plane(
    starts: Mapping[str, GasState | None], boundaries: Mapping[str, Boundary]
) -> list[str]:
    """Which velocities leave the plane of a gas in two dimensions.

    Parameters
    ----------
    starts
        States at the start by their keys.
    boundaries
    """
    vectors: dict[str, Vector | None] = {
        f"{key}.velocity": state.velocity for key, state in starts.items() if state is not None
    }
    for name, boundary in boundaries.items():
        key = f"boundaries.{name}"
        vectors[f"{key}.velocity"] = boundary.velocity
        if boundary.state is not None:
            vectors[f"{key}.state.velocity"] = boundary.state.velocity
        if boundary.total is not None:
            vectors[f"{key}.total.direction"] = boundary.total.direction
    return [
        f"{key}: in two dimensions gas and walls move along x and z; found {list(vector)}. Set y "
        "to 0."
        for key, vector in vectors.items()
        if vector is not None and vector[1] != 0.0
    ]


def through_walls(boundaries: Mapping[str, Boundary], across: Mapping[str, str]) -> list[str]:
    """Which walls have a velocity that is not along them.

    Parameters
    ----------
    boundaries
    across
        Axes across which boundaries lie, by their names: "z", or "xyz" of a curved one.
    """
    mistakes = []
    for name, boundary in boundaries.items():
        velocity, axes = boundary.velocity, across.get(name, "")
        if velocity is not None and any(velocity["xyz".index(axis)] for axis in axes):
            still = " and ".join(axes)
            mistakes.append(
                f"boundaries.{name}: the velocity of a wall must be along it; found "
                f"{list(velocity)} m/s. Set {still} to 0."
            )
    return mistakes
