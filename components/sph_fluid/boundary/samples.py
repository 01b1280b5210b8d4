"""Surface samples of what moves in the fluid, as rows of its state."""

from dataclasses import dataclass, field

import numpy as np

from quintet.components.sph_fluid.state import Array, State, Whole
from quintet.interfaces.component import Fields
from quintet.interfaces.errors import OrderError


def _no_rows() -> Whole:
    return np.zeros(0, np.int64)


def _no_numbers() -> Array:
    return np.zeros(0)


@dataclass(slots=True)
class Samples:
    """Those of one fluid, in the order of their port; where they stand, those of this rank."""

    number: Whole = field(default_factory=_no_rows)  # (k,) in the port
    row: Whole = field(default_factory=_no_rows)  # (k,) in the state
    listed: Whole = field(default_factory=_no_rows)  # (k,) in the lists
    body: Array = field(default_factory=_no_numbers)  # (samples,) number
    volume: Array = field(default_factory=_no_numbers)  # (samples,) m3
    placed: bool = True  # whether they have been told where they are

    def join(self, state: State, static: Fields, density: float) -> None:
        """Make room for the samples that links bring, of a density [kg/m3]."""
        state.add_samples(len(static["surface.volume"]), density)
        self.body = np.array(static["surface.body"])
        self.volume = np.array(static["surface.volume"])
        self.placed = False
        self.find_rows(state)

    def require_placed(self) -> None:
        """Refuse a step before they are placed."""
        if not self.placed:
            raise OrderError("step: surface samples must be placed first. Call take before it.")

    def find_rows(self, state: State) -> None:
        """Find their rows again."""
        self.row = state.sample_rows()
        self.number = state.sample[self.row - state.fluid]

    def rows_of(self, first: int, count: int) -> tuple[Whole, Whole]:
        """Rows (k,) in the state of so many samples from the first one on, and which they are."""
        if count == len(self.volume):
            return self.row, self.number
        chosen = np.flatnonzero((self.number >= first) & (self.number < first + count))
        return self.row[chosen], self.number[chosen] - first

    def move(self, state: State, fields: Fields, first: int = 0) -> None:
        """Put them where they are in the coming step, from the first one on."""
        rows, numbers = self.rows_of(first, len(fields["surface.position"]))
        state.position_density[rows, :3] = fields["surface.position"][numbers]
        state.velocity_pressure[rows, :3] = fields["surface.velocity"][numbers]
        self.placed = self.placed or first == 0
