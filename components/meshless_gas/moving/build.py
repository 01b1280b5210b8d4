"""Bodies in a gas as its parameters describe them."""

import numpy as np

from quintet.components.meshless_gas.build import domain, transport_of
from quintet.components.meshless_gas.moving.clouds import MovingClouds
from quintet.components.meshless_gas.moving.layout import layout, with_bodies
from quintet.components.meshless_gas.moving.refusals import refuse_sector
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.components.meshless_gas.stencils import Stencils, write_coefficients
from quintet.components.shared.threads import Team
from quintet.interfaces.errors import SceneError

BLOCK = 8  # neighbours of a node in rings


def moving_clouds(params: MeshlessGasParams, team: Team) -> MovingClouds:
    """Put the clouds of bodies into their background."""
    keys = params.moving
    assert keys is not None
    if not params.planar or params.neighbours < BLOCK:
        raise SceneError(
            f"bodies that carry clouds need two dimensions and {BLOCK} neighbours at least; found "
            f"{params.dimensions} and {params.neighbours}. Correct dimensions and neighbours."
        )
    if params.box is None:
        raise SceneError("bodies that carry clouds need a box around them. Give a box.")
    if not params.viscous and any(one.is_holding for one in keys.bodies):
        raise SceneError(
            "walls of a temperature, or adiabatic ones, hold the gas by friction. Say viscous = "
            "true, or leave out temperature and is_adiabatic."
        )
    if keys.axisymmetric and (params.kind_of("z-") != "symmetry" or params.box.lowest[2] != 0.0):
        raise SceneError(
            "an axisymmetric flow needs a box that begins at z = 0 with symmetry there; found "
            f"{params.kind_of('z-')} at {params.box.lowest[2]:g} m. Correct the box, or "
            'boundaries."z-".'
        )
    refuse_sector(params)
    ground = domain(params, team)
    nodes = ground.cloud.nodes
    cloud, rings = with_bodies(ground.cloud, keys, 0)
    whole, many = len(cloud.positions), ground.stencils.neighbours.shape[1]
    neighbours = np.repeat(np.arange(whole, dtype=np.int32)[:, None], many, axis=1)
    coefficients = np.zeros((whole, many, 3))
    found = ground.stencils.neighbours[:nodes]
    neighbours[:nodes] = np.where(found < nodes, found, found + cloud.nodes - nodes)
    coefficients[:nodes] = ground.stencils.coefficients[:nodes]
    box = np.array([params.box.lowest, params.box.highest])
    own = layout(cloud, nodes, rings, keys, neighbours, box)
    rows = np.arange(nodes, cloud.nodes)
    made = Stencils(neighbours, coefficients)
    team.run(
        write_coefficients, len(rows), rows, cloud.positions, neighbours, cloud.weight, True,
        coefficients, np.ones(whole),
    )  # fmt: skip
    bounding = np.concatenate([ground.bounding, own.leaving.astype(np.int32)])
    joint = ground._replace(cloud=cloud, stencils=made, bounding=bounding)
    moving = MovingClouds(params, joint, own, team)
    if params.viscous:
        # Compiled only where the gas has friction.
        from quintet.components.meshless_gas.moving.friction import AxisStresses, Friction

        law = transport_of(params.gas)
        moving.friction = Friction(keys, own, law)
        if keys.axisymmetric:
            moving.stresses = AxisStresses(whole, law.conduction)
    return moving
