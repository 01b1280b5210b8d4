"""What a gas does to walls: pressure, friction and heat, node by node and as sums."""

import math

import numpy as np
from numpy.typing import NDArray

from quintet.components.meshless_gas.blunt_bodies import Stream, fay_riddell, pitot_pressure
from quintet.components.meshless_gas.boundaries import GasState
from quintet.components.meshless_gas.build import Domain
from quintet.components.meshless_gas.clouds.bodies import mach_number
from quintet.components.meshless_gas.clouds.cloud import WALLS
from quintet.components.meshless_gas.clouds.params import Plate
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.interfaces.component import Array, Fields

NEAR_AXIS = 0.25  # rad from the direction against the flow, over which values at it are fitted


class Surface:
    """Walls of a gas."""

    def __init__(self, params: MeshlessGasParams, domain: Domain) -> None:
        self.params = params
        cloud = domain.cloud
        kind = cloud.kind[: cloud.nodes]
        names = ["", *(n for n in params.boundaries if params.kind_of(n) != "periodic")]
        chosen = np.isin(kind, WALLS)
        if params.box is None:
            chosen &= cloud.patch[: cloud.nodes] == names.index("wall")
        self.rows = np.flatnonzero(chosen)
        self.places = cloud.positions[self.rows]
        self.areas = cloud.areas[self.rows]
        self.sizes = np.sqrt((self.areas**2).sum(axis=1))
        self.friction, self.heat = np.zeros((len(self.rows), 3)), np.zeros(len(self.rows))
        self.stream = free_stream(params)

    def take(self, rows: NDArray[np.int32], friction: Array, heat: Array) -> None:
        """Take friction (w, 3) Pa and heat flux (w,) W/m2 of nodes that hold the gas."""
        at = np.searchsorted(rows, self.rows)
        held = at < len(rows)
        held[held] = rows[at[held]] == self.rows[held]
        self.friction[held], self.heat[held] = friction[at[held]], heat[at[held]]

    def force(self, primitive: Array) -> Array:
        """Force (3,) N on all walls together, less that of the stream's pressure."""
        pressure = primitive[self.rows, 4] - (self.stream.pressure if self.stream else 0.0)
        return sums(pressure, self.friction, self.areas, self.sizes, self.params.axisymmetric)

    def wall(self, primitive: Array) -> Fields:
        """Fields of the port `wall`."""
        return {
            "wall.position": self.places.copy(),
            "wall.pressure": primitive[self.rows, 4],
            "wall.friction": self.friction.copy(),
            "wall.heat_flux": self.heat.copy(),
        }

    def body(self, primitive: Array, settled: float) -> Fields:
        """Fields of the port `body`."""
        force = self.force(primitive)
        given = {
            "body.force": force[None],
            "body.heat": np.array([(self.sizes * self.heat).sum()]),
            "body.settled": np.array([settled]),
        }
        if self.stream is not None:
            given |= {f"body.{key}": np.array([one]) for key, one in self._ratios(primitive, force)}
        return given

    def _ratios(self, primitive: Array, force: Array) -> list[tuple[str, float]]:
        """Coefficients of the force, and values at the stagnation point over their laws."""
        params, stream = self.params, self.stream
        assert stream is not None
        push = 0.5 * stream.gamma * stream.pressure * stream.mach**2
        if params.sphere is None:
            assert isinstance(params.cloud, Plate)
            return [("drag_coefficient", force[0] / (push * params.cloud.length))]
        one = params.sphere
        pressure = self._at_stagnation(primitive[self.rows, 4])
        found = [
            ("drag_coefficient", force[0] / (push * math.pi * one.radius**2)),
            (
                "pitot_ratio",
                pressure / (stream.pressure * pitot_pressure(stream.mach, stream.gamma)),
            ),
        ]
        wall = params.boundaries["wall"].temperature
        if wall is not None:
            law = fay_riddell(stream, one.radius, wall)
            found.append(("heat_ratio", self._at_stagnation(self.heat) / law))
        return found

    def _at_stagnation(self, values: Array) -> float:
        """Value where the flow meets the sphere: of the parabola that fits best near it."""
        assert self.params.sphere is not None
        away = self.places - np.array(self.params.sphere.centre)
        angle = np.arctan2(np.hypot(away[:, 1], away[:, 2]), -away[:, 0])
        near = np.argsort(angle)[: max(6, int((angle < NEAR_AXIS).sum()))]
        return float(np.polynomial.polynomial.polyfit(angle[near] ** 2, values[near], 1)[0])


def free_stream(params: MeshlessGasParams) -> Stream | None:
    """The stream that a body in layers stands in."""
    if params.box is not None:
        return None
    given: GasState | None = params.initial
    if params.sphere is not None:
        given = params.boundaries["far"].state
    if given is None:
        return None
    gas = params.gas
    density, *_, pressure = given.primitive(gas)
    return Stream(
        mach=mach_number(given, params),
        pressure=pressure,
        temperature=pressure / (gas.gas_constant * density),
        gamma=gas.gamma,
        gas_constant=gas.gas_constant,
        prandtl=gas.prandtl,
        sutherland=(gas.viscosity, gas.reference_temperature, gas.sutherland),
    )


def sums(pressure: Array, friction: Array, areas: Array, sizes: Array, rings: bool) -> Array:
    """Force (3,) N on walls: -Σ p A n + Σ τ A; of whole rings what is across the axis cancels.

    Parameters
    ----------
    pressure : (w,) Pa
    friction : (w, 3) Pa
    areas : (w, 3) m2
        Along normals into the gas.
    sizes : (w,) m2
    rings : bool
    """
    force = (sizes[:, None] * friction - pressure[:, None] * areas).sum(axis=0)
    if rings:
        force[1:] = 0.0
    return np.asarray(force)
