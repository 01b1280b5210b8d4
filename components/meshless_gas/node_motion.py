"""Where nodes are, stage by stage: the interface, and clouds that stand still."""

from typing import TYPE_CHECKING, Protocol

from quintet.components.meshless_gas.build import Domain, domain
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.components.meshless_gas.state import Fluxes, State
from quintet.components.shared.threads import Team
from quintet.interfaces.component import Array, Fields, Keys

if TYPE_CHECKING:
    from quintet.components.meshless_gas.viscous.terms import Viscous


class NodeMotion(Protocol):
    """What a gas asks of its nodes' places, in the order of a step."""

    @property
    def domain(self) -> Domain:
        """Nodes as they are now, those left out that bodies cover."""

    @property
    def frame(self) -> Array | None:
        """Velocities (n, 3) m/s of nodes; None where all stand still, and none is compiled."""

    def bind(self, static: Fields, joined: Keys) -> None:
        """Learn what partners state, and which ports have one."""

    def soften_start(self, state: State) -> None:
        """Change the state at the start where bodies would jerk the gas."""

    def take(self, fields: Fields) -> None:
        """Take what a partner says of bodies."""

    def begin(self, dt: float, primitive: Array, conservative: Array) -> bool:
        """Put nodes where a step of dt [s] starts; return whether boundaries are to be refilled."""

    def place(self, stage: int, dt: float) -> None:
        """Put nodes where they are at a stage."""

    def end(self, dt: float) -> None:
        """Put nodes where they are at the step's end."""

    def hold_walls(self, primitive: Array) -> None:
        """Write the states of walls that move."""

    def load(self, primitive: Array, flows: Array) -> None:
        """Add what the gas gets from walls that move to `flows` (5,) kg/s, N, W."""

    def flatten(self, gradients: Array) -> None:
        """Let states be constant around nodes where the scheme is of first order."""

    def add_rates(self, share: float, work: Fluxes, viscous: "Viscous | None") -> None:
        """Add the rates that bodies' clouds have of their own, in a stage of this share."""

    def power_of_partners(self) -> float:
        """Energy [W] that links bring the gas now: from bodies that a partner moves or heats."""

    def outputs(self, primitive: Array) -> dict[str, Array]:
        """Fields of the bodies' ports."""

    def save(self) -> dict[str, Array]:
        """Copy out all that does not follow from the parameters."""

    def restore(self, saved: Fields) -> None:
        """Come back to a saved state, bit for bit."""


class FixedCloud:
    """Nodes that stand still: nothing is to be done."""

    frame = None

    def __init__(self, made: Domain) -> None:
        self.domain = made

    def bind(self, static: Fields, joined: Keys) -> None:
        """Need not know."""

    def soften_start(self, state: State) -> None:
        """Leave the state as it is."""

    def take(self, fields: Fields) -> None:
        """Take nothing: no port is there."""

    def begin(self, dt: float, primitive: Array, conservative: Array) -> bool:
        """Leave boundaries as the last stage filled them."""
        return False

    def place(self, stage: int, dt: float) -> None:
        """Stay."""

    def end(self, dt: float) -> None:
        """Stay."""

    def hold_walls(self, primitive: Array) -> None:
        """Hold nothing: its walls are patches of the cloud."""

    def load(self, primitive: Array, flows: Array) -> None:
        """Add nothing."""

    def flatten(self, gradients: Array) -> None:
        """Leave them as they are."""

    def add_rates(self, share: float, work: Fluxes, viscous: "Viscous | None") -> None:
        """Add nothing."""

    def power_of_partners(self) -> float:
        """No body, no power."""
        return 0.0

    def outputs(self, primitive: Array) -> dict[str, Array]:
        """No port."""
        return {}

    def save(self) -> dict[str, Array]:
        """All follows from the parameters."""
        return {}

    def restore(self, saved: Fields) -> None:
        """All follows from the parameters."""


def node_motion(params: MeshlessGasParams, team: Team) -> NodeMotion:
    """Place the nodes of a scene: with bodies that move, or for good."""
    if params.moving is None:
        return FixedCloud(domain(params, team))
    # Scenes without bodies that carry clouds import and compile none of this.
    from quintet.components.meshless_gas.moving.build import moving_clouds

    return moving_clouds(params, team)
