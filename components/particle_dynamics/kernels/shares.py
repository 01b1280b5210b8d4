"""Parts of a step between which ranks exchange their points."""

from typing import Any

from numba import njit

from quintet.components.particle_dynamics.kernels.forces import Pairs
from quintet.components.particle_dynamics.kernels.motion import (
    accelerate,
    constrain,
    open_stage,
    place,
)
from quintet.components.particle_dynamics.state import TIME, Model, State, Whole
from quintet.components.shared.numba_options import EXACT
from quintet.interfaces.component import Array


@njit(**EXACT)
def depart(
    h: float, boltzmann: float, model: Model, state: State, predicted: Array, is_damped: bool
) -> None:
    """Make a stage up to its forces; without collisions."""
    open_stage(h, boltzmann, model, state)
    place(h, model, state, predicted, is_damped)


@njit(**EXACT)
def hold_pair(model: Model, state: State) -> None:
    """Set the driven pair as it is at the start."""
    if model.driven.first >= 0:
        constrain(model.driven, state.energies[TIME], state.position, state.velocity)


@njit(**EXACT)
def accelerate_now(
    model: Model, state: State, velocity: Array, pairs: Pairs, law: Any, damping: Any, period: Any
) -> None:
    """Compute the accelerations at the start."""
    accelerate(state.energies[TIME], model, state, velocity, pairs, law, damping, period)


@njit(**EXACT)
def measure(dt: float, mass: float, owned: Whole, state: State) -> tuple[float, float]:
    """Average the kinetic energies of some rows as `motion.average` does.

    Returns
    -------
    squares : float, m2/s2
        Sum of squared speeds.
    moved : float, m2
        Largest square of a distance from where a point was listed.
    """
    velocity, position, listed = state.velocity, state.position, state.listed
    squares, moved = 0.0, 0.0
    for m in range(owned.shape[0]):
        i, square = owned[m], 0.0
        for k in range(3):
            square += velocity[i, k] * velocity[i, k]
        state.kinetic[i] += dt * 0.5 * mass * square
        squares += square
        x, y = position[i, 0] - listed[i, 0], position[i, 1] - listed[i, 1]
        z = position[i, 2] - listed[i, 2]
        moved = max(moved, x * x + y * y + z * z)
    return squares, moved
