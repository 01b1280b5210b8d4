"""What a gas does to walls: pressure, friction and heat, node by node and as sums."""

import math
from collections.abc import Mapping

import numpy as np
from numpy.polynomial.polynomial import polyfit
from numpy.typing import NDArray

from quintet.components.meshless_gas.blunt_bodies import (
    Stream,
    fay_riddell,
    normal_shock,
    pitot_pressure,
)
from quintet.components.meshless_gas.boundaries import NO_SLIP, GasState
from quintet.components.meshless_gas.build import Domain
from quintet.components.meshless_gas.clouds.cloud import WALLS, Whole, own_areas
from quintet.components.meshless_gas.clouds.params import PlateCloud
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.components.meshless_gas.parts import Reader, WallFriction, Walls
from quintet.interfaces.component import Array, Fields

SHOCK_RAYS = 0.44  # rad, within which the shock is fitted
NEAR_AXIS = 0.25  # rad from the direction against the flow, over which values at it are fitted


class WallLoads(Walls):
    """Pressure, friction and heat on the walls of a gas."""

    def __init__(self, params: MeshlessGasParams, domain: Domain, walls: WallFriction) -> None:
        self.params = params
        cloud = domain.cloud
        patch = cloud.patch[: cloud.nodes]
        names = ["", *(n for n in params.boundaries if params.kind_of(n) != "periodic")]
        if params.box is None:
            chosen = np.isin(cloud.kind[: cloud.nodes], WALLS) & (patch == names.index("wall"))
        else:  # walls of bodies that carry clouds of their own have no patch of the box
            no_slip = [n for n, name in enumerate(names) if n and params.kind_of(name) in NO_SLIP]
            chosen = np.isin(patch, no_slip)
        self.rows = np.flatnonzero(chosen)
        self.places = cloud.positions[self.rows]
        # Where a wall ends its node has a share of what gas leaves through, or of another wall.
        self.areas = own_areas(cloud, self.rows)
        self.sizes = np.sqrt((self.areas**2).sum(axis=1))
        if params.box is not None:
            self.areas = cloud.areas[self.rows] * no_slip_faces(params, cloud.areas[self.rows])
        self.no_slip = walls
        _, self.at, self.among = np.intersect1d(self.rows, walls.rows, return_indices=True)
        self.stream = free_stream(params)
        if params.sphere is not None:
            away = cloud.positions[: cloud.nodes] - np.array(params.sphere.centre)
            foot = away[self.rows]
            self.angle = np.arctan2(np.hypot(foot[:, 1], foot[:, 2]), -foot[:, 0])  # (w,) rad
            self.axial = self._near(SHOCK_RAYS)
            distance = np.sqrt((away**2).sum(axis=1)).reshape(-1, len(self.rows))
            # (layers, s) m, above each of these wall nodes
            self.heights = distance[:, self.axial] - params.sphere.radius
            layers = np.arange(cloud.nodes, dtype=np.int32).reshape(distance.shape)
            self.rays = layers[:, self.axial]  # (layers, s) nodes

    def reads(self) -> Whole:
        """Nodes of the walls, and on the rays along which a shock is sought."""
        rays = self.rays if self._has_standoff else np.zeros(0, np.int32)
        return np.concatenate([self.rows, rays.ravel()])

    def renumber(self, local: Whole, domain: Domain) -> None:
        """Take the rows of nodes on this rank."""
        self.rows = local[self.rows].astype(np.int64)
        if self._has_standoff:
            self.rays = local[self.rays]

    @property
    def _has_standoff(self) -> bool:
        """Whether the distance of a bow shock is given."""
        is_fast = self.stream is not None and self.stream.mach > 1.0
        return self.params.sphere is not None and is_fast

    @property
    def friction(self) -> Array:
        """Friction (w, 3) Pa now."""
        friction = np.zeros((len(self.rows), 3))
        friction[self.at] = self.no_slip.friction[self.among]
        return friction

    @property
    def heat(self) -> Array:
        """Heat flux (w,) W/m2 into the walls now."""
        heat = np.zeros(len(self.rows))
        heat[self.at] = self.no_slip.heat[self.among]
        return heat

    def force(self, primitive: Array) -> Array:
        """Force (3,) N on all walls together, less that of the stream's pressure."""
        pressure = primitive[self.rows, 4] - (self.stream.pressure if self.stream else 0.0)
        return sums(pressure, self.friction, self.areas, self.sizes, self.params.axisymmetric)

    def torque(self, primitive: Array) -> Array:
        """Torque (3,) N m on all walls together, about the centre of a sphere or the origin."""
        if self.params.axisymmetric:  # whole rings have none
            return np.zeros(3)
        sphere = self.params.sphere
        arms = self.places - (np.zeros(3) if sphere is None else np.array(sphere.centre))
        return np.asarray(np.cross(arms, self._each(primitive)).sum(axis=0))

    def scale(self, primitive: Array) -> float:
        """Sum [N] of the sizes of forces on nodes, with which their sum's change is compared."""
        return float(np.sqrt((self._each(primitive) ** 2).sum(axis=1)).sum())

    def _each(self, primitive: Array) -> Array:
        """Forces (w, 3) N on nodes."""
        pressure, friction = self.forces(primitive)
        return np.asarray(friction + pressure)

    def forces(self, primitive: Array) -> Array:
        """Forces (2, w, 3) N on wall nodes: by pressure less the stream's, and by friction."""
        pressure = primitive[self.rows, 4] - (self.stream.pressure if self.stream else 0.0)
        return np.stack([-pressure[:, None] * self.areas, self.sizes[:, None] * self.friction])

    def readers(self, primitive: Array) -> Mapping[str, Reader]:
        """Readers of the ports `wall` and `body`."""
        return {
            "wall": lambda: self.wall(primitive),
            "body": lambda: self.body(primitive),
        }

    def wall(self, primitive: Array) -> Fields:
        """Fields of the port `wall`."""
        return {
            "wall.position": self.places.copy(),
            "wall.pressure": primitive[self.rows, 4],
            "wall.friction": self.friction,
            "wall.heat_flux": self.heat,
        }

    def body(self, primitive: Array) -> Fields:
        """Fields of the port `body`, but for what is judged over time."""
        force = self.force(primitive)
        fields = {
            "body.force": force[None],
            "body.torque": self.torque(primitive)[None],
            "body.heat": np.array([(self.sizes * self.heat).sum()]),
        }
        if self.stream is not None:
            fields |= {
                f"body.{key}": np.array([ratio]) for key, ratio in self._ratios(primitive, force)
            }
        return fields

    def _ratios(self, primitive: Array, force: Array) -> list[tuple[str, float]]:
        """Coefficients of the force, and values at the stagnation point over their laws."""
        params, stream = self.params, self.stream
        assert stream is not None
        push = 0.5 * stream.gamma * stream.pressure * stream.mach**2
        if params.sphere is None:
            assert isinstance(params.cloud, PlateCloud)
            return [("drag_coefficient", force[0] / (push * params.cloud.length))]
        sphere = params.sphere
        pressure = self._at_stagnation(primitive[self.rows, 4])
        ratios = [
            ("drag_coefficient", force[0] / (push * math.pi * sphere.radius**2)),
            (
                "pitot_ratio",
                pressure / (stream.pressure * pitot_pressure(stream.mach, stream.gamma)),
            ),
        ]
        if self._has_standoff:
            ratios.append(("standoff", self._standoff(primitive) / sphere.radius))
        wall = params.boundaries["wall"].temperature
        if wall is not None:
            law = fay_riddell(stream, sphere.radius, wall)
            ratios.append(("heat_ratio", self._at_stagnation(self.heat) / law))
        return ratios

    def _at_stagnation(self, values: Array) -> float:
        """Value where the flow meets the sphere: of the parabola that fits best near it."""
        assert self.params.sphere is not None
        near = self._near(NEAR_AXIS)
        return float(polyfit(self.angle[near] ** 2, values[near], 1)[0])

    def _near(self, angle: float) -> NDArray[np.int64]:
        """Nodes of the wall within an angle [rad] of the axis, six at least."""
        return np.argsort(self.angle)[: max(6, int((self.angle < angle).sum()))]

    def _standoff(self, primitive: Array) -> float:
        """Distance [m] of the shock from the wall, where density is midway, on the axis.

        Of the quartic in the angle that fits best on the rays near it.
        """
        assert self.stream is not None
        density, ray = primitive[self.rays, 0], np.arange(len(self.axial))
        behind, _ = normal_shock(self.stream.mach, self.stream.gamma)
        middle = 0.5 * (1.0 + behind) * self.stream.density
        inside = density > middle
        last = len(inside) - 2 - np.argmax(inside[-2::-1], axis=0)  # outermost that is compressed
        low, high = density[last, ray], density[last + 1, ray]
        share = np.clip((low - middle) / np.where(low > high, low - high, 1.0), 0.0, 1.0)
        height = self.heights[last, ray]
        height = height + share * (self.heights[last + 1, ray] - height)
        return float(polyfit(self.angle[self.axial] ** 2, height, 2)[0])


def no_slip_faces(params: MeshlessGasParams, areas: Array) -> NDArray[np.bool_]:
    """Whether each part (w, 3) of the areas of a box's nodes is of a face that holds the gas."""
    first, last = (
        np.array([params.kind_of(axis + side) in NO_SLIP for axis in "xyz"]) for side in "-+"
    )
    return np.asarray(np.where(areas > 0.0, first, last))


def free_stream(params: MeshlessGasParams) -> Stream | None:
    """The stream that a body in layers stands in."""
    if params.box is not None:
        return None
    upstream = params.boundaries["inlet" if params.sphere is None else "far"].state
    state: GasState | None = upstream or params.initial  # an inlet may have a total state alone
    if state is None:
        return None
    gas = params.gas
    density, *_, pressure = state.primitive(gas)
    return Stream(
        mach=state.mach(gas),
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
