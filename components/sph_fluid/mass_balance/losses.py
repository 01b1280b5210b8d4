"""Particles that leave the tank: through which face each went, and which are lost.

A particle outside of the tank is lost where it is further than `STRAY` of the tank's longest edge
from it. How it got out is noted when it is first found outside, near the face that it passed:
further away it may have fallen beside a wall that it went over.
"""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.geometry.bounds import Bounds
from quintet.components.sph_fluid.mass_balance.sums import without_buffers
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.setup.geometry import FACES
from quintet.components.sph_fluid.state import Array, State
from quintet.interfaces.errors import StepError

STRAY = 0.5  # of the tank's longest edge: how far outside of it a particle is lost


def note_exits(state: State, walls: Bounds | None) -> NDArray[np.bool_]:
    """Note through which face particles left the tank; tell which are lost, (fluid,).

    Parameters
    ----------
    state : State
        `exit_face` is written.
    walls : two corners (3,) m, or None
        Of the tank. Without one, nothing is lost.
    """
    is_lost = np.zeros(state.fluid, bool)
    if walls is None:
        return is_lost
    points, (low, high) = state.position_density[: state.fluid, :3], np.array(walls)
    is_inside = np.ones(state.fluid, bool)
    for axis in range(3):  # column by column: numpy takes far longer over all at once
        along = points[:, axis]
        is_inside &= (along >= low[axis]) & (along <= high[axis])
    outside = np.flatnonzero(~is_inside)
    beyond = np.stack([low - points[outside], points[outside] - high], axis=2).reshape(-1, 6)
    before = state.exit_face[outside]
    state.exit_face[:] = 0
    if len(outside):
        state.exit_face[outside] = np.where(before > 0, before, 1 + np.argmax(beyond, axis=1))
        # Written so that a place that is not finite is lost.
        is_lost[outside] = ~(beyond.max(axis=1) < STRAY * float((high - low).max()))
    if len(state.role):
        is_lost &= state.role == 0  # what an outflow's buffer holds has left already
    return is_lost


def lost_by_face(state: State, is_lost: NDArray[np.bool_]) -> list[int]:
    """Count lost particles by the face through which they left, in the order of `FACES`."""
    return np.bincount(state.exit_face[is_lost] - 1, minlength=len(FACES)).tolist()


def first_of(state: State, is_lost: NDArray[np.bool_]) -> Array:
    """First by birth of lost particles: identity, face, x, y, z [m], a row (1, 5); none (0, 5)."""
    rows = np.flatnonzero(is_lost)
    rows = rows[np.argsort(state.identity[rows])[:1]]
    return np.column_stack(
        [state.identity[rows], state.exit_face[rows] - 1, state.position_density[rows, :3]]
    ).astype(np.float64)


def book(state: State, by_face: Sequence[int], first: Array) -> None:
    """Add particles that are lost now to those lost so far.

    Parameters
    ----------
    by_face : six ints
        As of `lost_by_face`, of all ranks.
    first : (k, 5) float array
        As of `first_of`, of all ranks.
    """
    state.lost_through += np.array(by_face)
    if len(first) and not len(state.first_lost):
        state.first_lost = first[np.argmin(first[:, 0])]


def begin_books(state: State, count: int) -> None:
    """Count what comes and goes, and judge the fluid, from the present state on.

    Parameters
    ----------
    state : State
    count : int
        Particles on all ranks, with those of buffers.
    """
    state.at_start, _ = without_buffers(state, count, [])
    for counts in (state.passed, state.lost_through, state.crossings, state.judged):
        counts[:] = 0
    state.first_lost = np.zeros(0)
    state.returned, state.removed, state.carried = 0, 0, 0.0


def balance(state: State, params: SphFluidParams) -> dict[str, int]:
    """Numbers of particles by reason: at the start, what came, and, negative, what is gone.

    Their sum is the number of particles that there are, without those of buffers.
    """
    numbers = {"at the start": state.at_start}
    for number, name in enumerate(_passages(params)):
        sign = 1 if number < len(params.boundary.inflow) else -1
        numbers[name] = sign * int(state.passed[number])
    if state.returned:
        numbers["driven back into an inflow"] = -state.returned
    if state.removed:
        numbers["removed inside bodies"] = -state.removed
    return numbers | {reason: -count for reason, count in _lost(state, params)}


def _passages(params: SphFluidParams) -> list[str]:
    """Reasons in the mass balance, one for each buffer."""
    entered = [f"entered by the inflow {passage.face}" for passage in params.boundary.inflow]
    return entered + [f"left by the outflow {passage.face}" for passage in params.boundary.outflow]


def _lost(state: State, params: SphFluidParams) -> Iterator[tuple[str, int]]:
    """Reasons for which particles were lost, and how many."""
    for face, count in zip(FACES, state.lost_through.tolist(), strict=True):
        if count:
            yield f"lost {_way(face, params)}", count


def _way(face: str, params: SphFluidParams) -> str:
    if face in params.closed_faces:
        return f"through the wall {face}"
    return f"outside the domain, over the open face {face}"


def refuse_many_lost(state: State, params: SphFluidParams) -> None:
    """End the run where more of the fluid is lost than a scene allows.

    Raises
    ------
    StepError
        With the numbers, the reasons, and where the first was lost.
    """
    if params.lost_limit is None:
        return
    whole = state.at_start + int(state.passed[: len(params.boundary.inflow)].sum())
    if state.lost <= params.lost_limit * whole:
        return
    reasons = ", ".join(f"{count} {reason}" for reason, count in _lost(state, params))
    identity, face, *place = state.first_lost.tolist()
    x, y, z = place
    raise StepError(
        f"step {state.steps}: at most {params.lost_limit:.3g} of the fluid may be lost "
        f"(lost_limit); {state.lost} of {whole} particles are: {reasons}. The first, particle "
        f"{identity:.0f}, left the tank {_way(FACES[int(face)], params)}, and was lost at "
        f"({x:.4g}, {y:.4g}, {z:.4g}) m. Lower courant, refine the spacing, raise the walls, or "
        "raise lost_limit.",
        (x, y, z),
    )
