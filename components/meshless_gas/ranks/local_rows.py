"""The rows of a cloud that one rank holds, and its domain by their local numbers."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from quintet.components.meshless_gas.build import Domain, Rows
from quintet.components.meshless_gas.clouds.cloud import INNER, Cloud
from quintet.components.meshless_gas.kernels.outflows import Outflows
from quintet.components.meshless_gas.ranks.part_stencils import needed, unwritten
from quintet.components.meshless_gas.stencils import Stencils

Whole = NDArray[np.int64]
Mask = NDArray[np.bool_]


class LocalRows(NamedTuple):
    """Rows of one rank, in the order of all; ghosts are the last."""

    rows: Whole  # (m,) of the whole cloud
    local: Rows  # (n,) row of each node and ghost of the whole cloud here; -1 where none
    domain: Domain  # by local rows
    sloped: Rows  # (s,) nodes whose gradients a view needs
    sloped_ghosts: Rows  # (r,) ghosts, from the first


def local_rows(
    domain: Domain, answered: Rows, advanced: Rows, written: Rows, read: Whole
) -> LocalRows:
    """Find the rows that a rank needs, and make a domain of them.

    Parameters
    ----------
    domain : Domain
        Of all nodes.
    answered : (p,) int
        Nodes that the rank shows.
    advanced : (m,) int
        Those of them that are advanced.
    written : (w,) int
        Boundary nodes whose states the rank computes.
    read : (r,) int
        Nodes and ghosts whose states parts need on every rank.
    """
    cloud, neighbours = domain.cloud, domain.stencils.neighbours
    every, ghosts = needed(domain, advanced)
    sloped, sloped_ghosts = needed(domain, answered)
    is_held = np.zeros(len(cloud.positions), bool)
    for rows in (answered, sloped, cloud.nodes + sloped_ghosts, neighbours[sloped], read):
        is_held[rows] = True
    _add_boundaries(domain, written, is_held)
    is_held[cloud.owner[is_held[cloud.nodes :]]] = True
    held = np.flatnonzero(is_held)
    local = np.full(len(is_held), -1, np.int32)
    local[held] = np.arange(len(held), dtype=np.int32)
    nodes = int(np.searchsorted(held, cloud.nodes))
    is_edge, is_plane = (np.isin(rows, written) for rows in (domain.edges, domain.outflows.rows))
    planes = Outflows(*(array[is_plane] for array in domain.outflows))
    part = domain._replace(
        cloud=_part_of(cloud, held, nodes, local),
        stencils=_stencils(domain, sloped, written, held, local),
        inner=local[advanced],
        every=local[every],
        edges=local[domain.edges[is_edge]],
        weights=domain.weights[is_edge],
        outflows=Outflows(local[planes.rows], local[planes.near], planes.weights),
        bounding=local[domain.bounding],
        mirrored=local[domain.mirrored],
        ghosts=local[cloud.nodes + ghosts] - np.int32(nodes),
        written=local[written],
    )
    shown_ghosts = local[cloud.nodes + sloped_ghosts] - np.int32(nodes)
    return LocalRows(held, local, part, local[sloped], shown_ghosts)


def _add_boundaries(domain: Domain, written: Rows, is_held: Mask) -> None:
    """Add all boundary nodes, and those within from which the states of some of them follow."""
    kind, near = domain.cloud.kind, domain.stencils.neighbours[written]
    is_held[domain.bounding] = True
    is_held[near[kind[near] == INNER]] = True
    is_held[domain.outflows.near[np.isin(domain.outflows.rows, written)]] = True


def _part_of(cloud: Cloud, held: Whole, nodes: int, local: Rows) -> Cloud:
    """Rows of a cloud; its ghosts are images of local nodes."""
    ghosts = held[nodes:] - cloud.nodes
    arrays: list[Any] = [array[held] for array in cloud[:-2]]
    return Cloud(*arrays, local[cloud.owner[ghosts]], cloud.turn[ghosts])  # type: ignore[call-arg]


def _stencils(domain: Domain, sloped: Rows, written: Rows, held: Whole, local: Rows) -> Stencils:
    """Stencils of nodes with gradients, and of boundary nodes whose states are computed.

    Neighbours that are not held are left out: boundary nodes and ghosts beside boundary nodes,
    which have no weight there.
    """
    shape = (len(held), domain.stencils.neighbours.shape[1])
    neighbours = unwritten(shape, np.int32)
    coefficients = unwritten((*shape, 3), np.float64)
    rows = np.union1d(sloped, written)
    near = local[domain.stencils.neighbours[rows]]
    neighbours[local[rows]] = np.where(near < 0, local[rows, None], near)
    coefficients[local[rows]] = domain.stencils.coefficients[rows]
    if (near < 0).any():
        coefficients[local[rows]] *= (near >= 0)[:, :, None]
    return Stencils(neighbours, coefficients)
