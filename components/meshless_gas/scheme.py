"""The scheme in space: boundary states, gradients, rates of change, and stable steps."""

import math
from collections.abc import Sequence

import numpy as np

from quintet.components.meshless_gas.clouds.cloud import Whole
from quintet.components.meshless_gas.kernels.boundaries import boundary_flows, write_boundaries
from quintet.components.meshless_gas.kernels.ghosts import (
    write_ghost_gradients,
    write_ghost_states,
)
from quintet.components.meshless_gas.kernels.gradients import write_gradients
from quintet.components.meshless_gas.kernels.motion import write_bounds, write_sound
from quintet.components.meshless_gas.kernels.outflows import continue_outflows
from quintet.components.meshless_gas.kernels.residuals import write_residuals
from quintet.components.meshless_gas.laws.limiters import limiter_of
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.components.meshless_gas.parts import NodeMotion, Part, Stage
from quintet.components.meshless_gas.ranks.one import Ranks
from quintet.components.meshless_gas.state import Fluxes
from quintet.components.meshless_gas.thread_grain import LIGHT, SUMS
from quintet.components.shared.threads import Team
from quintet.interfaces.errors import StepError


class SpatialScheme:
    """Fluxes of a gas on its nodes, with the terms of its optional parts."""

    def __init__(
        self,
        params: MeshlessGasParams,
        motion: NodeMotion,
        parts: Sequence[Part],
        work: Fluxes,
        team: Team,
        ranks: Ranks,
    ) -> None:
        self.motion, self.parts, self.work, self.team = motion, parts, work, team
        self.ranks = ranks
        self.gamma, self.gas_constant = params.gas.gamma, params.gas.gas_constant
        self.shortest_step = 0.0  # s, stable for all nodes at a Courant number of 1
        # What is None is not compiled.
        self.planar = True if params.planar else None
        self.sloped = True if params.order == 2 else None
        self.limiter = limiter_of(params.limiter, params.limiter_threshold)
        self.steps = work.steps if params.local_steps else None

    def apply_boundaries(self) -> None:
        """Write the states of boundary nodes and ghosts, and the flows through the boundary."""
        domain, work, cloud = self.motion.domain, self.work, self.motion.domain.cloud
        write_boundaries(
            domain.edges, cloud.kind, cloud.patch, cloud.normals, domain.stencils.neighbours,
            domain.weights, domain.patches, self.motion.frame, self.gamma, self.gas_constant,
            work.primitive,
        )  # fmt: skip
        if len(domain.outflows.rows):
            continue_outflows(
                *domain.outflows, cloud.positions, cloud.patch, domain.patches, cloud.normals,
                self.gamma, work.primitive,
            )  # fmt: skip
        for part in self.parts:
            part.write_walls(domain, work.primitive)
        self.ranks.exchange_boundaries(work.primitive)
        self.team.run(
            write_ghost_states, len(cloud.owner), cloud.owner, cloud.turn, work.primitive,
            fewest=LIGHT,
        )  # fmt: skip
        boundary_flows(domain.bounding, cloud.areas, work.primitive, self.gamma, work.flows)
        for part in self.parts:
            part.add_flows(domain, work.primitive, work.flows)

    def write_gradients(self, nodes: Whole, ghosts: Whole | None = None) -> None:
        """Write gradients at some nodes, and at some or all ghosts those of the nodes behind."""
        domain, work, cloud = self.motion.domain, self.work, self.motion.domain.cloud
        self.team.run(
            write_gradients, len(nodes), nodes, work.primitive, *domain.stencils,
            self.planar, work.gradients, work.lowest, fewest=SUMS,
        )  # fmt: skip
        count = len(cloud.owner) if ghosts is None else len(ghosts)
        self.team.run(
            write_ghost_gradients, count, cloud.owner, cloud.turn, work.gradients,
            work.lowest, ghosts, fewest=SUMS,
        )  # fmt: skip

    def write_rates(self, dt: float, stage: Stage) -> None:
        """Write the rates of change of density, momentum and energy in a stage of a step [s]."""
        domain, work = self.ranks.share(self.motion.domain), self.work
        self.write_gradients(domain.every, domain.ghosts)
        self.motion.flatten(work.gradients)
        self.team.run(
            write_residuals, len(domain.inner), domain.inner, domain.cloud.positions,
            work.primitive, work.gradients, work.lowest, *domain.stencils, self.motion.frame,
            self.planar, self.sloped, self.gamma, self.limiter, work.residual,
        )  # fmt: skip
        for part in self.parts:
            part.add_rates(domain, work, dt, stage)

    def update_stable_step(self, time: float) -> None:
        """Find the stable step of each node, and the shortest, at a time [s]."""
        domain, work = self.ranks.share(self.motion.domain), self.work
        self.team.run(
            write_sound, len(work.sound), work.primitive, self.gamma, work.sound, fewest=LIGHT
        )
        shortest = self.team.run(
            write_bounds, len(domain.inner), domain.inner, work.primitive, work.sound,
            *domain.stencils, self.motion.frame, work.bounds, fewest=SUMS,
        )  # fmt: skip
        self.shortest_step = min(shortest)
        for part in self.parts:
            self.shortest_step = part.shorten(domain, work, self.shortest_step)
        self.accept(self.ranks.least(self.shortest_step), time)
        if self.steps is not None:
            np.divide(work.bounds, self.shortest_step, out=work.steps)

    def accept(self, shortest: float, time: float) -> None:
        """Note the shortest stable step [s] of all nodes at a time [s]; refuse none."""
        self.shortest_step = shortest
        if not (0.0 < shortest < math.inf):
            raise StepError(
                f"the gas must have a stable step at t = {time:.6g} s; found {shortest:g} s. "
                "Lower courant."
            )
