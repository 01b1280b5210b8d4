"""Bodies in a gas as its parameters describe them."""

import numpy as np

from quintet.components.meshless_gas.build import Domain, domain, transport_of
from quintet.components.meshless_gas.clouds.cloud import INNER, Cloud, Whole
from quintet.components.meshless_gas.kernels.stencils import write_coefficients
from quintet.components.meshless_gas.moving.clouds import MovingClouds
from quintet.components.meshless_gas.moving.friction import BodyFriction, SlipBodies
from quintet.components.meshless_gas.moving.layout import CloudLayout, layout, with_bodies
from quintet.components.meshless_gas.moving.refusals import refuse_scene
from quintet.components.meshless_gas.moving_bodies import Moving
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.components.meshless_gas.stencils import Stencils
from quintet.components.shared.threads import Team
from quintet.interfaces.component import Array

LINES = 6  # neighbours of a node of a lattice in space along its lines
ACROSS = 14  # neighbours of a node in space over an overlap, at least


def moving_clouds(params: MeshlessGasParams, team: Team) -> MovingClouds:
    """Put the clouds of bodies into their background."""
    keys = params.moving
    assert keys is not None
    refuse_scene(params, keys)
    assert params.box is not None
    ground = domain(params, team)
    planar, nodes = params.planar, ground.cloud.nodes
    count = params.neighbour_count if planar else max(params.neighbour_count, ACROSS)
    cloud, rings = with_bodies(ground.cloud, keys, 0, planar)
    many = max(count, *(body_cloud.home.shape[1] for body_cloud in rings))
    neighbours, coefficients = _of_background(ground, cloud, many)
    if keys.line_stencils:  # of a lattice, the nearest first
        lines = np.flatnonzero(cloud.kind[:nodes] == INNER)
        neighbours[lines, LINES:] = lines[:, None]
    box = np.array([params.box.lowest, params.box.highest])
    clouds = layout(cloud, nodes, rings, keys, neighbours, box, count, planar)
    rows = np.arange(0 if keys.line_stencils else nodes, cloud.nodes)
    team.run(
        write_coefficients, len(rows), rows, cloud.positions, neighbours, cloud.weight, planar,
        coefficients, np.ones(len(neighbours)),
    )  # fmt: skip
    joint = ground._replace(
        cloud=cloud,
        stencils=Stencils(neighbours, coefficients),
        bounding=np.concatenate([ground.bounding, clouds.leaving.astype(np.int32)]),
        weights=_padded(ground.weights, neighbours.shape[1]),
    )
    return MovingClouds(params, joint, clouds, _friction(params, keys, clouds), team)


def _of_background(ground: Domain, cloud: Cloud, many: int) -> tuple[Whole, Array]:
    """Neighbours (n, K) in the joined cloud, and coefficients, of background nodes; K is `many`.

    If these have more neighbours K is theirs. Rows of other nodes are their own.
    """
    nodes, near = ground.cloud.nodes, ground.stencils.neighbours[: ground.cloud.nodes]
    whole, many = len(cloud.positions), max(many, near.shape[1])
    neighbours = np.repeat(np.arange(whole, dtype=np.int32)[:, None], many, axis=1)
    coefficients = np.zeros((whole, many, 3))
    ghosts = near + cloud.nodes - nodes
    neighbours[:nodes, : near.shape[1]] = np.where(near < nodes, near, ghosts)
    coefficients[:nodes, : near.shape[1]] = ground.stencils.coefficients[:nodes]
    return neighbours, coefficients


def _friction(params: MeshlessGasParams, keys: Moving, clouds: CloudLayout) -> BodyFriction:
    """Friction at the bodies' walls, where the gas has any."""
    if not params.viscous:
        return SlipBodies(len(clouds.walls))
    # Left out of scenes without friction.
    from quintet.components.meshless_gas.moving.no_slip import NoSlipBodies

    return NoSlipBodies(keys, clouds, transport_of(params.gas))


def _padded(weights: Array, many: int) -> Array:
    """Weights (b, many) of neighbours, of those that there are not 0."""
    more = np.zeros((len(weights), many - weights.shape[1]))
    return np.hstack([weights, more])
