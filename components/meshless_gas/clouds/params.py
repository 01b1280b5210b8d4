"""What a scene says about clouds of nodes."""

import math
from typing import Annotated

from pydantic import Field

from quintet.interfaces.params import NotNegative, Positive, Vector, parameters


@parameters
class BoxCloud:
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

    @property
    def finest_spacing(self) -> float:
        """Least distance [m] of nodes."""
        return self.spacing

    def expected_count(self, dimensions: int) -> int:
        """About how many nodes there will be."""
        axes = (0, 2) if dimensions == 2 else (0, 1, 2)
        count = 1.0
        for d in axes:
            count *= max(1.0, (self.highest[d] - self.lowest[d]) / self.spacing)
        return round(count)


@parameters
class Layers:
    """How a cloud in layers over a wall is divided.

    Parameters
    ----------
    count : 1
        Layers between the wall and the far boundary.
    first : m
        Thickness of the first; the others grow by one factor. By default all are equal.
    weight : 1
        Of the least squares: 0 for a truncated Gaussian over the distance, else the power p of
        1/dᵖ, of flat and curved layers 2.
    cross
        Whether derivatives are taken along lines of nodes alone: 4 neighbours in the plane, 6 round
        an axis, 8 in space. With 8, 14 and 20 that along a wall is a mean over three layers.
    jitter : 1
        By how much nodes are moved at random, over the distance of their neighbours.
    seed : 1
        Of the random moves.
    """

    count: Annotated[int, Field(ge=3)]
    first: Positive | None = None
    weight: NotNegative = 2.0
    cross: bool = False
    jitter: Annotated[float, Field(ge=0, le=0.9, allow_inf_nan=False)] = 0.0
    seed: Annotated[int, Field(ge=0)] = 1


@parameters
class SphereCloud:
    """Layers of nodes round a sphere that stands in a flow along x, its centre on the axis.

    Its boundaries are ``wall``, ``far``, and ``exit`` where gas leaves downstream. The last layer
    follows the bow shock of the flow at ``far``.

    Parameters
    ----------
    centre : m
        On the axis of the flow.
    radius : m
        Of the sphere.
    rays : 1
        Nodes along a meridian of the sector; in space nodes of the sphere are as far apart.
    layers
        How the cloud is divided.
    sector : rad
        Widest angle from the direction against the flow; π for the whole sphere.
    margin : 1
        Distance of the last layer from the wall, over that of the shock by Billig's correlation.
    farthest : m
        Of the last layer from the centre.
    """

    centre: Vector = (0.0, 0.0, 0.0)
    radius: Positive
    rays: Annotated[int, Field(ge=6)]
    layers: Layers
    sector: Annotated[float, Field(gt=0.2, le=math.pi + 1e-9, allow_inf_nan=False)] = 1.4
    margin: Annotated[float, Field(gt=1, allow_inf_nan=False)] = 1.35
    farthest: Positive | None = None

    @property
    def reach(self) -> float:
        """Farthest distance [m] of the last layer from the centre."""
        return 10.0 * self.radius if self.farthest is None else self.farthest

    @property
    def finest_spacing(self) -> float:
        """Least distance [m] of nodes, of layers as far as the shock of M = 6."""
        even = 0.15 * self.margin * self.radius / self.layers.count
        return even if self.layers.first is None else self.layers.first

    def expected_count(self, dimensions: int) -> int:
        """About how many nodes there will be."""
        surface = float(self.rays)
        if dimensions == 3:
            surface *= 2.0 * math.pi * (1.0 - math.cos(self.sector)) / self.sector**2 * self.rays
        return round(surface * (self.layers.count + 1))


@parameters
class PlateCloud:
    """Layers of nodes over a flat plate from x = 0 on, and over a stretch of stream before it.

    Its boundaries are ``wall``, ``ahead`` (before the plate), ``inlet``, ``far`` (above) and
    ``exit``.

    Parameters
    ----------
    length : m
        Of the plate.
    ahead : m
        Of the stretch before it.
    height : m
        Of the cloud above the plate.
    rays : 1
        Nodes along the plate.
    finest : m
        Distance of nodes at its leading edge; it grows from there to both sides.
    layers
        How the cloud is divided.
    """

    length: Positive
    ahead: Positive
    height: Positive
    rays: Annotated[int, Field(ge=8)]
    finest: Positive
    layers: Layers

    @property
    def finest_spacing(self) -> float:
        """Least distance [m] of nodes."""
        even = self.height / self.layers.count
        return min(self.finest, even if self.layers.first is None else self.layers.first)

    def expected_count(self, dimensions: int) -> int:
        """About how many nodes there will be."""
        return (self.rays + self.rays // 4) * (self.layers.count + 1)
