"""Viscous stresses about an axis of symmetry."""

import numpy as np

from quintet.components.meshless_gas.axis.kernels import (
    add_axis_stresses,
    write_swelling,
)
from quintet.components.meshless_gas.build import Domain
from quintet.components.meshless_gas.parts import Part, Stage
from quintet.components.meshless_gas.state import Fluxes
from quintet.components.meshless_gas.viscous.terms import Viscous
from quintet.components.shared.threads import Team


class AxisStresses(Part):
    """Viscous stresses and heat across growing circles; acts after `Viscous`."""

    def __init__(self, viscous: Viscous, team: Team) -> None:
        self.viscous, self.team = viscous, team
        self.swelling = np.zeros(len(viscous.transported))

    def add_rates(self, domain: Domain, work: Fluxes, dt: float, stage: Stage) -> None:
        """Add rates of momentum and energy."""
        positions, viscous = domain.cloud.positions, self.viscous
        write_swelling(
            0, len(positions), positions, work.primitive, viscous.transported, self.swelling
        )
        self.team.run(
            add_axis_stresses, len(domain.inner), domain.inner, positions, work.primitive,
            viscous.transported, self.swelling, *domain.stencils, work.gradients,
            viscous.gradients, viscous.law.conduction, work.residual,
        )  # fmt: skip
