"""What a scene says about the gas at the start."""

import math

from quintet.components.meshless_gas.boundaries import GasState
from quintet.interfaces.params import Number, Positive, Vector, parameters


@parameters
class Zone:
    """A box in which the gas begins otherwise.

    Parameters
    ----------
    lowest, highest : m
        Its corners, which hold one node at least; y is left out in two dimensions.
    state
        At the start.
    """

    lowest: Vector
    highest: Vector
    state: GasState


@parameters
class Riemann:
    """Two states on either side of a diaphragm across x that is taken away at the start.

    Its exact solution is known: the component then gives its error.

    Parameters
    ----------
    position : m
        Of the diaphragm.
    left, right
        States; their velocities are along x.
    """

    position: Number
    left: GasState
    right: GasState

    def wrong(self, low: float, high: float) -> list[str]:
        """What does not fit in a tube between two places [m] along x."""
        mistakes = []
        if not low < self.position < high:
            mistakes.append(
                f"riemann: its position must lie within the tube, between {low:g} and {high:g} m; "
                f"found {self.position:g} m. Move it."
            )
        mistakes += [
            f"riemann.{side}: its velocity must be along x; found {list(state.velocity)} m/s. Set "
            "y and z to 0."
            for side, state in (("left", self.left), ("right", self.right))
            if any(state.velocity[1:])
        ]
        return mistakes


@parameters
class Vortex:
    """An isentropic vortex about y that drifts with the initial state of the gas.

    Its exact solution is known: the component then gives its error. Shu, ICASE 97-65 (1997).

    Parameters
    ----------
    centre : m
        At the start; images are as far away as the box is wide.
    strength : m/s
        β: its greatest speed is β/2π, at one radius.
    radius : m
        Over which it fades as exp((1 - r²)/2).
    """

    centre: Vector
    strength: Positive
    radius: Positive = 1.0

    def wrong(self, gamma: float, warmth: float) -> list[str]:
        """Whether no gas is left in its middle; `warmth` m2/s2 is pressure over density around."""
        share = (gamma - 1.0) / (2.0 * gamma) * math.e
        if share / warmth * (self.strength / math.tau) ** 2 < 1.0:
            return []
        return [
            f"vortex: strength must leave gas in its middle; found {self.strength:g} m/s. Make it "
            "weaker, or the pressure higher."
        ]
