"""Fields of the ports of bodies that carry clouds."""

import math

import numpy as np
from numpy.typing import NDArray

from quintet.components.meshless_gas.blunt_bodies import Stream, fay_riddell
from quintet.components.meshless_gas.moving.friction import BodyFriction
from quintet.components.meshless_gas.moving.kernels.walls import FORCE, HEAT, TORQUE
from quintet.components.meshless_gas.moving.layout import CloudLayout, Pose
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.interfaces.component import Array, Fields


class BodyOutputs:
    """Loads on bodies and on their surfaces, with the scales of their coefficients."""

    def __init__(
        self,
        params: MeshlessGasParams,
        layout: CloudLayout,
        areas: Array,
        driven: NDArray[np.int64],
    ) -> None:
        self.layout, self.driven = layout, driven
        self.unit_force, self.unit_heat = unit_force(params), unit_heat(params)
        self.base_force = base_force(params, layout, areas)  # (b, 3) N

    def bodies(self, pose: Pose, loads: Array, primitive: Array, fresh: int) -> Fields:
        """Fields of the port `bodies`, with mean loads (b, 8) and the number of fresh nodes."""
        layout, count = self.layout, len(self.layout.radii)
        force, pressure = loads[:, FORCE] + self.base_force, primitive[layout.walls, 4]
        highest = [pressure[layout.body == b].max() for b in range(count)]
        return {
            "bodies.position": pose.centre.copy(),
            "bodies.velocity": pose.velocity.copy(),
            "bodies.force": force,
            "bodies.torque": loads[:, TORQUE].copy(),
            "bodies.heat": loads[:, HEAT].copy(),
            "bodies.coefficient": force / self.unit_force[:, None],
            "bodies.highest_pressure": np.array(highest),
            "bodies.fresh_nodes": np.full(count, float(fresh)),
        }

    def surface(self, positions: Array, primitive: Array, friction: BodyFriction) -> Fields:
        """Fields of the port `surface`."""
        layout, arms = self.layout, self.layout.arms
        aside = arms[:, 2] if layout.planar else np.hypot(arms[:, 1], arms[:, 2])
        return {
            "surface.position": positions[layout.walls],
            "surface.body": layout.body.astype(float),
            "surface.angle": np.arctan2(aside, -arms[:, 0]),
            "surface.pressure": primitive[layout.walls, 4],
            "surface.friction": friction.friction.copy(),
            "surface.heat_flux": friction.heat.copy(),
            "surface.heat_ratio": friction.heat / self.unit_heat[layout.body],
        }

    def load(self, loads: Array) -> Fields:
        """Fields of the port `load`, of mean loads (b, 8)."""
        force = loads[self.driven, FORCE] + self.base_force[self.driven]
        return {"load.force": force, "load.torque": loads[self.driven, TORQUE]}

    def heat(self, loads: Array) -> Fields:
        """Fields of the port `heat`, of mean loads (b, 8)."""
        return {"heat.heat_flow": loads[self.driven, HEAT]}


def unit_force(params: MeshlessGasParams) -> Array:
    """Force (b,) N that a coefficient of 1 stands for: of the gas at the start."""
    assert params.initial is not None and params.moving is not None
    bodies = params.moving.bodies
    density, u, v, w, _ = params.initial.primitive(params.gas)
    speeds = np.array([u, v, w]) - np.array([body.velocity for body in bodies])
    square = np.maximum((speeds * speeds).sum(axis=1), 1e-300)
    radii = np.array([body.radius for body in bodies])
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
    outward = np.zeros((len(layout.is_cut), 3))
    np.add.at(
        outward, layout.body, areas[layout.walls]
    )  # of what is computed; the back's is less it
    if params.has_rings:  # of a whole turn about the axis nothing else is left
        outward[:, 1:] = 0.0
    outward[~layout.is_cut] = 0.0
    return np.asarray(params.initial.primitive(params.gas)[4] * outward)


def unit_heat(params: MeshlessGasParams) -> Array:
    """Heat flux (b,) W/m2 that a ratio of 1 stands for; infinite where there is no law for it."""
    assert params.initial is not None and params.moving is not None
    gas, units = params.gas, []
    density, *wind, pressure = params.initial.primitive(gas)
    for body in params.moving.bodies:
        speed = math.dist(wind, body.velocity)
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
        if is_known and body.temperature is not None:
            law = fay_riddell(stream, body.radius, body.temperature)
        units.append(law if law > 0.0 else math.inf)
    return np.array(units)
