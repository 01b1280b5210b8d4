"""A gas on a cloud of nodes, stepped by SSP-RK3."""

import math

from quintet.components.meshless_gas import MANIFEST, diagnostics, features, view
from quintet.components.meshless_gas.accuracy import accuracy_notes
from quintet.components.meshless_gas.build import initial_state
from quintet.components.meshless_gas.gauges import Gauges
from quintet.components.meshless_gas.kernels.motion import STAGES, advance
from quintet.components.meshless_gas.kernels.symmetry import hold_along
from quintet.components.meshless_gas.monitors import blocked_inflows
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.components.meshless_gas.port_readers import port_readers
from quintet.components.meshless_gas.ports import SHOWS
from quintet.components.meshless_gas.resolution import coarse_clouds
from quintet.components.meshless_gas.scheme import SpatialScheme
from quintet.components.meshless_gas.state import Fluxes
from quintet.components.meshless_gas.thread_grain import FEWEST, LIGHT
from quintet.components.shared.threads import Team
from quintet.interfaces.component import (
    ONE_THREAD,
    Array,
    Component,
    Fields,
    Keys,
    Resources,
    Totals,
)


class MeshlessGas(Component):
    """Moves a gas through the nodes of a cloud.

    A class of one's own may derive from it, with a `Params` that derives from `MeshlessGasParams`:
    in a scene it is a kind, ``module:Class``, with all ports of this one.
    """

    Params: type[MeshlessGasParams] = MeshlessGasParams
    manifest = MANIFEST
    shows = SHOWS
    compiles = True

    def __init__(self, params: MeshlessGasParams, resources: Resources = ONE_THREAD) -> None:
        self.params, (self.takes, self.gives) = params, self.ports_of(params)
        self.team = Team(resources.threads, FEWEST)
        self.motion = features.node_motion(params, self.team)
        domain = self.motion.domain
        self.state = initial_state(params, domain.cloud, self.team)
        self.motion.soften_start(self.state)
        self.nodes = domain.cloud.nodes
        self.friction = features.friction(params, self.motion, self.team)
        axis = features.axis_terms(params, self.friction, self.team)
        particles = features.particles(params, self.motion)
        self.parts = [self.friction, self.motion, *axis, *particles]  # in the order of their terms
        self.wall_loads = features.walls(params, self.motion, self.friction)
        self.gauges = Gauges(params, domain, self.team)
        self.coarse = coarse_clouds(params, domain)
        self.all_ranks = ranks = features.ranks(params, resources)
        parts = (*self.parts, self.gauges, self.wall_loads)
        ranks.divide(self.motion, parts, self.state)
        domain = self.motion.domain
        self.fluxes = Fluxes.empty(domain.cloud.nodes, len(domain.cloud.owner), ranks.room)
        self.scheme = SpatialScheme(params, self.motion, self.parts, self.fluxes, self.team, ranks)
        self.monitor = features.monitor(
            params, self.wall_loads, self.fluxes.primitive, domain, ranks
        )
        self.readers = port_readers(
            params, self.state, self.fluxes, self.motion, (*parts, self.monitor), self.team, ranks
        )
        self._continue_from_state()

    def describe(self) -> Fields:
        """State the largest diameter of a point particle."""
        return {key: array for part in self.parts for key, array in part.describe().items()}

    def bind(self, static: Fields, joined: Keys) -> None:
        """Take the properties of a partner's particles and bodies."""
        for part in self.parts:
            part.bind(static, joined)

    def prime(self, fields: Fields) -> None:
        """Take the places of particles at the start."""
        for part in self.parts:
            part.prime(fields, self.fluxes.primitive)

    def stable_dt(self) -> float:
        """Return the share `courant` of the shortest stable step, or what particles allow."""
        if self.monitor.is_settled:
            return math.inf
        steps = [part.stable_dt(self.fluxes.primitive) for part in self.parts]
        return min(self.params.courant * self.scheme.shortest_step, *steps)

    def take(self, fields: Fields) -> None:
        """Set the motion of bodies and particles that a partner moves."""
        for part in self.parts:
            part.take(fields)

    def step(self, dt: float) -> None:
        """Advance by dt [s]; with local time steps, dt is the smallest."""
        state, work, scheme = self.state, self.fluxes, self.scheme
        if self.monitor.is_settled:
            state.time += dt
            return
        for part in self.parts:
            part.begin(dt, work.primitive, state.conservative)
        if self.motion.moves:
            scheme.apply_boundaries()
        for number, (old, new, share) in enumerate(STAGES):
            self.motion.place(number, dt)
            scheme.write_rates(dt, (old, new, share))
            self.motion.sum_loads(share)
            state.entered += share * dt * work.flows
            state.work += share * dt * (float(work.flows[4]) - self.motion.partner_power())
            self._advance(dt, old, new, number == len(STAGES) - 1)
            scheme.apply_boundaries()
        for part in self.parts:
            part.end(dt)
            state.entered -= dt * part.loss_rates()
        state.time += dt
        scheme.update_stable_step(state.time)
        domain = self.motion.domain
        state.change = diagnostics.density_change(state, domain, work, self.team, self.all_ranks)
        self.monitor.update(work.primitive, state.change, state.time)

    def _advance(self, dt: float, old: float, new: float, is_last: bool) -> None:
        """Advance all nodes by a stage; those of walls of symmetry move along them."""
        domain, state, work, ranks = self.motion.domain, self.state, self.fluxes, self.all_ranks
        nodes, first = ranks.share(domain).inner, ranks.first(domain)
        wrong = max(self.team.run(
            advance, len(nodes), nodes, work.start, work.residual, dt,
            self.scheme.steps, old, new, self.params.gas.gamma, state.conservative, work.primitive,
            fewest=LIGHT,
        ))  # fmt: skip
        ranks.exchange(domain, work.primitive)
        if is_last or len(domain.mirrored):  # else nothing needs those of other ranks
            ranks.exchange_conserved(domain, state.conservative)
        failed = ranks.greatest(first + wrong if wrong >= 0 else -1)  # among all
        if failed >= 0:
            mine: list[int] = [wrong] if wrong >= 0 and first + wrong == failed else []
            share = dt / self.scheme.shortest_step
            raise diagnostics.step_error(
                mine, domain, work.primitive, state.time, share, self.params.planar, self.team,
                ranks,
            )  # fmt: skip
        if len(domain.mirrored):
            hold_along(domain.mirrored, domain.cloud.normals, state.conservative, work.primitive)

    def _continue_from_state(self) -> None:
        """Compute all that follows from the state, as it is at the start or was loaded."""
        nodes = self.motion.domain.cloud.nodes
        self.fluxes.primitive[:nodes] = self.state.primitive
        self.state.primitive = self.fluxes.primitive[:nodes]
        self.scheme.apply_boundaries()
        self.scheme.update_stable_step(self.state.time)

    def give(self, wanted: Keys) -> Fields:
        """Copy out the fields of the ports that are wanted."""
        ports = sorted({key.partition(".")[0] for key in wanted})  # as ranks sum over all nodes
        fields: dict[str, Array] = {}
        for reader in (reader for port in ports for reader in self.readers[port]):
            fields.update(reader())
        return {key: fields[key] for key in wanted}

    def save(self) -> Fields:
        """Copy out all state; boundary nodes and ghosts follow from it."""
        states = ("conservative", "primitive")
        saved = self.state.save() | self.monitor.save()
        saved |= {name: self.all_ranks.collect(self.motion.domain, saved[name]) for name in states}
        for part in self.parts:
            saved |= part.save()
        return saved

    def load(self, state: Fields) -> None:
        """Come back to a saved state, bit for bit."""
        for part in (*self.parts, self.monitor):
            part.restore(state)
        rows = self.all_ranks.rows_of
        states = {name: rows(state[name]) for name in ("conservative", "primitive")}
        self.state.load({**state, **states})
        self._continue_from_state()

    def begin_from(self, state: Fields) -> None:
        """Begin from the state of another run; that the flow had settled there counts no more."""
        super().begin_from(state)
        self.monitor.unsettle()

    def notes(self) -> tuple[str, ...]:
        """Changes of neighbours, and the accuracy of clouds of bodies."""
        return (*self.motion.domain.notes, *accuracy_notes(self.params))

    def warnings(self) -> dict[str, str]:
        """Doubts about the cloud and the order, and about inflows at which waves have arrived."""
        doubts = self.motion.domain.doubts
        warnings = self.coarse | ({"neighbours": " ".join(doubts)} if doubts else {})
        return warnings | blocked_inflows(
            self.params, self.state, self.motion.domain, self.all_ranks
        )

    def final_warnings(self) -> dict[str, str]:
        """Doubts about a flow that was to settle and has not."""
        return self.monitor.final_warnings(self.fluxes.primitive)

    def totals(self) -> Totals:
        """Mass, momentum and energies of all nodes."""
        domain, ranks = self.motion.domain, self.all_ranks
        return diagnostics.totals(self.params, self.state, domain, self.team, ranks)

    def view(self) -> Fields:
        """Nodes, and the state at each."""
        domain, ranks = self.motion.domain, self.all_ranks
        self.scheme.write_gradients(*ranks.around_shown(domain))
        return view.view(self.state, domain, self.fluxes, self.params, ranks)

    def walls(self) -> Fields:
        """Walls of a box, or the wall of a body."""
        return view.walls(self.params)

    def items(self) -> int:
        """Count the nodes."""
        return self.nodes
