"""A step in passes, each shared out among threads; compiled only where that is wanted.

The loops are those of kernels.advance and resolve, which do all of a step in one call. No result
differs by a bit: the blocks of rows, over which sums are rounded, are the same.
"""

from numba import njit

from quintet.components.dem_bodies import ball_kernels, kernels, tallies
from quintet.components.dem_bodies.state import Balls, Contacts, Model, Numbers, State
from quintet.components.shared.rotations import PURE


@njit(**PURE)
def drift(
    first: int, last: int, model: Model, state: State, tally: Numbers, dt: float, loaded: bool
) -> None:
    """Move the bodies of the blocks [first, last)."""
    kernels.drift(first, last, model, state, tally, dt, loaded)


@njit(**PURE)
def furthest(state: State, tally: Numbers) -> float:
    """Report and return the square of the longest way [m²] since pairs were listed."""
    return float(tallies.furthest(state, tally))


@njit(**PURE)
def press_balls(
    first: int, last: int, model: Model, state: State, balls: Balls, tally: Numbers, dt: float
) -> None:
    """Press the pairs of balls of the blocks [first, last)."""
    ball_kernels.press_balls(first, last, model, state, balls, tally, dt)


@njit(**PURE)
def press_others(
    model: Model, state: State, balls: Balls, contacts: Contacts, tally: Numbers, dt: float
) -> None:
    """Press all other pairs."""
    kernels.press_others(model, state, balls, contacts, tally, dt)


@njit(**PURE)
def finish(
    first: int, last: int, model: Model, state: State, balls: Balls, tally: Numbers, dt: float,
    loaded: bool,
) -> None:  # fmt: skip
    """Half kick of the rows of the blocks [first, last)."""
    kernels.finish(first, last, model, state, balls, tally, dt, loaded)


@njit(**PURE)
def close(state: State, tally: Numbers) -> None:
    """Report on the whole step."""
    tallies.close(state, tally)
