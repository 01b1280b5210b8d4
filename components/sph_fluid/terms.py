"""The numbers of all laws that act between pairs, in the precision that pairs are computed in."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.search.neighbours import Lists
from quintet.components.shared.threads import Team
from quintet.components.sph_fluid.laws import (
    Contact,
    Diffusion,
    Fluid,
    Friction,
    Guard,
    constants,
    diffusion,
    guard,
)
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.state import Array, State, Whole

if TYPE_CHECKING:
    from quintet.components.sph_fluid.contact import Hold

EVEN = 1e-9  # of a particle's volume: what differs from it by less is as large


@dataclass(frozen=True, slots=True)
class Terms:
    """None is what a scene leaves out."""

    fluid: Fluid
    diffusion: Diffusion | None
    guard: Guard | None
    contact: Contact | None
    courant: float  # 1, greatest step over the time that sound takes through h
    hold: "Hold | None" = None

    @property
    def some(self) -> NDArray[np.floating] | None:
        """Whether the contact potential holds a row, of all rows; None: it holds all, or none."""
        return None if self.contact is None else self.contact.some


def terms(params: SphFluidParams, held: bool) -> Terms:
    """Numbers of the laws that a scene asks for; `held`: of the contact potential too."""
    touch, strength = None, None
    if held:
        from quintet.components.sph_fluid.contact import Hold, contact

        touch, strength = contact(params), Hold(params)
    laws = (constants(params), diffusion(params), guard(params), touch)
    courant = params.courant
    if params.acoustic_damper > 0.0:
        from quintet.components.sph_fluid.damper import limit

        courant = min(courant, limit(params.acoustic_damper))
    if params.precision == "float32":
        from quintet.components.sph_fluid.single import rounded_law

        laws = tuple(map(rounded_law, laws))
    return Terms(*laws, courant, strength)


def mark(laws: Terms, rows: Whole, count: int, params: SphFluidParams) -> Terms:
    """Let the contact potential be that of some rows alone, of `count`."""
    assert laws.contact is not None
    some = np.zeros(count, params.precision)
    some[rows] = 1.0
    return replace(laws, contact=laws.contact._replace(some=some))


def friction(
    params: SphFluidParams, state: State, near: Lists, fluid: Fluid, team: Team
) -> Friction | None:
    """Viscosity of the fluid itself, and the velocities that it sees in mirrored walls."""
    if params.viscosity.kinematic == 0.0:
        return None
    seen = state.motion
    if params.mirrored and params.boundary.wall_viscosity_factor > 0.0:
        from quintet.components.sph_fluid.mdbc import reflect

        seen = seen.copy()
        arrays = (state.mirror, state.place, state.motion, near, fluid)
        team.run(reflect, len(state.mirror), state.fluid, *arrays, seen)
    if params.viscosity.form == "stress":
        return Friction(True, 4.0 * (params.dimensions + 2) * params.viscosity.kinematic, seen)
    return Friction(None, 4.0 * params.viscosity.kinematic, seen)


def damped(
    state: State, near: Lists, params: SphFluidParams, team: Team, mirror: Callable[[], None]
) -> Array | None:
    """Let the damper press, if there is one; return where its next part is to be written."""
    if params.acoustic_damper == 0.0:
        return None
    from quintet.components.sph_fluid.damper import damp, damp_walls

    damp(state, params, team)
    mirror()
    if params.mirrored:
        damp_walls(state, near, params, team)
        mirror()
    return state.squeeze


def bulk(volume: Array, rows: Whole, count: int, params: SphFluidParams) -> Array | None:
    """Volume of each of `count` rows over a particle's, (samples,) m3 of these; None: all alike.

    Where the spacing does not divide a body, its samples stand closer, or less close, than the
    fluid's particles; as heavy as those they would displace more, or less, than the body does.
    """
    share = volume / params.spacing**params.dimensions
    if np.abs(share - 1.0).max(initial=0.0) < EVEN:
        return None
    found = np.ones(count, params.precision)
    found[rows] = share
    return found
