"""Hole cutting: nodes that bodies and their clouds cover, and what is left of a domain then."""

import numpy as np
from numpy.typing import NDArray

from quintet.components.meshless_gas.build import Domain
from quintet.components.meshless_gas.clouds.cloud import INNER, OUTFLOW, Cloud
from quintet.components.meshless_gas.kernels.outflows import Outflows, clear_of_holes
from quintet.components.meshless_gas.moving.kernels.holes import cut, part
from quintet.components.meshless_gas.moving.layout import CloudLayout, write_plane_areas
from quintet.components.meshless_gas.moving.refusals import refuse_places
from quintet.components.meshless_gas.moving.volumes import partitioned
from quintet.components.meshless_gas.moving_bodies import Moving
from quintet.components.shared.search.nearest import nearest
from quintet.components.shared.threads import Team
from quintet.interfaces.component import Array
from quintet.interfaces.errors import QuintetError, SceneError, StepError

Rows = NDArray[np.int64]
Flags = NDArray[np.bool_]


class Holes:
    """Which nodes are left out, and where bodies were when that was found last."""

    def __init__(self, params: Moving, layout: CloudLayout, cloud: Cloud, team: Team) -> None:
        self.params, self.layout, self.cloud, self.team = params, layout, cloud, team
        self.active = np.ones(len(cloud.positions), bool)
        self.seen = np.zeros((len(layout.radii), 3))  # m, centres when holes were cut last
        self.volumes = layout.volumes.copy()  # (n,) m3, those of overlaps counted once
        self.fresh_count = 0  # nodes that came back since the start

    def are_old(self, centre: Array) -> bool:
        """Whether bodies have gone on so far that holes are to be cut again."""
        way = np.abs(centre - self.seen).max(axis=1)
        return bool((way > self.params.threshold * self.layout.spacing).any())

    def cut(self, centre: Array, is_first: bool = False) -> Rows:
        """Leave out what clouds with these centres cover; return the nodes that came back."""
        cloud, layout, keys = self.cloud, self.layout, self.params
        count, positions = cloud.nodes, cloud.positions
        refuse_places(layout, centre, is_first)
        was = self.active[:count].copy()
        active = np.empty(count, bool)
        margins = np.where(is_first, 0.0, keys.hysteresis) * layout.spacing
        depths = layout.thickness - keys.overlap * layout.spacing
        covered = cut(
            positions, cloud.region[:count], layout.height, centre, layout.radii, depths, margins,
            was, active,
        )  # fmt: skip
        if covered >= 0:
            error: type[QuintetError] = SceneError if is_first else StepError
            raise error(
                f"walls must lie in the gas; that at {positions[covered].tolist()} m lies in "
                "another body. Move the bodies apart."
            )
        away = layout.heights_of(positions[:count], centre)
        for b in range(len(layout.radii)):
            self._part(b, away[b], was, active, margins[b])
        self.active[:count] = active
        self.active[count:] = active[cloud.owner]
        fresh = np.flatnonzero(active & ~was)
        self.seen[:] = centre
        self.volumes[:] = partitioned(layout, cloud, active, away, self.team)
        self.fresh_count += len(fresh)
        return fresh

    def _part(self, b: int, away: Array, was: Flags, active: Flags, more: float) -> None:
        """Leave out nodes of other clouds that lie too near to nodes of a body's cloud."""
        region = self.cloud.region[: len(active)]
        h, top = self.layout.spacing[b], self.layout.thickness[b]
        members = np.flatnonzero(active & (region == b + 1))
        rows = np.flatnonzero(active & (region != b + 1) & (away < top + h))
        rows = rows[np.isin(self.cloud.kind[rows], (INNER, OUTFLOW))]
        if len(rows) and len(members):
            positions = self.cloud.positions
            _, squares = nearest(positions, members, positions[rows], 1, self.team)
            part(rows, squares, self.params.fringe_distance * h, more, was, active)


def without_holes(domain: Domain, holes: Holes, outflows: Outflows) -> Domain:
    """Let volumes, boundaries and rows be those of nodes that are not left out.

    Parameters
    ----------
    domain : Domain
        Whose volumes and areas are written.
    holes : Holes
    outflows : Outflows
        Of the box, whether left out or not.
    """
    cloud, layout = domain.cloud, holes.layout
    active = holes.active[: cloud.nodes]
    cloud.volumes[: cloud.nodes] = holes.volumes
    domain = domain._replace(
        inner=np.flatnonzero(active & (cloud.kind[: cloud.nodes] == INNER)).astype(np.int32),
        every=np.flatnonzero(active).astype(np.int32),
        outflows=clear_of_holes(outflows, active),
    )
    if layout.is_cut.any():  # a cloud that reaches the box's face covers nodes of it
        cloud.areas[: cloud.nodes] = np.where(active[:, None], layout.areas, 0.0)
        if layout.planar:
            wall = layout.radii[layout.is_cut].max()
            nodes = layout.plane[active[layout.plane]]
            write_plane_areas(nodes, cloud.positions, wall, cloud.areas)
    return domain
