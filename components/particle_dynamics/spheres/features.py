"""Impacts of spheres: with walls, and, if spheres collide, among themselves."""

from typing import TYPE_CHECKING

import numpy as np

from quintet.components.particle_dynamics.spheres.build import (
    initial_state,
    planes,
    refuse_behind_walls,
    refuse_overlaps,
)
from quintet.components.particle_dynamics.spheres.kernels import (
    deepest_in_walls,
    deepest_overlap,
)
from quintet.components.particle_dynamics.spheres.params import ParticleSpheresParams
from quintet.components.particle_dynamics.spheres.ranks.closing import closing_speed
from quintet.components.particle_dynamics.spheres.ranks.method import Ranks
from quintet.components.particle_dynamics.spheres.ranks.one import OneRank
from quintet.components.particle_dynamics.spheres.state import Spheres
from quintet.components.particle_dynamics.spheres.sweeps import Moving, sweep
from quintet.components.shared.search.sphere_pairs import NearPairs
from quintet.interfaces.component import Array, Resources
from quintet.interfaces.errors import SceneError

if TYPE_CHECKING:
    from quintet.components.particle_dynamics.spheres.ranks.impacts import SharedImpacts


class Impacts:
    """Impacts of spheres with walls and with each other, all on one rank.

    Parameters
    ----------
    ranks : OneRank
    planes : (w, 4) float array, 1 and m
        Unit normals and offsets of walls.
    restitution : float
    near : NearPairs or None
        Pairs of spheres; None if they do not strike each other.
    """

    def __init__(
        self, ranks: OneRank, planes: Array, restitution: float, near: NearPairs | None
    ) -> None:
        self._ranks, self._planes = ranks, planes
        self._restitution, self._near = restitution, near
        self.collide = near is not None  # whether spheres strike each other

    def share_out(self) -> None:
        """Do nothing: one rank has all."""

    def closing_speed(self, rates: Array) -> float:
        """Greatest rate of approach, of velocities m/s or accelerations m/s2 (n, 3)."""
        return closing_speed(self._ranks, rates, self._planes, self.collide)

    def overlap(self, position: Array) -> float:
        """Largest overlap of two spheres, or of one and a wall, over the (smaller) diameter."""
        radius = self._ranks.spheres.radius
        overlap = deepest_in_walls(position, radius, self._planes) if len(self._planes) else 0.0
        if self._near is None:
            return overlap
        return max(overlap, deepest_overlap(position, radius, *self._near.at(position)))

    def resolve(self, dt: float, acceleration: Array) -> None:
        """Let spheres bounce until none that overlap approach each other.

        Parameters
        ----------
        dt : float, s
            Length of the step that has just ended.
        acceleration : (n, 3) float array, m/s2
            In flight.
        """
        spheres, state = self._ranks.spheres, self._ranks.state
        moving = Moving(
            state.position, state.velocity, acceleration, spheres.radius, spheres.mass,
            state.launched,
        )  # fmt: skip
        sweep(dt, moving, self._planes, self._near, self._restitution, state.sums)


def spheres_of(
    resources: Resources, params: ParticleSpheresParams, spheres: Spheres
) -> "tuple[Ranks, Impacts | SharedImpacts | None]":
    """Make the ranks of all spheres, and the impacts that a scene has; None if nothing can touch.

    Parameters
    ----------
    resources : Resources
    params : ParticleSpheresParams
    spheres : Spheres
        All, on every rank.
    """
    walls, collide = planes(params.walls), params.collisions and len(spheres.mass) > 1
    refuse_behind_walls(spheres.start, spheres.radius, walls)
    near = NearPairs(spheres.radius) if collide else None
    if near is not None:
        refuse_overlaps(spheres.start, spheres.radius, near.at(spheres.start))
    can_touch, state = collide or len(walls) > 0, initial_state(spheres)
    communicator = resources.communicator
    if communicator is None or communicator.size == 1:
        one_rank = OneRank(spheres, state)
        impacts = Impacts(one_rank, walls, params.restitution, near)
        return one_rank, impacts if can_touch else None
    if communicator.size > len(spheres.mass):
        raise SceneError(
            f"ranks: each must own a sphere; there are {len(spheres.mass)} for "
            f"{communicator.size} ranks. Take at most {len(spheres.mass)}."
        )
    # Only spheres of several ranks load mpi4py.
    from quintet.components.particle_dynamics.spheres.ranks.impacts import SharedImpacts
    from quintet.components.particle_dynamics.spheres.ranks.several import SeveralRanks

    width = None if near is None else near.width
    ranks = SeveralRanks(communicator, spheres, state, width)
    largest = float(np.max(spheres.radius))
    shared = SharedImpacts(ranks, walls, params.restitution, largest if collide else None)
    return ranks, shared if can_touch else None
