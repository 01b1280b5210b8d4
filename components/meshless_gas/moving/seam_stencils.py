"""Stencils across the seams of clouds."""

import numpy as np
from numpy.typing import NDArray

from quintet.components.meshless_gas.clouds.cloud import Cloud
from quintet.components.meshless_gas.moving.layout import CloudLayout
from quintet.components.meshless_gas.moving.refusals import too_few
from quintet.components.meshless_gas.moving.seams import around, choose
from quintet.components.meshless_gas.stencils import SOUND, Stencils, write_coefficients
from quintet.components.shared.threads import Team
from quintet.interfaces.component import Array
from quintet.interfaces.errors import StepError

Rows = NDArray[np.int64]
Flags = NDArray[np.bool_]
BAND = 3.0  # spacings about a seam within which neighbours are found anew
NEAR = 4  # times as many nodes are looked at as a node has neighbours


class Seams:
    """Which nodes have neighbours in other clouds, and where bodies were when they were fitted."""

    def __init__(self, layout: CloudLayout, cloud: Cloud, made: Stencils, team: Team) -> None:
        self.layout, self.cloud, self.stencils, self.team = layout, cloud, made, team
        self.fitted = np.zeros((len(layout.radii), 3))  # m, centres when coefficients were written
        self.touched = np.zeros(0, np.int64)  # nodes whose neighbours are not those of their cloud
        self.across = np.zeros(0, np.int64)  # of these, those that reach over a seam
        self.quality = np.ones(len(cloud.positions))
        self.least = np.zeros(len(cloud.positions))  # weight of least squares across seams

    def join(self, active: Flags, centre: Array) -> None:
        """Find neighbours across seams, and coefficients of all nodes that they changed for."""
        cloud, own, neighbours = self.cloud, self.layout, self.stencils.neighbours
        count = cloud.nodes
        region = cloud.region[:count]
        band = np.zeros(count, bool)
        near_any = np.zeros(count, bool)
        for b, one in enumerate(own.heights_of(cloud.positions[:count], centre)):
            reach = BAND * own.spacing[b]
            mine = region == b + 1
            band |= ~mine & (one < own.thickness[b] + reach)
            band |= mine & (one > own.thickness[b] - reach)
            near_any |= ~mine & (one < own.thickness[b] + 2.0 * reach) | mine
        band &= active[:count] & (own.height > 0.0)
        if not own.planar:
            band[own.leaving] = False  # they have the state of the node beside them
        rows = np.flatnonzero(band)
        before = self.touched
        neighbours[before] = own.home[before]
        images = near_any[cloud.owner] & active[cloud.owner]
        among = np.flatnonzero(np.concatenate([near_any & active[:count], images]))
        found = around(rows, among, cloud, NEAR * own.kept, own.planar, self.team)
        lacks = choose(
            rows, found, cloud.positions, cloud.spacing, centre, own.radii, own.kept,
            4 if own.planar else 6, neighbours,
        )  # fmt: skip
        if lacks >= 0:
            raise StepError(too_few(own.kept, cloud.positions[lacks]))
        other = (cloud.region[neighbours[rows]] != region[rows][:, None]).any(axis=1)
        whole = active[own.home[rows]].all(axis=1)
        back = rows[whole & ~other]
        neighbours[back] = own.home[back]
        self.touched, self.across = rows[~(whole & ~other)], rows[other]
        self.fit(np.union1d(before, self.touched))
        self.fitted[:] = centre

    def fit(self, rows: Rows) -> None:
        """Write the coefficients of nodes."""
        cloud, made = self.cloud, self.stencils
        weight = cloud.weight
        if len(self.across):
            weight = weight.copy()
            weight[self.across] = self.least[self.across]
        self.team.run(
            write_coefficients, len(rows), rows, cloud.positions, made.neighbours, weight,
            self.layout.planar, made.coefficients, self.quality,
        )  # fmt: skip
        bad = rows[self.quality[rows] < SOUND]
        if len(bad):
            raise StepError(too_few(self.layout.kept, cloud.positions[bad[0]]))

    def refit(self, centre: Array) -> None:
        """Write the coefficients of what reaches over seams of clouds that have moved."""
        moved = np.append(False, (centre != self.fitted).any(axis=1))  # of each region
        if len(self.across) and moved.any():
            region, near = self.cloud.region, self.stencils.neighbours[self.across]
            mixed = moved[region[self.across]] | moved[region[near]].any(axis=1)
            self.fit(self.across[mixed])
        self.fitted[:] = centre
