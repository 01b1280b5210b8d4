"""What is given of bodies that carry clouds."""

import math

import numpy as np

from quintet.components.meshless_gas.moving.clouds import MovingClouds
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.interfaces.component import Array


def outputs(moving: MovingClouds, primitive: Array, params: MeshlessGasParams) -> dict[str, Array]:
    """Fields of the ports `bodies`, `surface`, `load` and `heat`."""
    own, pose, driven = moving.layout, moving.pose, moving.driven
    pressure, force = primitive[own.walls, 4], moving.summed[:, :3]
    bodies, held, count = range(len(moving.radii)), moving.friction, len(own.walls)
    return {
        "bodies.position": pose.centre.copy(),
        "bodies.velocity": pose.velocity.copy(),
        "bodies.force": force.copy(),
        "bodies.heat": moving.summed[:, 7].copy(),
        "bodies.coefficient": force / _unit_force(moving, params)[:, None],
        "bodies.highest_pressure": np.array([pressure[own.body == b].max() for b in bodies]),
        "bodies.uncovered": np.full(len(bodies), float(moving.uncovered)),
        "surface.position": moving.domain.cloud.positions[own.walls],
        "surface.body": own.body.astype(float),
        "surface.angle": np.arctan2(_aside(own.arms, own.planar), -own.arms[:, 0]),
        "surface.pressure": pressure.copy(),
        "surface.friction": np.zeros((count, 3)) if held is None else held.friction.copy(),
        "surface.heat_flux": np.zeros(count) if held is None else held.heat.copy(),
        "load.force": force[driven],
        "load.torque": moving.summed[driven, 3:6],
        "heat.heat_flow": moving.summed[driven, 7],
    }


def _aside(arms: Array, planar: bool) -> Array:
    """Distance (w,) m from the line along x through the centre; in a plane signed."""
    return np.asarray(arms[:, 2] if planar else np.hypot(arms[:, 1], arms[:, 2]))


def _unit_force(moving: MovingClouds, params: MeshlessGasParams) -> Array:
    """Force (b,) N that a coefficient of 1 stands for."""
    assert params.initial is not None
    density, u, v, w, _ = params.initial.primitive(params.gas)
    speeds = np.array([u, v, w]) - np.array([one.velocity for one in moving.params.bodies])
    square = np.maximum((speeds * speeds).sum(axis=1), 1e-300)
    is_sphere = moving.params.axisymmetric or not moving.layout.planar
    area = math.pi * moving.radii**2 if is_sphere else 2.0 * moving.radii
    return np.asarray(0.5 * density * square * area)
