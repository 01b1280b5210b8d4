"""Stencils across the overlaps of clouds."""

import numpy as np
from numpy.typing import NDArray

from quintet.components.meshless_gas.build import Domain
from quintet.components.meshless_gas.clouds.cloud import INNER as INNER_NODE
from quintet.components.meshless_gas.clouds.cloud import (
    NO_SLIP_KINDS,
    Cloud,
)
from quintet.components.meshless_gas.kernels.boundaries import write_weights
from quintet.components.meshless_gas.kernels.stencils import write_coefficients
from quintet.components.meshless_gas.moving.kernels.fringe import choose
from quintet.components.meshless_gas.moving.layout import CloudLayout
from quintet.components.meshless_gas.moving.refusals import too_few
from quintet.components.meshless_gas.stencils import SOUND
from quintet.components.shared.search.nearest import nearest
from quintet.components.shared.threads import Team
from quintet.interfaces.component import Array
from quintet.interfaces.errors import StepError

Rows = NDArray[np.int64]
Flags = NDArray[np.bool_]
BAND = 3.0  # spacings about an overlap within which neighbours are found again
NEAR = 4  # times as many nodes are looked at as a node has neighbours


class FringeStencils:
    """Which nodes have neighbours in other clouds, and where bodies were when they were fitted."""

    def __init__(self, layout: CloudLayout, domain: Domain, team: Team) -> None:
        cloud = domain.cloud
        self.layout, self.cloud, self.stencils, self.team = layout, cloud, domain.stencils, team
        self.fitted = np.zeros((len(layout.radii), 3))  # m, centres when coefficients were written
        self.touched = np.zeros(0, np.int64)  # nodes whose neighbours are not those of their cloud
        self.across = np.zeros(0, np.int64)  # of these, those that reach over an overlap
        self.written = np.zeros(0, np.int64)  # nodes whose coefficients were written last
        self.no_slip = np.isin(cloud.kind[: cloud.nodes], NO_SLIP_KINDS)
        self.edges, self.weights = domain.edges, domain.weights  # of boundary nodes of the box
        self.place = np.full(len(cloud.positions), -1)  # of nodes among these
        self.place[domain.edges] = np.arange(len(domain.edges))
        self.quality = np.ones(len(cloud.positions))
        self.least = np.zeros(len(cloud.positions))  # weight of least squares across overlaps

    def join(self, active: Flags, centre: Array) -> None:
        """Find neighbours across overlaps, and coefficients of all nodes that they changed for."""
        cloud, layout, neighbours = self.cloud, self.layout, self.stencils.neighbours
        region = cloud.region[: cloud.nodes]
        band, near_any = self._beside_seams(active, centre)
        self._refuse_walls(band & self.no_slip, active)
        rows = np.flatnonzero(band & ~self.no_slip)
        before = self.touched
        neighbours[before] = layout.home[before]
        images = near_any[cloud.owner] & active[cloud.owner]
        among = np.flatnonzero(np.concatenate([near_any & active[: cloud.nodes], images]))
        near = around(rows, among, cloud, NEAR * layout.fringe_count, layout.planar, self.team)
        lacks = choose(
            rows, near, cloud.positions, cloud.spacing, centre, layout.radii, layout.fringe_count,
            4 if layout.planar else 6, neighbours,
        )  # fmt: skip
        if lacks >= 0:
            raise StepError(
                too_few(layout.fringe_count, cloud.positions[lacks]), cloud.positions[lacks]
            )
        other = (cloud.region[neighbours[rows]] != region[rows][:, None]).any(axis=1)
        whole = active[layout.home[rows]].all(axis=1)
        back = rows[whole & ~other]
        neighbours[back] = layout.home[back]
        self.touched, self.across = rows[~(whole & ~other)], rows[other]
        self.fit(np.union1d(before, self.touched))
        self.fitted[:] = centre

    def _beside_seams(self, active: Flags, centre: Array) -> tuple[Flags, Flags]:
        """Nodes (n,) whose neighbours may lie across an overlap, and nodes that these may be."""
        cloud, layout, count = self.cloud, self.layout, self.cloud.nodes
        band, near_any = np.zeros(count, bool), np.zeros(count, bool)
        for b, heights in enumerate(layout.heights_of(cloud.positions[:count], centre)):
            reach = BAND * layout.spacing[b]
            mine = cloud.region[:count] == b + 1
            band |= ~mine & (heights < layout.thickness[b] + reach)
            band |= mine & (heights > layout.thickness[b] - reach)
            near_any |= ~mine & (heights < layout.thickness[b] + 2.0 * reach) | mine
        band &= active[:count] & (layout.height > 0.0)
        # Of a box that is coarser than the cloud some reach farther.
        far = np.flatnonzero(active[:count] & ~band & ~active[layout.home].all(axis=1))
        band[far[layout.height[far] > 0.0]] = True
        reached = layout.home[far]
        near_any[reached[reached < count]] = True
        if not layout.planar:
            band[layout.leaving] = False  # they have the state of the node beside them
        return band, near_any

    def _refuse_walls(self, close: Flags, active: Flags) -> None:
        """Refuse clouds that cover neighbours of walls of the box that hold the gas."""
        rows = np.flatnonzero(close)
        lacks = rows[~active[self.layout.home[rows]].all(axis=1)]
        if len(lacks):
            raise StepError(
                "clouds of bodies must leave what is beside a wall of the box free; that at "
                f"{np.array2string(self.cloud.positions[lacks[0]], precision=4)} m has neighbours "
                "that are left out. End the run before, or make the box larger or finer."
            )

    def fit(self, rows: Rows) -> None:
        """Write the coefficients of nodes."""
        cloud, stencils, self.written = self.cloud, self.stencils, rows
        weight = cloud.weight
        if len(self.across):
            weight = weight.copy()
            weight[self.across] = self.least[self.across]
        self.team.run(
            write_coefficients, len(rows), rows, cloud.positions, stencils.neighbours, weight,
            self.layout.planar, stencils.coefficients, self.quality,
        )  # fmt: skip
        bad = rows[self.quality[rows] < SOUND]
        if len(bad):
            place = cloud.positions[bad[0]]
            raise StepError(too_few(self.layout.fringe_count, place), place)
        self.weigh(rows)

    def edges_of(self, rows: Rows) -> Rows:
        """Places, among the boundary nodes, of those of some nodes that are there."""
        places = self.place[rows]
        return np.asarray(places[places >= 0])

    def weigh(self, rows: Rows) -> None:
        """Write the weights of neighbours within of those of some nodes that are at boundaries."""
        places = self.edges_of(rows)
        if not len(places):
            return
        edges, cloud = self.edges[places], self.cloud
        weights = np.empty((len(places), self.weights.shape[1]))
        lacks = write_weights(edges, cloud.kind, cloud.normals, *self.stencils, weights)
        if lacks >= 0:
            place = cloud.positions[edges[lacks]]
            raise StepError(too_few(self.layout.fringe_count, place), place)
        self.weights[places] = weights

    def refit(self, centre: Array) -> None:
        """Write the coefficients of what reaches over overlaps of clouds that have moved."""
        self.written = self.written[:0]
        moved = np.append(False, (centre != self.fitted).any(axis=1))  # of each region
        if len(self.across) and moved.any():
            region, near = self.cloud.region, self.stencils.neighbours[self.across]
            mixed = moved[region[self.across]] | moved[region[near]].any(axis=1)
            self.fit(self.across[mixed])
        self.fitted[:] = centre


def around(
    rows: NDArray[np.int64],
    among: NDArray[np.int64],
    cloud: Cloud,
    many: int,
    planar: bool,
    team: Team,
) -> NDArray[np.int64]:
    """Nodes (m, many) near to each of some, the nearest first.

    In space a node at a face of the box finds those within alone: the nearest all lie in the face,
    and span none.

    Parameters
    ----------
    rows : (m,)
        Nodes.
    among : (c,)
        Which may be found.
    cloud : Cloud
    many : int
        At most.
    planar : bool
    team : Team
        Threads.
    """
    many = min(many, len(among))
    near, _ = nearest(cloud.positions, among, cloud.positions[rows], many, team)
    face = cloud.kind[rows] != INNER_NODE
    if not planar and face.any():
        within = among[cloud.kind[among] == INNER_NODE]
        near[face], _ = nearest(cloud.positions, within, cloud.positions[rows[face]], many, team)
    return near
