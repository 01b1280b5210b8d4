"""Surface samples of what moves in the fluid, as rows of its state."""

from dataclasses import dataclass, field

import numpy as np

from quintet.components.sph_fluid.state import Array, State, Whole
from quintet.interfaces.component import Fields


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

    def find_rows(self, state: State) -> None:
        """Find their rows again."""
        self.row = state.sample_rows()
        self.number = state.sample[self.row - state.fluid]

    def move(self, state: State, fields: Fields) -> None:
        """Put them where they are in the coming step."""
        state.position_density[self.row, :3] = fields["surface.position"][self.number]
        state.velocity_pressure[self.row, :3] = fields["surface.velocity"][self.number]
        self.placed = True
