"""Friction and heat conduction of a gas, and walls that hold it."""

import numpy as np

from quintet.components.meshless_gas.build import Domain, transport_of
from quintet.components.meshless_gas.clouds.cloud import (
    INNER,
    NO_SLIP_ADIABATIC,
    NO_SLIP_ISOTHERMAL,
    Whole,
    own_areas,
)
from quintet.components.meshless_gas.kernels.boundaries import write_weights
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.components.meshless_gas.state import Fluxes
from quintet.components.meshless_gas.thread_grain import LIGHT, SUMS
from quintet.components.meshless_gas.viscous.kernels.flux import (
    add_viscous,
    shorten_bounds,
    write_ghost_slopes,
    write_temperature_gradients,
    write_transport,
)
from quintet.components.meshless_gas.viscous.kernels.walls import (
    add_wall_flows,
    write_no_slip_walls,
    write_tractions,
)
from quintet.components.shared.threads import Team
from quintet.interfaces.component import Array
from quintet.interfaces.errors import SceneError

NO_SLIP_KINDS = (NO_SLIP_ISOTHERMAL, NO_SLIP_ADIABATIC)


class Viscous:
    """What viscosity adds to a gas; it remembers nothing from one step to the next."""

    def __init__(self, params: MeshlessGasParams, domain: Domain, team: Team) -> None:
        self.domain, self.team, self.law = domain, team, transport_of(params.gas)
        self.gamma = params.gas.gamma
        cloud, (neighbours, coefficients) = domain.cloud, domain.stencils
        held = np.isin(cloud.kind[: cloud.nodes], NO_SLIP_KINDS)
        self.rows = np.flatnonzero(held).astype(np.int32)
        self.weights = np.empty((len(self.rows), neighbours.shape[1]))
        lacks = write_weights(
            self.rows, cloud.kind, cloud.normals, neighbours, coefficients, self.weights
        )
        if lacks >= 0:
            place = np.array2string(cloud.positions[self.rows[lacks]], precision=4)
            raise SceneError(
                f"nodes of walls must have a neighbour within; that at {place} m has none. "
                "Raise neighbours, or refine the cloud there."
            )
        names = ("", *(n for n in params.boundaries if params.kind_of(n) != "periodic"))
        walls = [params.boundaries[names[number]] for number in cloud.patch[self.rows]]
        self.velocity = np.array([one.velocity or (0.0, 0.0, 0.0) for one in walls])
        self.velocity = self.velocity.reshape(-1, 3)
        self.temperature = np.array([one.temperature or -1.0 for one in walls])
        self.areas = own_areas(cloud, self.rows)
        self.above = nodes_above(self.rows, domain)
        self.rarefied = None
        if any(one.accommodation is not None for one in walls):
            # Compiled only where a gas slips along walls.
            from quintet.components.meshless_gas.viscous.rarefied import RarefiedWalls

            self.rarefied = RarefiedWalls(params, walls, self.rows, self.above, self.law)
        whole = len(cloud.positions)
        self.transported, self.gradients = np.ones((whole, 2)), np.zeros((whole, 3))
        self.friction, self.heat = np.zeros((len(self.rows), 3)), np.zeros(len(self.rows))

    def hold(self, primitive: Array) -> None:
        """Write the states of walls: their velocity and temperature, the gas's pressure."""
        write_no_slip_walls(
            self.rows, self.domain.stencils.neighbours, self.weights, self.domain.cloud.normals,
            self.velocity, self.temperature, self.gamma, self.law, primitive,
        )  # fmt: skip
        if self.rarefied is not None:
            self.rarefied.slide(self.domain, self.velocity, self.temperature, primitive)

    def add_flows(self, primitive: Array, flows: Array) -> None:
        """Find friction and heat flux at walls, and take them from what enters the gas."""
        cloud = self.domain.cloud
        write_tractions(
            self.rows, self.above, cloud.positions, cloud.normals, self.velocity, primitive,
            self.law, self.friction, self.heat,
        )  # fmt: skip
        if self.rarefied is not None:
            self.rarefied.write_tractions(
                self.domain, self.velocity, primitive, self.friction, self.heat
            )
        self.heat[self.temperature < 0.0] = 0.0
        add_wall_flows(self.areas, self.velocity, self.friction, self.heat, flows)

    def add(self, work: Fluxes) -> None:
        """Add rates of momentum and energy, by the gradients of this stage."""
        own, cloud = self.domain, self.domain.cloud
        neighbours, coefficients = own.stencils
        self.team.run(
            write_transport, len(cloud.positions), work.primitive, self.law, self.transported,
            fewest=LIGHT,
        )  # fmt: skip
        self.team.run(
            write_temperature_gradients, len(own.every), own.every, neighbours, coefficients,
            self.transported, self.gradients, fewest=SUMS,
        )  # fmt: skip
        self.team.run(
            write_ghost_slopes, len(cloud.owner), cloud.owner, cloud.turn, self.gradients,
            fewest=LIGHT,
        )  # fmt: skip
        self.team.run(
            add_viscous, len(own.inner), own.inner, cloud.positions, work.primitive,
            self.transported, neighbours, coefficients, work.gradients, self.gradients, self.law,
            work.residual,
        )  # fmt: skip

    def shorten(self, work: Fluxes) -> float:
        """Shorten the steps [s] that nodes bear; return the least."""
        own, cloud = self.domain, self.domain.cloud
        self.team.run(
            write_transport, len(cloud.positions), work.primitive, self.law, self.transported,
            fewest=LIGHT,
        )  # fmt: skip
        least = self.team.run(
            shorten_bounds, len(own.inner), own.inner, cloud.positions, work.primitive,
            self.transported, *own.stencils, self.gamma, self.law, work.bounds,
        )  # fmt: skip
        return float(min(least))


def nodes_above(rows: Whole, domain: Domain) -> Whole:
    """Two nodes (w, 2) above each node of a wall: by neighbours nearest to its normal.

    Where the second would be no further away than the first, as in a corner, both are the first's
    nearest, and slopes are of first order.
    """
    cloud, neighbours = domain.cloud, domain.stencils.neighbours
    found = np.empty((len(rows), 2), np.int32)
    at = rows.astype(np.int64)
    for step in range(2):
        near = neighbours[at]
        arms = cloud.positions[near] - cloud.positions[rows][:, None]
        up = (arms * cloud.normals[rows][:, None]).sum(axis=2)
        length = np.sqrt((arms**2).sum(axis=2))
        past = 0.0 if step == 0 else ((cloud.positions[at] - cloud.positions[rows])
                                      * cloud.normals[rows]).sum(axis=1)[:, None]  # fmt: skip
        inner = (cloud.kind[near] == INNER) & (up > past * (1.0 + 1e-9))
        score = np.where(inner, up / np.where(length > 0.0, length, 1.0), -1.0)
        score -= (
            1e-6 * np.where(inner, length, 0.0) / np.max(length, initial=1e-300)
        )  # of two in line the nearer
        at = near[np.arange(len(rows)), score.argmax(axis=1)].astype(np.int64)
        found[:, step] = at
    return found
