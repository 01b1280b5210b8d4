"""What a scene says about clouds of nodes."""

import math
from collections.abc import Mapping
from typing import Annotated, ClassVar

import numpy as np
from pydantic import Field

from quintet.components.meshless_gas.clouds.refinement import FinePart, transition, wrong_part
from quintet.interfaces.component import Array
from quintet.interfaces.params import NotNegative, Positive, Vector, parameters


@parameters
class Refinement:
    """A part of a box where nodes are finer.

    Parameters
    ----------
    lowest, highest : m
        Its corners; y is left out in two dimensions.
    levels : 1
        How many times the spacing is halved there.
    width : 1
        Of each level between, in its own spacings.
    """

    lowest: Vector
    highest: Vector
    levels: Annotated[int, Field(ge=1, le=8)] = 1
    width: Annotated[float, Field(ge=2, allow_inf_nan=False)] = 4.0

    @property
    def part(self) -> FinePart:
        """As clouds are made of it."""
        return FinePart(np.array(self.lowest), np.array(self.highest), self.levels, self.width)


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
    refinements
        Parts where nodes are finer; the spacing doubles level by level around them.
    """

    lowest: Vector
    highest: Vector
    spacing: Positive
    jitter: Annotated[float, Field(ge=0, le=0.9, allow_inf_nan=False)] = 0.0
    seed: Annotated[int, Field(ge=0)] = 1
    weight: NotNegative = 0.0
    refinements: tuple[Refinement, ...] = ()

    @property
    def finest_spacing(self) -> float:
        """Least distance [m] of nodes."""
        deepest: int = max((part.levels for part in self.refinements), default=0)
        return self.spacing / 2**deepest

    def expected_count(self, dimensions: int) -> int:
        """About how many nodes there will be, at most."""
        axes = (0, 2) if dimensions == 2 else (0, 1, 2)
        count = self._count(np.array(self.lowest), np.array(self.highest), self.spacing, axes)
        for part in self.refinements:
            for depth in range(part.levels):
                away = transition(part.levels, depth, part.width, self.spacing)
                low = np.maximum(np.array(part.lowest) - away, self.lowest)
                high = np.minimum(np.array(part.highest) + away, self.highest)
                cells = self._count(low, high, self.spacing / 2**depth, axes)
                count += cells * (2 ** len(axes) - 1)
        return round(count)

    def holds(self, place: Vector, dimensions: int) -> bool:
        """Whether a place (3,) m lies in the box."""
        axes, slack = (0, 2) if dimensions == 2 else (0, 1, 2), 1e-9 * self.spacing
        return all(self.lowest[d] - slack <= place[d] <= self.highest[d] + slack for d in axes)

    def wrong(self, kinds: Mapping[str, str]) -> list[str]:
        """What does not fit between the box and the kinds of its faces, ``x-`` to ``z+``."""
        mistakes = []
        for axis in dict.fromkeys(face[0] for face in kinds):
            ends = [kinds[axis + side] for side in "-+"]
            if ends.count("periodic") == 1:
                mistakes.append(
                    f"boundaries: both faces across {axis} must be periodic or none; found "
                    f"{' and '.join(ends)}. Say the other."
                )
            k = "xyz".index(axis)
            length = self.highest[k] - self.lowest[k]
            if length < 2.0 * self.spacing:
                mistakes.append(
                    f"box: along {axis} it must be two spacings long at least; found "
                    f"{length:g} m. Correct lowest and highest, or spacing."
                )
        corners = np.array(self.lowest), np.array(self.highest)
        for part in self.refinements:
            if wrong := wrong_part(part.part, corners, self.spacing, kinds):
                mistakes.append(f"box.refinements: {wrong}")
        return mistakes

    @staticmethod
    def _count(low: Array, high: Array, spacing: float, axes: tuple[int, ...]) -> float:
        return float(np.prod([max(1.0, (high[d] - low[d]) / spacing) for d in axes]))


@parameters
class Layers:
    """How a cloud in layers over a wall is divided.

    Parameters
    ----------
    count : 1
        Layers between the wall and the far boundary.
    first_spacing : m
        Thickness of the first; the others grow by one factor. By default all are equal.
    weight : 1
        Of the least squares: 0 for a truncated Gaussian over the distance, else the power p of
        1/dᵖ, of flat and curved layers 2.
    line_stencils
        Whether derivatives are taken along lines of nodes alone: 4 neighbours in the plane, 6 round
        an axis, 8 in space. Without it, with 8, 14 and 20, that along a wall is a mean over three
        layers, which smears boundary layers; jitter needs it.
    jitter : 1
        By how much nodes are moved at random, over the distance of their neighbours.
    seed : 1
        Of the random moves.
    """

    RENAMED: ClassVar = {"first": "first_spacing", "cross": "line_stencils"}
    count: Annotated[int, Field(ge=3)]
    first_spacing: Positive | None = None
    weight: NotNegative = 2.0
    line_stencils: bool = True
    jitter: Annotated[float, Field(ge=0, le=0.9, allow_inf_nan=False)] = 0.0
    seed: Annotated[int, Field(ge=0)] = 1

    def wrong(self, axisymmetric: bool) -> list[str]:
        """What nodes that are moved at random do not go with."""
        mistakes = []
        if self.jitter > 0.0 and not axisymmetric:
            mistakes.append(
                f"layers: jitter is for an axisymmetric sphere; found {self.jitter:g}. Leave it "
                "out."
            )
        if self.jitter > 0.0 and self.line_stencils:
            mistakes.append(
                "layers: jitter moves nodes off the lines along which line_stencils takes "
                f"derivatives; found {self.jitter:g}. Leave it out, or say line_stencils = false."
            )
        return mistakes


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
    points_around : 1
        Nodes along a meridian of the sector; in space nodes of the sphere are as far apart.
    layers
        How the cloud is divided.
    sector : rad
        Widest angle from the direction against the flow; π for the whole sphere.
    margin : 1
        Distance of the last layer from the wall, over that of the shock by Billig's correlation.
    outer_radius : m
        Of the last layer from the centre.
    """

    RENAMED: ClassVar = {"rays": "points_around", "farthest": "outer_radius"}
    SIDES: ClassVar = ("wall", "far", "exit")
    centre: Vector = (0.0, 0.0, 0.0)
    radius: Positive
    points_around: Annotated[int, Field(ge=8)]
    layers: Layers
    sector: Annotated[float, Field(gt=0.2, le=math.pi + 1e-9, allow_inf_nan=False)] = 1.4
    margin: Annotated[float, Field(gt=1, allow_inf_nan=False)] = 1.35
    outer_radius: Positive | None = None

    @property
    def reach(self) -> float:
        """Farthest distance [m] of the last layer from the centre."""
        return 10.0 * self.radius if self.outer_radius is None else self.outer_radius

    @property
    def finest_spacing(self) -> float:
        """Least distance [m] of nodes, of layers as far as the shock of M = 6."""
        even = 0.15 * self.margin * self.radius / self.layers.count
        return even if self.layers.first_spacing is None else self.layers.first_spacing

    def holds(self, place: Vector, dimensions: int) -> bool:
        """Whether a place (3,) m may lie in the layers: they end before the farthest distance."""
        away = math.dist(place, self.centre)
        return (1.0 - 1e-9) * self.radius <= away <= (1.0 + 1e-9) * self.reach

    def wrong(self, stream: Vector, axisymmetric: bool) -> list[str]:
        """What does not fit between the sphere, the stream [m/s] that it stands in and an axis."""
        mistakes = []
        if not stream[0] > 0.0 or any(stream[1:]):
            mistakes.append(
                "boundaries.far: the stream round a sphere must flow along x, from where the "
                f"layers look for its bow shock; found {stream} m/s. Turn the scene so that it "
                "does."
            )
        if axisymmetric and any(self.centre[1:]):
            mistakes.append(
                "sphere: its centre must lie on the axis of symmetry, y = z = 0; found "
                f"{self.centre} m. Move it there."
            )
        if self.outer_radius is not None and not self.outer_radius > self.radius:
            mistakes.append(
                "sphere: outer_radius is of the last layer, from the centre: it must be above "
                f"radius, {self.radius:g} m; found {self.outer_radius:g} m. Raise it."
            )
        return mistakes

    def expected_count(self, dimensions: int) -> int:
        """About how many nodes there will be."""
        surface = float(self.points_around)
        if dimensions == 3:
            surface *= (
                2.0 * math.pi * (1.0 - math.cos(self.sector)) / self.sector**2 * self.points_around
            )
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
    points_along : 1
        Nodes along the plate.
    finest : m
        Distance of nodes at its leading edge; it grows from there to both sides.
    layers
        How the cloud is divided.
    """

    RENAMED: ClassVar = {"rays": "points_along"}
    SIDES: ClassVar = ("wall", "ahead", "inlet", "far", "exit")
    length: Positive
    ahead: Positive
    height: Positive
    points_along: Annotated[int, Field(ge=8)]
    finest: Positive
    layers: Layers

    def holds(self, place: Vector, dimensions: int) -> bool:
        """Whether a place (3,) m lies in the layers."""
        slack = 1e-9 * self.height
        return -slack <= place[2] <= self.height + slack and (
            -self.ahead - slack <= place[0] <= self.length + slack
        )

    @property
    def finest_spacing(self) -> float:
        """Least distance [m] of nodes."""
        even = self.height / self.layers.count
        return min(
            self.finest, even if self.layers.first_spacing is None else self.layers.first_spacing
        )

    def expected_count(self, dimensions: int) -> int:
        """About how many nodes there will be."""
        return (self.points_along + self.points_along // 4) * (self.layers.count + 1)
