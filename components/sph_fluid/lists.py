"""When the neighbour lists are made anew, how far they reach, and what is still in the domain."""

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.search.verlet_list import VerletSkin, longest
from quintet.components.shared.smoothing.cubic_spline import SUPPORT
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.state import Array, State, Whole

# Of the kernel's support, how much further the neighbour lists reach: longer steps want more.
SKIN = {"extrapolated": 0.1, "symplectic": 0.2}
STRAY = 0.5  # of the tank's longest edge: how far outside of it a particle is lost


def skin(params: SphFluidParams) -> VerletSkin:
    """How far pairs act, and how much further the lists reach."""
    return VerletSkin(SUPPORT * params.smoothing_length, SKIN[params.integration])


def are_old(state: State, rows: Whole, params: SphFluidParams, dt: float) -> bool:
    """Whether pairs may meet in a step of dt [s] that the lists lack; `rows` are the samples'."""
    if len(state.reference) == 0:
        return True
    shifted = 0.0
    if len(rows):
        shifted = longest(state.place.take(rows, 0)[:, :3] - state.reference.take(rows, 0))
        if params.mirrored:
            here = rows - state.fluid
            before = state.reference[state.particles :]
            shifted = max(shifted, longest(state.mirror.take(here, 0) - before.take(here, 0)))
    coming = 0.0
    if params.integration == "symplectic":
        # Pairs meet in the middle of the step too: each of the two goes there at its speed.
        coming = dt * longest(state.motion[: state.fluid])
    return skin(params).is_outworn(state.moved, shifted, coming)


def query_points(state: State, rows: Whole, params: SphFluidParams) -> tuple[Array | None, Whole]:
    """Places (m, 3) m from which the boundary looks for fluid, and where the samples' lists stand.

    None: all of it from where it is. Mirrored walls look from their mirror points; samples, which
    the fluid pushes, from where they are as well. Under a contact potential these alone look.
    """
    points = state.reference[: state.particles]
    if params.mirrored:
        here = np.concatenate([state.reference[len(points) :], points[rows]])
        return here, len(points) + np.arange(len(rows))
    if params.boundary.method == "potential":
        return points[rows], state.fluid + np.arange(len(rows))
    return None, rows


def inside(points: Array, params: SphFluidParams) -> NDArray[np.bool_]:
    """Which points (n, 3 or more) m are in the tank or not far outside of it."""
    found = np.ones(len(points), bool)
    if params.boundary.walls is not None:
        low, high = np.array(params.boundary.walls)
        stray = STRAY * float((high - low).max())
        for axis in range(3):
            one = points[:, axis]
            found &= (one > low[axis] - stray) & (one < high[axis] + stray)
    return found
