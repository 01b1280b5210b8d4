"""Bodies in a gas as its parameters describe them."""

import numpy as np

from quintet.components.meshless_gas.build import domain, transport_of
from quintet.components.meshless_gas.clouds.cloud import INNER
from quintet.components.meshless_gas.moving.clouds import MovingClouds
from quintet.components.meshless_gas.moving.layout import layout, with_bodies
from quintet.components.meshless_gas.moving.params import Moving
from quintet.components.meshless_gas.moving.refusals import refuse_sector
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.components.meshless_gas.stencils import Stencils, write_coefficients
from quintet.components.shared.threads import Team
from quintet.interfaces.component import Array
from quintet.interfaces.errors import SceneError

BLOCK = 8  # neighbours of a node in rings
LINES = 6  # neighbours of a node of a lattice in space along its lines
ACROSS = 14  # neighbours of a node in space over a seam, at least


def moving_clouds(params: MeshlessGasParams, team: Team) -> MovingClouds:
    """Put the clouds of bodies into their background."""
    keys = params.moving
    assert keys is not None
    _refuse(params, keys)
    assert params.box is not None
    ground = domain(params, team)
    planar, nodes, near = params.planar, ground.cloud.nodes, params.neighbours
    kept = near if planar else max(near, ACROSS)
    cloud, rings = with_bodies(ground.cloud, keys, 0, planar)
    whole, many = len(cloud.positions), max([kept, *(one.home.shape[1] for one in rings)])
    neighbours = np.repeat(np.arange(whole, dtype=np.int32)[:, None], many, axis=1)
    coefficients = np.zeros((whole, many, 3))
    found = ground.stencils.neighbours[:nodes]
    neighbours[:nodes, :near] = np.where(found < nodes, found, found + cloud.nodes - nodes)
    coefficients[:nodes, :near] = ground.stencils.coefficients[:nodes]
    if keys.cross:  # of a lattice, the nearest first
        lines = np.flatnonzero(cloud.kind[:nodes] == INNER)
        neighbours[lines, LINES:] = lines[:, None]
    box = np.array([params.box.lowest, params.box.highest])
    own = layout(cloud, nodes, rings, keys, neighbours, box, kept, planar)
    rows = np.arange(0 if keys.cross else nodes, cloud.nodes)
    made = Stencils(neighbours, coefficients)
    team.run(
        write_coefficients, len(rows), rows, cloud.positions, neighbours, cloud.weight, planar,
        coefficients, np.ones(whole),
    )  # fmt: skip
    joint = ground._replace(
        cloud=cloud,
        stencils=made,
        bounding=np.concatenate([ground.bounding, own.leaving.astype(np.int32)]),
        weights=_padded(ground.weights, many),
    )
    moving = MovingClouds(params, joint, own, team)
    if params.viscous:
        # Compiled only where the gas has friction.
        from quintet.components.meshless_gas.moving.friction import AxisStresses, Friction

        law = transport_of(params.gas)
        moving.friction = Friction(keys, own, law)
        if keys.axisymmetric:
            moving.stresses = AxisStresses(whole, law.conduction)
    return moving


def _refuse(params: MeshlessGasParams, keys: Moving) -> None:
    """Refuse what bodies that carry clouds do not go with."""
    if params.neighbours < BLOCK:
        raise SceneError(
            f"bodies that carry clouds need {BLOCK} neighbours at least; found "
            f"{params.neighbours}. Correct neighbours."
        )
    if params.box is None:
        raise SceneError("bodies that carry clouds need a box around them. Give a box.")
    if not params.viscous and any(one.temperature for one in keys.bodies):
        raise SceneError(
            "walls of a temperature hold the gas by friction. Say viscous = true, or leave out "
            "temperature."
        )
    if keys.axisymmetric and (params.kind_of("z-") != "symmetry" or params.box.lowest[2] != 0.0):
        raise SceneError(
            "an axisymmetric flow needs a box that begins at z = 0 with symmetry there; found "
            f"{params.kind_of('z-')} at {params.box.lowest[2]:g} m. Correct the box, or "
            'boundaries."z-".'
        )
    if keys.axisymmetric and not params.planar:
        raise SceneError(
            "bodies on an axis of symmetry need two dimensions; found 3. Leave out axisymmetric, "
            "or dimensions."
        )
    if keys.cross and (params.planar or params.box.jitter > 0.0):
        raise SceneError(
            "neighbours along lines alone are for three dimensions and lattices without jitter. "
            "Leave out cross, or jitter."
        )
    if params.planar and not keys.axisymmetric and any(one.is_cut for one in keys.bodies):
        raise SceneError(
            "clouds that end at a sector are those of spheres: on an axis of symmetry, or in three "
            "dimensions. Say axisymmetric = true or dimensions = 3, or leave out sector."
        )
    refuse_sector(params)
    for one in keys.bodies:
        if params.planar and (one.position[1] or one.velocity[1]):
            raise SceneError(
                "bodies in two dimensions lie and move in the plane y = 0; found position "
                f"{list(one.position)} m, velocity {list(one.velocity)} m/s. Leave y at 0."
            )


def _padded(weights: Array, many: int) -> Array:
    """Weights (b, many) of neighbours, of those that there are not 0."""
    more = np.zeros((len(weights), many - weights.shape[1]))
    return np.hstack([weights, more])
