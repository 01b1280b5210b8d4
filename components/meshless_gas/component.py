"""A gas on a cloud of nodes, stepped by SSP-RK3."""

import math

import numpy as np

from quintet.components.meshless_gas import resolution
from quintet.components.meshless_gas.accuracy import accuracy_notes
from quintet.components.meshless_gas.build import initial_state
from quintet.components.meshless_gas.diagnostics import (
    balance,
    density_change,
    errors,
    failure,
    totals,
)
from quintet.components.meshless_gas.gauges import fronts, line, nearest_nodes, probes, refuse_far
from quintet.components.meshless_gas.kernels.boundaries import boundary_flows, write_boundaries
from quintet.components.meshless_gas.kernels.ghosts import (
    write_ghost_gradients,
    write_ghost_states,
)
from quintet.components.meshless_gas.kernels.gradients import write_gradients
from quintet.components.meshless_gas.kernels.motion import (
    STAGES,
    advance,
    write_bounds,
    write_sound,
)
from quintet.components.meshless_gas.kernels.outflows import continue_outflows
from quintet.components.meshless_gas.kernels.residuals import write_residuals
from quintet.components.meshless_gas.kernels.symmetry import hold_along
from quintet.components.meshless_gas.laws.limiters import limiter_of
from quintet.components.meshless_gas.monitors import blocked_inflows
from quintet.components.meshless_gas.node_motion import node_motion
from quintet.components.meshless_gas.params import MeshlessGasParams, has_walls
from quintet.components.meshless_gas.plan import plan
from quintet.components.meshless_gas.ports import SHOWS, ports
from quintet.components.meshless_gas.sidedness import sidedness
from quintet.components.meshless_gas.state import Fluxes
from quintet.components.meshless_gas.steady import Settling
from quintet.components.meshless_gas.thread_grain import FEWEST, LIGHT, SUMS
from quintet.components.meshless_gas.view import view, walls
from quintet.components.meshless_gas.wall_loads import WallLoads
from quintet.components.shared.threads import Team
from quintet.interfaces.component import (
    ONE_THREAD,
    Array,
    Component,
    Fields,
    Keys,
    Resources,
    Totals,
    fields_of,
)
from quintet.interfaces.errors import StepError
from quintet.interfaces.manifest import Plan, Ports


