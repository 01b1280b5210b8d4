"""Heat: one side holds its wall at the temperature of a mesh, which takes the heat that flows.

Dirichlet and Neumann: temperatures are gathered from the mesh's nodes at the points of the wall,
and the heat that leaves through the wall is spread to the nodes by the transpose, so that joules
close to rounding. The temperature is relaxed from window to window, because the answer to a whole
change of it overshoots where the wall conducts better than the mesh.
"""

from collections.abc import Mapping
from typing import Annotated

import numpy as np
from pydantic import Field

from quintet.coupler.coupling.link import (
    Binding,
    Demands,
    Ends,
    Link,
    Mapped,
    Ports,
    Transfer,
)
from quintet.coupler.coupling.links.keys import Between, with_keys
from quintet.coupler.coupling.links.port_checks import fewest, requires
from quintet.coupler.coupling.links.sampled_structures import OF_POINTS, answered
from quintet.coupler.coupling.mapping import ShapeMap
from quintet.interfaces.component import Fields
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import parameters
from quintet.interfaces.ports import NODE_HEAT, NODE_TEMPERATURE, WALL_HEAT, WALL_TEMPERATURE

HEAT = ("wall_heat.heat_flow", "node_heat.heat_flow")


Factor = Annotated[float, Field(gt=0.0, le=1.0)]


@parameters
class HeatKeys:
    """A wall of points and a mesh share temperature and heat.

    Parameters
    ----------
    between
        The wall and the mesh, in either order.
    relaxation : 1
        Share of the temperature's change that is handed on from window to window: a number, or a
        list for the first windows, of which the last holds for all others. With a steady mesh whose
        resistance is g times that of the wall's side 1/(1 + g) is best, and 2/(1 + g) the limit;
        less averages the noise of particles.
    """

    between: Between
    relaxation: Factor | Annotated[tuple[Factor, ...], Field(min_length=1)] = 1.0


@with_keys(HeatKeys)
def make(name: str, keys: HeatKeys, ports: Mapping[str, Ports]) -> Link:
    """Make a link with its relaxation by window."""
    factors = keys.relaxation if isinstance(keys.relaxation, tuple) else (keys.relaxation,)
    return join(name, keys.between, ports, factors)


def join(
    name: str,
    pair: tuple[str, str],
    ports: Mapping[str, Ports],
    relaxation: tuple[float, ...] = (1.0,),
) -> "Heat":
    """Match two components: one has a wall of points, the other a mesh."""
    complaints = []
    for wall, mesh in (pair, pair[::-1]):
        lacks = requires(ports[wall], wall, WALL_TEMPERATURE, WALL_HEAT)
        lacks += requires(ports[mesh], mesh, NODE_HEAT, NODE_TEMPERATURE)
        if not lacks:
            return Heat(name, wall, mesh, relaxation)
        complaints.append(lacks)
    raise SceneError(f"link {name}: heat needs: {fewest(complaints)}. Link others.")


class Heat(Link):
    """Temperature to the wall, heat to the nodes."""

    def __init__(
        self, name: str, wall: str, mesh: str, relaxation: tuple[float, ...] = (1.0,)
    ) -> None:
        self.name, self.wall, self.mesh, self.relaxation = name, wall, mesh, relaxation
        self.transfers = (
            Transfer(
                mesh,
                wall,
                reads=("node_temperature.temperature",),
                fills=("wall_temperature.temperature",),
            ),
            Transfer(wall, mesh, reads=(HEAT[0],), fills=(HEAT[1],)),
        )

    def demands(self) -> Demands:
        """Any steps; its relaxation is from window to window, so windows are not repeated."""
        if self.relaxation == (1.0,):
            return Demands(settles=True)
        return Demands(
            schemes=("serial", "parallel"),
            relaxation=self.relaxation,
            settles=True,
            reason="its temperature is relaxed from window to window, so windows are not repeated",
        )

    def requests(self, described: Mapping[str, Fields]) -> dict[str, Fields]:
        """On which faces the points of the wall lie."""
        points = described[self.wall]["wall_heat.position"]
        return {self.mesh: {f"{NODE_TEMPERATURE.name}.points": points}}

    def bind(self, described: Mapping[str, Fields]) -> Binding:
        """Share temperature and heat on the faces on which the points of the wall lie."""
        mesh = described[self.mesh]
        samples = answered(self.name, self.mesh, NODE_TEMPERATURE.name, mesh, OF_POINTS)
        nodes = len(mesh["node_temperature.start"])
        shape = ShapeMap(samples[0].astype(np.int64), samples[1], nodes)

        def hold(_: Ends, end: Ends) -> Mapped:
            temperature = end[self.mesh]["node_temperature.temperature"]
            return {
                "wall_temperature.temperature": shape.map_consistent(temperature[:, None])[:, 0]
            }

        def heat(_: Ends, end: Ends) -> Mapped:
            return {HEAT[1]: shape.map_conservative(end[self.wall][HEAT[0]][:, None])[:, 0]}

        return Binding({}, (hold, heat))
