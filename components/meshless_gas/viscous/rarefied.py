"""Walls along which a rarefied gas slips."""

import numpy as np

from quintet.components.meshless_gas.boundaries import Boundary
from quintet.components.meshless_gas.build import Domain
from quintet.components.meshless_gas.clouds.cloud import Whole
from quintet.components.meshless_gas.laws.transport import Transport
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.components.meshless_gas.viscous.kernels.slip import (
    write_jumps,
    write_slip_tractions,
    write_slips,
)
from quintet.components.meshless_gas.viscous.laws import jump_length, slip_length
from quintet.interfaces.component import Array


class RarefiedWalls:
    """Those of the walls that have accommodation coefficients; it remembers nothing."""

    def __init__(
        self,
        params: MeshlessGasParams,
        walls: list[Boundary],
        rows: Whole,
        above: Whole,
        neighbours: Whole,
        law: Transport,
    ) -> None:
        self.law = law
        coefficients = [wall.accommodation for wall in walls]
        self.chosen = np.array([n for n, pair in enumerate(coefficients) if pair is not None])
        self.rows, self.above = rows[self.chosen], above[self.chosen]
        self._around = neighbours[self.rows].ravel()  # nodes and ghosts
        gas = params.gas
        self.lengths = np.array(
            [
                (slip_length(pair.momentum), jump_length(pair.energy, gas.gamma, gas.prandtl))
                for pair in coefficients
                if pair is not None
            ]
        )
        self.curvature = 1.0 / params.sphere.radius if params.sphere is not None else 0.0

    def reads(self) -> Whole:
        """Nodes and ghosts around the walls."""
        return self._around

    def renumber(self, local: Whole) -> None:
        """Take the rows of nodes on this rank."""
        self.rows, self.above, self._around = (
            local[rows] for rows in (self.rows, self.above, self._around)
        )

    def slide(self, domain: Domain, velocity: Array, temperature: Array, primitive: Array) -> None:
        """Let the gas have its own temperature and velocity at walls that have others."""
        cloud, chosen = domain.cloud, self.chosen
        write_jumps(
            self.rows, self.above, cloud.positions, cloud.normals, velocity[chosen],
            temperature[chosen], self.lengths, self.curvature, self.law, primitive,
        )  # fmt: skip
        write_slips(
            self.rows, self.above, cloud.positions, cloud.normals, *domain.stencils, cloud.owner,
            velocity[chosen], self.lengths, self.curvature, self.law, primitive,
        )  # fmt: skip

    def write_tractions(
        self, domain: Domain, velocity: Array, primitive: Array, friction: Array, heat: Array
    ) -> None:
        """Write viscous stress (w, 3) Pa and heat flux (w,) W/m2 of these among all walls."""
        cloud, chosen = domain.cloud, self.chosen
        stress, flux = np.empty((len(chosen), 3)), np.empty(len(chosen))
        write_slip_tractions(
            self.rows, self.above, cloud.positions, cloud.normals, *domain.stencils,
            velocity[chosen], self.curvature, self.law, primitive, stress, flux,
        )  # fmt: skip
        friction[chosen], heat[chosen] = stress, flux
