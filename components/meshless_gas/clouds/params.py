"""What a scene says about clouds of nodes."""

from typing import Annotated

from pydantic import Field

from quintet.interfaces.params import NotNegative, Positive, Vector, parameters


@parameters
class Box:
    """A box of nodes.

    Parameters
    ----------
    lowest, highest : m
        Its corners; y is left out in two dimensions.
    spacing : m
        Between nodes; changed a little to fit into the box.
    jitter : 1
        By how much nodes are moved at random, over the spacing: by half of it to either side.
    seed : 1
        Of the random moves.
    weight : 1
        Of the least squares: 0 for a truncated Gaussian over the distance, else the power p of
        1/dᵖ.
    """

    lowest: Vector
    highest: Vector
    spacing: Positive
    jitter: Annotated[float, Field(ge=0, le=0.9, allow_inf_nan=False)] = 0.0
    seed: Annotated[int, Field(ge=0)] = 1
    weight: NotNegative = 0.0

    def expected_count(self, dimensions: int) -> int:
        """About how many nodes there will be."""
        axes = (0, 2) if dimensions == 2 else (0, 1, 2)
        count = 1.0
        for d in axes:
            count *= max(1.0, (self.highest[d] - self.lowest[d]) / self.spacing)
        return round(count)
