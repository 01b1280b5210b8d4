"""Parts of the physics that a scene may leave out: their hooks, in the order of a step."""

import math
from collections.abc import Callable, Mapping

import numpy as np

from quintet.components.meshless_gas.build import Domain
from quintet.components.meshless_gas.clouds.cloud import Whole
from quintet.components.meshless_gas.state import Fluxes, State
from quintet.interfaces.component import Array, Fields, Keys

Stage = tuple[float, float, float]  # shares of the step's start and of the last stage, weight
Reader = Callable[[], Fields]  # computes the fields of one port from the present state


class Part:
    """Optional physics of a gas; a hook that a part does not define does nothing."""

    couples_walls = False  # whether states of boundary nodes follow from those of others

    def describe(self) -> Fields:
        """Answer requests and state static fields."""
        return {}

    def reads(self) -> Whole:
        """Nodes and ghosts (r,) whose states the part reads, whichever rank they belong to."""
        return np.zeros(0, np.int32)

    def renumber(self, local: Whole, domain: Domain) -> None:
        """Take the rows (n,) that a rank has for nodes and ghosts, -1 where none, and its domain.

        It has rows for all boundary nodes and for all that the part reads, and computes the states
        of some boundary nodes alone, `domain.written`.
        """

    def bind(self, static: Fields, joined: Keys) -> None:
        """Take the static fields of partners, and the names of the ports that have one."""

    def prime(self, fields: Fields, primitive: Array) -> None:
        """Take the instants at the start of the run."""

    def take(self, fields: Fields) -> None:
        """Set the inputs of the coming step."""

    def begin(self, dt: float, primitive: Array, conservative: Array) -> None:
        """Prepare a step of dt [s]."""

    def write_walls(self, domain: Domain, primitive: Array) -> None:
        """Write the states of wall nodes."""

    def add_flows(self, domain: Domain, primitive: Array, flows: Array) -> None:
        """Add what enters the gas through walls to `flows` (5,) kg/s, N, W."""

    def add_rates(self, domain: Domain, work: Fluxes, dt: float, stage: Stage) -> None:
        """Add rates of density, momentum and energy to `work.residual`."""

    def end(self, dt: float) -> None:
        """Finish a step of dt [s]."""

    def loss_rates(self) -> Array:
        """Mass, momentum and energy (5,) kg/s, N, W that the gas gave up in the last step."""
        return np.zeros(5)

    def shorten(self, domain: Domain, work: Fluxes, shortest: float) -> float:
        """Shorten `work.bounds`, the stable steps of the nodes; return the shortest [s]."""
        return shortest

    def stable_dt(self, primitive: Array) -> float:
        """Largest step [s] that this part allows, at any Courant number."""
        return math.inf

    def readers(self, primitive: Array) -> Mapping[str, Reader]:
        """Readers of this part's ports; `primitive` always holds the present state."""
        return {}

    def save(self) -> dict[str, Array]:
        """Copy out all that does not follow from the parameters."""
        return {}

    def restore(self, saved: Fields) -> None:
        """Return to a saved state, bit for bit."""


class NodeMotion(Part):
    """Where the nodes are, stage by stage."""

    domain: Domain  # nodes in use: those that bodies cover are left out
    frame: Array | None = (
        None  # (n, 3) m/s, of nodes; None, and not compiled, where all stand still
    )
    moves = False  # whether boundaries need new states after `begin`

    def divide(self, part: Callable[[Domain], Domain]) -> None:
        """Keep only the part of the domain that a rank needs, where nodes stand still."""

    def soften_start(self, state: State) -> None:
        """Change the state at the start where bodies would jerk the gas."""

    def place(self, stage: int, dt: float) -> None:
        """Move nodes to their places at a stage."""

    def flatten(self, gradients: Array) -> None:
        """Set gradients to zero where the scheme is of first order."""

    def sum_loads(self, share: float) -> None:
        """Add the present loads on bodies to their mean over the step."""

    def partner_power(self) -> float:
        """Energy [W] that links bring the gas now, from bodies that a partner moves or heats."""
        return 0.0


class FixedNodes(NodeMotion):
    """Nodes that stand still."""

    def __init__(self, domain: Domain) -> None:
        self.domain = domain

    def divide(self, part: Callable[[Domain], Domain]) -> None:
        """Keep only the part of the domain that a rank needs."""
        self.domain = part(self.domain)


class WallFriction(Part):
    """Friction and heat at no-slip walls of the cloud."""

    rows: Whole  # (w,) nodes of these walls
    friction: Array  # (w, 3) Pa
    heat: Array  # (w,) W/m2, into the wall


class Inviscid(WallFriction):
    """No friction: all walls slip."""

    def __init__(self) -> None:
        self.rows = np.zeros(0, np.int32)
        self.friction, self.heat = np.zeros((0, 3)), np.zeros(0)


class Walls(Part):
    """Loads on the walls of the cloud."""

    def force(self, primitive: Array) -> Array:
        """Force (3,) N on all walls together, less that of the stream's pressure."""
        return np.zeros(3)

    def scale(self, primitive: Array) -> float:
        """Sum [N] of the sizes of the forces on wall nodes."""
        return 0.0

    def forces(self, primitive: Array) -> Array:
        """Forces (2, w, 3) N on wall nodes: by pressure less the stream's, and by friction."""
        return np.zeros((2, 0, 3))


class NoWalls(Walls):
    """A cloud without walls on which loads are computed."""


class Monitor(Part):
    """Judges whether the flow has settled."""

    is_settled = False
    looks_next = False  # whether the next update looks at the states

    def update(self, primitive: Array, change: float, time: float) -> None:
        """Count a step of this relative change of densities [1], up to a time [s]."""

    def unsettle(self) -> None:
        """Let a flow that has settled go on: its boundaries may be others now."""

    def final_warnings(self, primitive: Array) -> dict[str, str]:
        """Doubts about a run that has ended."""
        return {}


class TransientFlow(Monitor):
    """A flow that is not expected to settle."""
