"""Impacts of spheres: with walls, and, if spheres collide, among themselves."""

from quintet.components.particle_dynamics.spheres.build import (
    planes,
    refuse_behind_walls,
    refuse_overlaps,
)
from quintet.components.particle_dynamics.spheres.kernels import (
    bounce,
    bounce_from_walls,
    deepest_overlap,
)
from quintet.components.particle_dynamics.spheres.params import ParticleSpheresParams
from quintet.components.particle_dynamics.spheres.state import LOST, Spheres, State
from quintet.components.shared.search.sphere_pairs import NearPairs
from quintet.components.shared.search.verlet_list import longest
from quintet.interfaces.component import Array

SWEEPS = 100  # over all pairs, in which an impulse runs through a row: each in turn


class Impacts:
    """Impacts of spheres with walls and with each other.

    Parameters
    ----------
    spheres : Spheres
    planes : (w, 4) float array, 1 and m
        Unit normals and offsets of walls.
    restitution : float
    collide : bool
        Whether spheres strike each other.
    """

    def __init__(self, spheres: Spheres, planes: Array, restitution: float, collide: bool) -> None:
        self.spheres, self.planes, self.restitution = spheres, planes, restitution
        self.near = NearPairs(spheres.radius) if collide else None

    @property
    def collide(self) -> bool:
        """Whether spheres strike each other."""
        return self.near is not None

    def closing_speed(self, rates: Array) -> float:
        """Greatest rate at which two spheres, or one and a wall, may approach each other.

        Parameters
        ----------
        rates : (n, 3) float array
            Velocities m/s, or accelerations m/s2.
        """
        fastest = 0.0
        if self.near is not None:
            fastest = 2.0 * longest(rates - rates.mean(axis=0))
        if len(self.planes):
            fastest = max(fastest, float((-(rates @ self.planes[:, :3].T)).max()))
        return fastest

    def overlap(self, position: Array) -> float:
        """Largest overlap of two spheres, or of one and a wall, over the (smaller) diameter."""
        overlap, radius = 0.0, self.spheres.radius
        if len(self.planes):
            height = position @ self.planes[:, :3].T - self.planes[:, 3]  # (n, w) m
            overlap = max(0.0, float((0.5 - height / (2.0 * radius[:, None])).max()))
        if self.near is None:
            return overlap
        return max(overlap, deepest_overlap(position, radius, *self.near.at(position)))

    def resolve(self, dt: float, state: State, acceleration: Array) -> None:
        """Let spheres bounce until none that overlap approach each other.

        Parameters
        ----------
        dt : float, s
            Length of the step that has just ended.
        state : State
            Changed.
        acceleration : (n, 3) float array, m/s2
            In flight.
        """
        spheres = self.spheres
        arguments = (dt, state.position, state.velocity, acceleration, spheres.radius, spheres.mass,
                     state.launched)  # fmt: skip
        for sweep in range(SWEEPS):
            impacts = 0
            if len(self.planes):
                lost, impacts = bounce_from_walls(*arguments, self.planes, self.restitution)
                state.sums[LOST] += lost
            if self.near is not None:
                pairs, backwards = self.near.at(state.position), sweep % 2 == 1
                lost, more = bounce(*arguments, *pairs, backwards, self.restitution)
                state.sums[LOST] += lost
                impacts += more
            if impacts == 0:
                return


def impacts(params: ParticleSpheresParams, spheres: Spheres) -> Impacts | None:
    """Make the impacts that a scene has; None if nothing can touch."""
    walls, collide = planes(params.walls), params.collisions and len(spheres.mass) > 1
    refuse_behind_walls(spheres.start, spheres.radius, walls)
    if not (collide or len(walls)):
        return None
    impacts = Impacts(spheres, walls, params.restitution, collide)
    if impacts.near is not None:
        near = impacts.near.at(spheres.start)
        refuse_overlaps(spheres.start, spheres.radius, near)
    return impacts
