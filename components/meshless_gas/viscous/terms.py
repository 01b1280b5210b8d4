"""Friction and heat conduction of a gas, and walls that hold it."""

import numpy as np

from quintet.components.meshless_gas.build import Domain, transport_of
from quintet.components.meshless_gas.clouds.cloud import (
    INNER,
    NO_SLIP_KINDS,
    Whole,
    own_areas,
)
from quintet.components.meshless_gas.kernels.boundaries import write_weights
from quintet.components.meshless_gas.laws.transport import fastest_spread
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.components.meshless_gas.parts import Stage, WallFriction
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


class Viscous(WallFriction):
    """Terms of viscosity; it remembers nothing from one step to the next."""

    def __init__(self, params: MeshlessGasParams, domain: Domain, team: Team) -> None:
        self.team, self.law = team, transport_of(params.gas)
        self.gamma = params.gas.gamma
        self.spread = fastest_spread(self.law, self.gamma)
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
        self.velocity = np.array([wall.velocity or (0.0, 0.0, 0.0) for wall in walls])
        self.velocity = self.velocity.reshape(-1, 3)
        self.temperature = np.array([wall.temperature or -1.0 for wall in walls])
        self.areas = own_areas(cloud, self.rows)
        self.above = nodes_above(self.rows, domain)
        self.written = slice(0, len(self.rows))  # of these walls, those whose states are computed
        self.rarefied = []
        if any(wall.accommodation is not None for wall in walls):
            # Compiled only where a gas slips along walls.
            from quintet.components.meshless_gas.viscous.rarefied import RarefiedWalls

            self.couples_walls = True
            self.rarefied = [
                RarefiedWalls(params, walls, self.rows, self.above, neighbours, self.law)
            ]
        whole = len(cloud.positions)
        self.transported, self.gradients = np.ones((whole, 2)), np.zeros((whole, 3))
        self.friction, self.heat = np.zeros((len(self.rows), 3)), np.zeros(len(self.rows))

    def reads(self) -> Whole:
        """Nodes of walls and those above them, and what rarefied walls read."""
        rarefied = (slipping.reads() for slipping in self.rarefied)
        return np.concatenate([self.rows, self.above.ravel(), *rarefied])

    def renumber(self, local: Whole, domain: Domain) -> None:
        """Take the rows of nodes on this rank."""
        self.rows, self.above = local[self.rows], local[self.above]
        assert domain.written is not None
        chosen = np.flatnonzero(np.isin(self.rows, domain.written))
        self.written = slice(chosen[0], chosen[-1] + 1) if len(chosen) else slice(0, 0)
        for slipping in self.rarefied:
            slipping.renumber(local)
        whole = len(domain.cloud.positions)
        self.transported, self.gradients = np.ones((whole, 2)), np.zeros((whole, 3))

    def write_walls(self, domain: Domain, primitive: Array) -> None:
        """Write the states of walls: their velocity and temperature, the gas's pressure."""
        part = self.written
        write_no_slip_walls(
            self.rows[part], domain.stencils.neighbours, self.weights[part], domain.cloud.normals,
            self.velocity[part], self.temperature[part], self.gamma, self.law, primitive,
        )  # fmt: skip
        for slipping in self.rarefied:
            slipping.slide(domain, self.velocity, self.temperature, primitive)

    def add_flows(self, domain: Domain, primitive: Array, flows: Array) -> None:
        """Find friction and heat flux at walls, and take them from what enters the gas."""
        cloud = domain.cloud
        write_tractions(
            self.rows, self.above, cloud.positions, cloud.normals, self.velocity, primitive,
            self.law, self.friction, self.heat,
        )  # fmt: skip
        for slipping in self.rarefied:
            slipping.write_tractions(domain, self.velocity, primitive, self.friction, self.heat)
        self.heat[self.temperature < 0.0] = 0.0
        add_wall_flows(self.areas, self.velocity, self.friction, self.heat, flows)

    def add_rates(self, domain: Domain, work: Fluxes, dt: float, stage: Stage) -> None:
        """Add rates of momentum and energy, by the gradients of this stage."""
        cloud = domain.cloud
        self._write_transport(work.primitive)
        self.team.run(
            write_temperature_gradients, len(domain.every), domain.every, *domain.stencils,
            self.transported, self.gradients, fewest=SUMS,
        )  # fmt: skip
        self.team.run(
            write_ghost_slopes, len(cloud.owner), cloud.owner, cloud.turn, self.gradients,
            fewest=LIGHT,
        )  # fmt: skip
        self.team.run(
            add_viscous, len(domain.inner), domain.inner, cloud.positions, work.primitive,
            self.transported, *domain.stencils, work.gradients, self.gradients, self.law,
            work.residual,
        )  # fmt: skip

    def shorten(self, domain: Domain, work: Fluxes, shortest: float) -> float:
        """Shorten the stable steps of nodes by what diffusion needs; return the shortest [s]."""
        self._write_transport(work.primitive)
        steps = self.team.run(
            shorten_bounds, len(domain.inner), domain.inner, domain.cloud.positions,
            work.primitive, self.transported, *domain.stencils, self.gamma, self.spread,
            work.bounds,
        )  # fmt: skip
        return float(min(steps))

    def _write_transport(self, primitive: Array) -> None:
        """Write temperature and viscosity of all nodes."""
        self.team.run(
            write_transport, len(self.transported), primitive, self.law, self.transported,
            fewest=LIGHT,
        )  # fmt: skip


def nodes_above(rows: Whole, domain: Domain) -> Whole:
    """Two nodes (w, 2) above each node of a wall: by neighbours nearest to its normal.

    Where the second would be no further away than the first, as in a corner, both are the first's
    nearest, and slopes are of first order.
    """
    cloud, neighbours = domain.cloud, domain.stencils.neighbours
    above = np.empty((len(rows), 2), np.int32)
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
        above[:, step] = at
    return above
