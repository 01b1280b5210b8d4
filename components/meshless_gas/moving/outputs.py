"""What is given of bodies that carry clouds."""

import math
from typing import TYPE_CHECKING

import numpy as np

from quintet.components.meshless_gas.blunt_bodies import Stream, fay_riddell
from quintet.components.meshless_gas.moving.layout import CloudLayout
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.interfaces.component import Array

if TYPE_CHECKING:
    from quintet.components.meshless_gas.moving.clouds import MovingClouds


def outputs(moving: "MovingClouds", primitive: Array) -> dict[str, Array]:
    """Fields of the ports `bodies`, `surface`, `load` and `heat`."""
    own, pose, driven = moving.layout, moving.pose, moving.driven
    pressure, force = primitive[own.walls, 4], moving.summed[:, :3] + moving.base_force
    bodies, held, count = range(len(own.radii)), moving.friction, len(own.walls)
    heat = np.zeros(count) if held is None else held.heat.copy()
    return {
        "bodies.position": pose.centre.copy(),
        "bodies.velocity": pose.velocity.copy(),
        "bodies.force": force.copy(),
        "bodies.torque": moving.summed[:, 3:6].copy(),
        "bodies.heat": moving.summed[:, 7].copy(),
        "bodies.coefficient": force / moving.unit_force[:, None],
        "bodies.highest_pressure": np.array([pressure[own.body == b].max() for b in bodies]),
        "bodies.uncovered": np.full(len(bodies), float(moving.holes.uncovered)),
        "surface.position": moving.domain.cloud.positions[own.walls],
        "surface.body": own.body.astype(float),
        "surface.angle": np.arctan2(_aside(own.arms, own.planar), -own.arms[:, 0]),
        "surface.pressure": pressure.copy(),
        "surface.friction": np.zeros((count, 3)) if held is None else held.friction.copy(),
        "surface.heat_flux": heat,
        "surface.heat_ratio": heat / moving.unit_heat[own.body],
        "load.force": force[driven],
        "load.torque": moving.summed[driven, 3:6],
        "heat.heat_flow": moving.summed[driven, 7],
    }


def _aside(arms: Array, planar: bool) -> Array:
    """Distance (w,) m from the line along x through the centre; in a plane signed."""
    return np.asarray(arms[:, 2] if planar else np.hypot(arms[:, 1], arms[:, 2]))


def unit_force(params: MeshlessGasParams) -> Array:
    """Force (b,) N that a coefficient of 1 stands for: of the gas at the start."""
    assert params.initial is not None and params.moving is not None
    bodies = params.moving.bodies
    density, u, v, w, _ = params.initial.primitive(params.gas)
    speeds = np.array([u, v, w]) - np.array([one.velocity for one in bodies])
    square = np.maximum((speeds * speeds).sum(axis=1), 1e-300)
    radii = np.array([one.radius for one in bodies])
    is_sphere = params.moving.axisymmetric or not params.planar
    area = math.pi * radii**2 if is_sphere else 2.0 * radii
    return np.asarray(0.5 * density * square * area)


def base_force(params: MeshlessGasParams, layout: CloudLayout, areas: Array) -> Array:
    """Force (b, 3) N of the gas at the start on the back of bodies of which the front is computed.

    Parameters
    ----------
    params : MeshlessGasParams
    layout : CloudLayout
    areas : (n, 3) m2
        Of nodes, along normals into the gas.

    Returns
    -------
    array
        0 of bodies whose wall is whole.
    """
    assert params.initial is not None
    found = np.zeros((len(layout.is_cut), 3))
    np.add.at(found, layout.body, areas[layout.walls])  # of what is computed; the back's is less it
    if params.has_rings:  # of a whole turn about the axis nothing else is left
        found[:, 1:] = 0.0
    found[~layout.is_cut] = 0.0
    return np.asarray(params.initial.primitive(params.gas)[4] * found)


def unit_heat(params: MeshlessGasParams) -> Array:
    """Heat flux (b,) W/m2 that a ratio of 1 stands for; infinite where there is no law for it."""
    assert params.initial is not None and params.moving is not None
    gas, found = params.gas, []
    density, *wind, pressure = params.initial.primitive(gas)
    for one in params.moving.bodies:
        speed = math.dist(wind, one.velocity)
        stream = Stream(
            mach=speed / math.sqrt(gas.gamma * pressure / density),
            pressure=pressure,
            temperature=pressure / (gas.gas_constant * density),
            gamma=gas.gamma,
            gas_constant=gas.gas_constant,
            prandtl=gas.prandtl,
            sutherland=(gas.viscosity, gas.reference_temperature, gas.sutherland),
        )
        is_known = params.viscous and params.moving.axisymmetric and stream.mach > 1.0
        law = math.inf
        if is_known and one.temperature is not None:
            law = fay_riddell(stream, one.radius, one.temperature)
        found.append(law if law > 0.0 else math.inf)
    return np.array(found)