class MeshlessGas(Component):
    """Moves a gas through the nodes of a cloud.

    A class of one's own may derive from it, with a `Params` that derives from `MeshlessGasParams`:
    in a scene it is a kind, ``module:Class``, with all ports of this one.
    """

    Params: type[MeshlessGasParams] = MeshlessGasParams
    shows = SHOWS

    @classmethod
    def plan_of(cls, params: MeshlessGasParams) -> Plan:
        """What a run will need."""
        return plan(params)

    @classmethod
    def ports_of(cls, params: MeshlessGasParams) -> Ports:
        """Balances; errors where the solution is known; probes if there are any."""
        return ports(params)

    def __init__(self, params: MeshlessGasParams, resources: Resources = ONE_THREAD) -> None:
        self.params, (self.takes, self.gives) = params, self.ports_of(params)
        self.gamma, self.team = params.gas.gamma, Team(resources.threads, FEWEST)
        self.motion = node_motion(params, self.team)
        self.domain = self.motion.domain
        cloud = self.domain.cloud
        self.state = initial_state(params, cloud, self.team)
        self.motion.soften_start(self.state)
        self.fluxes = Fluxes.empty(cloud.nodes, len(cloud.owner))
        self.bound = 0.0  # s, step that all nodes bear at a Courant number of 1
        # What is None is not compiled.
        self.frame = self.motion.frame  # None or (n, 3) m/s
        self.planar = True if params.planar else None
        self.sloped = True if params.order == 2 else None
        self.limiter = limiter_of(params.limiter, params.limiter_threshold)
        self.steps = self.fluxes.steps if params.local_steps else None
        self.viscous = None
        if params.viscous:
            # Compiled only where the gas has friction.
            from quintet.components.meshless_gas.viscous.terms import Viscous

            self.viscous = Viscous(params, self.domain, self.team)
        self.wall_loads = WallLoads(params, self.domain) if has_walls(params) else None
        self.settling = Settling(params.steady) if params.steady is not None else None
        self.coarse = resolution.doubts(params, self.domain)
        ends = [end for one in params.fronts for end in (one.begin, one.end)]
        refuse_far(self.domain, (*params.probes, *ends), self.team)
        self.probed = nearest_nodes(cloud, params.probes, self.team)
        self.lines = [line(cloud, one, self.team) for one in params.fronts]
        self.particles = None
        if params.particles is not None:
            # Compiled only where there are particles.
            from quintet.components.meshless_gas.point_particles.point_particles import (
                CoupledParticles,
            )

            self.particles = CoupledParticles(params, self.domain)
        self._take_over()

    def describe(self) -> Fields:
        """State how large a particle may be that is taken for a point."""
        if self.particles is None:
            return {}
        return {"particles.largest_diameter": np.array([self.particles.coarsest])}

    def bind(self, static: Fields, joined: Keys) -> None:
        """Learn what a partner's particles and bodies are like, and whether it takes their heat."""
        self.motion.bind(static, joined)
        if self.particles is not None:
            self.particles.bind(static)

    def prime(self, fields: Fields) -> None:
        """Learn where particles are at the start."""
        if self.particles is not None:
            self.particles.prime(fields, self.fluxes.primitive)

    def prepare(self, fields: Fields) -> None:
        """Compile all kernels: try a step, and come back."""
        kept = self.save()
        self.take(fields)
        self.step(1e-3 * self.stable_dt())
        self.give(frozenset(fields_of(self.gives)))
        self.load(kept)

    def stable_dt(self) -> float:
        """Return the share `courant` of what the slowest node bears, or what particles allow."""
        if self.settling is not None and self.settling.is_settled:
            return math.inf
        flow = self.params.courant * self.bound
        if self.particles is None:
            return flow
        return min(flow, self.particles.stable_dt(self.fluxes.primitive))

    def take(self, fields: Fields) -> None:
        """Take the motion of bodies, if a partner moves some, and of particles."""
        self.motion.take(fields)
        if self.particles is not None:
            self.particles.take(fields)

    def step(self, dt: float) -> None:
        """Advance by exactly dt [s]; of local steps that of the node that bears least."""
        state, work = self.state, self.fluxes
        if self.settling is not None and self.settling.is_settled:
            state.time += dt
            return
        if self.motion.begin(dt, work.primitive, state.conservative):
            self._follow()
            self._fill()
        own = self.domain
        if self.particles is not None:
            self.particles.place()
        for stage, (old, new, share) in enumerate(STAGES):
            self.motion.place(stage, dt)
            self._write_rates()
            self.motion.add_rates(share, work, self.viscous)
            if self.particles is not None:
                self.particles.add(work.primitive, work.residual, dt, (old, new, share))
            state.entered += share * dt * work.flows
            state.work += share * dt * self._outer_power()
            wrong = self.team.run(
                advance, len(own.inner), own.inner, work.start, work.residual, dt, self.steps,
                old, new, self.gamma, state.conservative, work.primitive, fewest=LIGHT,
            )  # fmt: skip
            if max(wrong) >= 0:
                raise StepError(self._failure(max(wrong), dt))
            self._hold_along()
            self._fill()
        self.motion.end(dt)
        if self.particles is not None:
            state.entered -= dt * self.particles.given()
        state.time += dt
        self._look_ahead()
        state.change = density_change(state, self.domain, self.fluxes, self.team)
        if self.settling is not None and self.settling.is_due():
            self._settle()

    def _hold_along(self) -> None:
        """Let nodes of walls of symmetry move along them."""
        own, state = self.domain, self.state
        if len(own.mirrored):
            hold_along(own.mirrored, own.cloud.normals, state.conservative, self.fluxes.primitive)

    def _follow(self) -> None:
        """Take the nodes that are left after clouds have moved."""
        self.domain = self.motion.domain
        if self.viscous is not None:
            self.viscous.domain = self.domain

    def _outer_power(self) -> float:
        """Energy [W] that comes in now, but for what links bring."""
        return float(self.fluxes.flows[4]) - self.motion.power_of_partners()

    def _settle(self) -> None:
        """Look whether the flow is steady."""
        assert self.settling is not None
        force, scale = np.zeros(3), 0.0
        if self.wall_loads is not None:
            self._feel()
            force = self.wall_loads.force(self.fluxes.primitive)
            scale = self.wall_loads.scale(self.fluxes.primitive)
        self.settling.look(self.state.change, force, scale, self.state.time)

    def _feel(self) -> None:
        """Take friction and heat flux of walls, as the state is."""
        if self.viscous is not None and self.wall_loads is not None:
            one = self.viscous
            self.wall_loads.take(one.rows, one.friction, one.heat)

    def _failure(self, row: int, dt: float) -> str:
        own, node = self.domain, self.domain.inner[row]
        sided = sidedness(own.cloud, own.stencils, np.array([node]), self.params.planar, self.team)
        place, found = own.cloud.positions[node], self.fluxes.primitive[node]
        return failure(place, found, self.state.time, dt / self.bound, float(sided[0]))

    def _take_over(self) -> None:
        """Go on from the state, as it is at the start or was saved."""
        self.fluxes.primitive[: self.domain.cloud.nodes] = self.state.primitive
        self.state.primitive = self.fluxes.primitive[: self.domain.cloud.nodes]
        self._fill()
        self._look_ahead()

    def _fill(self) -> None:
        """Write the states of boundary nodes and ghosts; what comes through the boundary now."""
        own, work, cloud = self.domain, self.fluxes, self.domain.cloud
        write_boundaries(
            own.edges, cloud.kind, cloud.patch, cloud.normals, own.stencils.neighbours,
            own.weights, own.patches, self.frame, self.gamma, self.params.gas.gas_constant,
            work.primitive,
        )  # fmt: skip
        if len(own.outflows.rows):
            continue_outflows(
                *own.outflows, cloud.positions, cloud.patch, own.patches, cloud.normals,
                self.gamma, work.primitive,
            )  # fmt: skip
        if self.viscous is not None:
            self.viscous.hold(work.primitive)
        self.motion.hold_walls(work.primitive)
        self.team.run(
            write_ghost_states, len(cloud.owner), cloud.owner, cloud.turn, work.primitive,
            fewest=LIGHT,
        )  # fmt: skip
        boundary_flows(own.bounding, cloud.areas, work.primitive, self.gamma, work.flows)
        if self.viscous is not None:
            self.viscous.add_flows(work.primitive, work.flows)
        self.motion.load(work.primitive, work.flows)

    def _write_gradients(self) -> None:
        """Gradients of states that are filled."""
        own, work, cloud = self.domain, self.fluxes, self.domain.cloud
        self.team.run(
            write_gradients, len(own.every), own.every, work.primitive, *own.stencils,
            self.planar, work.gradients, work.lowest, fewest=SUMS,
        )  # fmt: skip
        self.team.run(
            write_ghost_gradients, len(cloud.owner), cloud.owner, cloud.turn, work.gradients,
            work.lowest, fewest=SUMS,
        )  # fmt: skip

    def _write_rates(self) -> None:
        """Rates of change of density, momentum and energy, of states that are filled."""
        own, work, cloud = self.domain, self.fluxes, self.domain.cloud
        neighbours, coefficients = own.stencils
        self._write_gradients()
        self.motion.flatten(work.gradients)
        self.team.run(
            write_residuals, len(own.inner), own.inner, cloud.positions, work.primitive,
            work.gradients, work.lowest, neighbours, coefficients, self.frame, self.planar,
            self.sloped, self.gamma, self.limiter, work.residual,
        )  # fmt: skip
        if self.viscous is not None:
            self.viscous.add(work)

    def _look_ahead(self) -> None:
        """Find the step that each node bears."""
        own, work = self.domain, self.fluxes
        self.team.run(
            write_sound, len(work.sound), work.primitive, self.gamma, work.sound, fewest=LIGHT
        )
        least = self.team.run(
            write_bounds, len(own.inner), own.inner, work.primitive, work.sound,
            own.stencils.neighbours, own.stencils.coefficients, self.frame, work.bounds,
            fewest=SUMS,
        )  # fmt: skip
        self.bound = min(least)
        if self.viscous is not None:
            self.bound = self.viscous.shorten(work)
        if not (0.0 < self.bound < math.inf):
            raise StepError(
                f"the gas must have a stable step at t = {self.state.time:.6g} s; found "
                f"{self.bound:g} s. Lower courant."
            )
        if self.steps is not None:
            np.divide(work.bounds, self.bound, out=work.steps)

    def give(self, wanted: Keys) -> Fields:
        """Copy out balances, errors and probes."""
        given: dict[str, Array] = {}
        ports_wanted = {key.partition(".")[0] for key in wanted}
        if "balance" in ports_wanted:
            given.update(balance(self.params, self.state, self.domain, self.fluxes, self.team))
        if "error" in ports_wanted:
            given.update(errors(self.params, self.state, self.domain.cloud, self.team))
        if "probes" in ports_wanted:
            cloud, gas = self.domain.cloud, self.params.gas
            given.update(probes(self.probed, cloud, self.state.primitive, gas))
        if "fronts" in ports_wanted:
            given.update(fronts(self.lines, self.state.primitive))
        if self.particles is not None:
            given.update(self.particles.loads())
        given.update(self.motion.outputs(self.state.primitive))
        if self.wall_loads is not None and ports_wanted & {"wall", "body"}:
            self._feel()
            given.update(self.wall_loads.wall(self.fluxes.primitive))
            given.update(self.wall_loads.body(self.fluxes.primitive))
            if self.settling is not None:
                given["body.settled"] = np.array([float(self.settling.is_settled)])
        return {key: given[key] for key in wanted}

    def save(self) -> Fields:
        """Copy out all state; boundary nodes and ghosts follow from it."""
        kept = self.state.save() | (self.settling.save() if self.settling is not None else {})
        kept |= self.particles.save() if self.particles is not None else {}
        return kept | self.motion.save()

    def load(self, state: Fields) -> None:
        """Come back to a saved state, bit for bit."""
        self.motion.restore(state)
        self._follow()
        self.state.load(state)
        if self.settling is not None:
            self.settling.load(state)
        if self.particles is not None:
            self.particles.load(state)
        self._take_over()

    def notes(self) -> tuple[str, ...]:
        """What was changed about the neighbours, and how accurate moving clouds are."""
        return (*self.domain.notes, *accuracy_notes(self.params))

    def warnings(self) -> dict[str, str]:
        """Doubts about the cloud and the order, and about inflows at which waves have arrived."""
        doubts = self.domain.doubts
        said = self.coarse | ({"neighbours": " ".join(doubts)} if doubts else {})
        return said | blocked_inflows(self.params, self.state, self.domain)

    def totals(self) -> Totals:
        """Mass, momentum and energies of all nodes."""
        return totals(self.params, self.state, self.domain.cloud, self.team)

    def view(self) -> Fields:
        """Nodes, and the state at each."""
        self._write_gradients()
        return view(self.state, self.domain, self.fluxes, self.params)

    def walls(self) -> Fields:
        """Walls of a box, or the wall of a body."""
        return walls(self.params)

    def items(self) -> int:
        """Count the nodes."""
        return self.domain.cloud.nodes
