"""Terms of an axis of symmetry: circles of nodes grow with their distance from it."""

from quintet.components.meshless_gas.axis.kernels import (
    add_axis,
)
from quintet.components.meshless_gas.build import Domain
from quintet.components.meshless_gas.parts import Part, Stage
from quintet.components.meshless_gas.state import Fluxes
from quintet.components.shared.threads import Team


class AxisTerms(Part):
    """Inviscid fluxes across growing circles."""

    def __init__(self, gamma: float, team: Team) -> None:
        self.gamma, self.team = gamma, team

    def add_rates(self, domain: Domain, work: Fluxes, dt: float, stage: Stage) -> None:
        """Add rates of density, momentum and energy."""
        self.team.run(
            add_axis, len(domain.inner), domain.inner, domain.cloud.positions, work.primitive,
            self.gamma, work.residual,
        )  # fmt: skip
