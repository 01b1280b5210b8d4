"""Bodies in a gas as its parameters describe them."""

import numpy as np

from quintet.components.meshless_gas.build import domain, transport_of
from quintet.components.meshless_gas.clouds.cloud import INNER
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
ACROSS = 14  # neighbours of a node in space over a seam, at least


def moving_clouds(params: MeshlessGasParams, team: Team) -> MovingClouds:
    """Put the clouds of bodies into their background."""
    keys = params.moving
    assert keys is not None
    refuse_scene(params, keys)
    assert params.box is not None
    ground = domain(params, team)
    planar, nodes, near = params.planar, ground.cloud.nodes, ground.stencils.neighbours.shape[1]
    count = params.neighbour_count if planar else max(params.neighbour_count, ACROSS)
    cloud, rings = with_bodies(ground.cloud, keys, 0, planar)
    whole, many = (
        len(cloud.positions),
        max([near, count, *(body_cloud.home.shape[1] for body_cloud in rings)]),
    )
    neighbours = np.repeat(np.arange(whole, dtype=np.int32)[:, None], many, axis=1)
    coefficients = np.zeros((whole, many, 3))
    near_nodes = ground.stencils.neighbours[:nodes]
    neighbours[:nodes, :near] = np.where(
        near_nodes < nodes, near_nodes, near_nodes + cloud.nodes - nodes
    )
    coefficients[:nodes, :near] = ground.stencils.coefficients[:nodes]
    if keys.line_stencils:  # of a lattice, the nearest first
        lines = np.flatnonzero(cloud.kind[:nodes] == INNER)
        neighbours[lines, LINES:] = lines[:, None]
    box = np.array([params.box.lowest, params.box.highest])
    clouds = layout(cloud, nodes, rings, keys, neighbours, box, count, planar)
    rows = np.arange(0 if keys.line_stencils else nodes, cloud.nodes)
    stencil = Stencils(neighbours, coefficients)
    team.run(
        write_coefficients, len(rows), rows, cloud.positions, neighbours, cloud.weight, planar,
        coefficients, np.ones(whole),
    )  # fmt: skip
    joint = ground._replace(
        cloud=cloud,
        stencils=stencil,
        bounding=np.concatenate([ground.bounding, clouds.leaving.astype(np.int32)]),
        weights=_padded(ground.weights, many),
    )
    return MovingClouds(params, joint, clouds, _friction(params, keys, clouds), team)


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
