"""Impacts of spheres that are shared out among several ranks."""

import numpy as np

from quintet.components.particle_dynamics.spheres.kernels import (
    deepest_in_walls,
    deepest_overlap,
    mark_impacts,
)
from quintet.components.particle_dynamics.spheres.ranks.closing import closing_speed
from quintet.components.particle_dynamics.spheres.ranks.clusters import (
    Cluster,
    ListedPairs,
    Marks,
    gather,
)
from quintet.components.particle_dynamics.spheres.ranks.lists import Lists
from quintet.components.particle_dynamics.spheres.ranks.several import SeveralRanks
from quintet.components.particle_dynamics.spheres.sweeps import Moving, sweep
from quintet.components.shared.domain.extremes import counted
from quintet.components.shared.search.sphere_pairs import NearPairs
from quintet.interfaces.component import Array

CROWDED = 0.05  # of the spheres of a rank, by which its copies may grow before space is cut again


class SharedImpacts:
    """Impacts of spheres with walls and with each other; all ranks call every method alike.

    Parameters
    ----------
    ranks : SeveralRanks
    planes : (w, 4) float array, 1 and m
        Unit normals and offsets of walls.
    restitution : float
    largest : float or None
        Radius [m] of the largest sphere; None if spheres do not strike each other.
    """

    def __init__(
        self, ranks: SeveralRanks, planes: Array, restitution: float, largest: float | None
    ) -> None:
        self._ranks, self._planes, self._restitution = ranks, planes, restitution
        self.collide = largest is not None  # whether spheres strike each other
        self._lists = Lists(ranks, largest or 0.0)
        self._copies = 0  # of all ranks, when lists were made after space was cut

    def share_out(self) -> None:
        """Cut space again where the copies of ranks have become many more."""
        ranks, lists = self._ranks, self._lists
        if not lists.were_made:
            return
        lists.were_made = False
        copies = int(counted(ranks.communicator, np.array([lists.copies]))[0])
        self._copies = self._copies or copies
        if copies > self._copies + CROWDED * ranks.count:
            ranks.share_out()
            lists.forget()
            self._copies = 0

    def closing_speed(self, rates: Array) -> float:
        """Greatest rate of approach, of velocities m/s or accelerations m/s2 (n, 3)."""
        return closing_speed(self._ranks, rates, self._planes, self.collide)

    def overlap(self, position: Array) -> float:
        """Largest overlap of two spheres, or of one and a wall, over the (smaller) diameter."""
        ranks, lists = self._ranks, self._lists
        radius, deepest = ranks.spheres.radius, 0.0
        if len(self._planes):
            deepest = deepest_in_walls(position, radius, self._planes)
        if self.collide:
            lists.update(position)
            points = lists.with_copies(position)
            deepest = max(deepest, deepest_overlap(points, lists.radius, *lists.pairs))
        return ranks.greatest(deepest)

    def resolve(self, dt: float, acceleration: Array) -> None:
        """Let spheres bounce until none that overlap approach each other.

        Parameters
        ----------
        dt : float, s
            Length of the step that has just ended.
        acceleration : (n, 3) float array, m/s2
            In flight.
        """
        ranks, lists = self._ranks, self._lists
        if self.collide:
            lists.update(ranks.state.position)
        moving = lists.moving(acceleration)
        marks = np.zeros(len(moving.mass), bool)
        position, velocity, _, *rest = moving
        impacts = mark_impacts(position, velocity, *rest, self._planes, *lists.pairs, marks)
        if not counted(ranks.communicator, np.array([impacts]))[0]:
            return
        cluster = self._carry_out(dt, moving, marks)
        if cluster is not None:
            self._write(cluster)
        elif lists.moved > 0.0:
            lists.make(ranks.state.position)
            self.resolve(dt, acceleration)
        else:
            self._write(self._carry_out_all(dt, moving))

    def _carry_out(self, dt: float, moving: Moving, marks: Marks) -> Cluster | None:
        """Spheres after all impacts; None if lists do not hold until then.

        A sphere that was not marked and yet changes may be near others that are not gathered: it is
        marked, and all is done again.
        """
        near = None
        while True:
            cluster = self._gather(moving, marks)
            position, velocity = cluster.moving.position.copy(), cluster.moving.velocity.copy()
            sums = self._ranks.state.sums.copy()
            if self.collide:
                near = ListedPairs(cluster, self._lists.skin, self._lists.moved)
            sweep(dt, cluster.moving, self._planes, near, self._restitution, sums)
            if near is not None and not near.hold:
                return None
            changed = (cluster.moving.position != position) | (cluster.moving.velocity != velocity)
            grown = cluster.ids[changed.any(axis=1) & ~cluster.marked]
            if not len(grown):
                self._ranks.state.sums[:] = sums
                return cluster
            marks |= np.isin(self._lists.ids, grown)

    def _carry_out_all(self, dt: float, moving: Moving) -> Cluster:
        """All spheres of all ranks after all impacts."""
        cluster = self._gather(moving, np.ones(len(moving.mass), bool))
        near, sums = NearPairs(cluster.moving.radius), self._ranks.state.sums
        sweep(dt, cluster.moving, self._planes, near, self._restitution, sums)
        return cluster

    def _gather(self, moving: Moving, marks: Marks) -> Cluster:
        ranks, lists = self._ranks, self._lists
        return gather(ranks.communicator, lists.ids, moving, lists.pairs, marks, ranks.count)

    def _write(self, cluster: Cluster) -> None:
        """Take over what has become of the spheres of this rank."""
        ranks = self._ranks
        row = np.minimum(np.searchsorted(ranks.ids, cluster.ids), len(ranks.ids) - 1)
        here = ranks.ids[row] == cluster.ids
        ranks.state.position[row[here]] = cluster.moving.position[here]
        ranks.state.velocity[row[here]] = cluster.moving.velocity[here]
