"""Heat: one side holds its wall at the temperature of a mesh, which takes the heat that flows.

Dirichlet and Neumann: temperatures are gathered from the mesh's nodes at the points of the wall,
and the heat that leaves through the wall is spread to the nodes by the transpose, so that joules
close to rounding. The temperature is relaxed from window to window, because the answer to a whole
change of it overshoots where the wall conducts better than the mesh.
"""

from collections.abc import Mapping
from typing import Any

from quintet.coupler.coupling.exchange import (
    Binding,
    Demands,
    Ends,
    Link,
    Mapped,
    Ports,
    Transfer,
    Works,
    requires,
)
from quintet.coupler.coupling.links.keys import between
from quintet.coupler.coupling.mapping import project
from quintet.interfaces.component import Fields
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import shown
from quintet.interfaces.ports import NODE_HEAT, NODE_TEMPERATURE, WALL_HEAT, WALL_TEMPERATURE

HEAT = ("wall_heat.heat_flow", "node_heat.heat_flow")


def make(number: int, given: dict[str, Any], ports: Mapping[str, Ports]) -> Link:
    """Make the link of a scene's table: ``between``, and ``relaxation`` by window.

    The relaxation is a number, or a list of them for the first windows of which the last one
    holds for all the others.
    """
    name, pair = between(number, given, ports, "relaxation")
    asked = given.get("relaxation", 1.0)
    factors = asked if isinstance(asked, list) else [asked]
    if not factors or not all(_is_factor(one) for one in factors):
        raise SceneError(
            f"links.{number}.relaxation must be above 0 and at most 1, a number or a list of them; "
            f"found {shown(asked)}. Lower it if temperatures swing from window to window."
        )
    return join(name, pair, ports, tuple(float(one) for one in factors))


def _is_factor(value: Any) -> bool:
    return type(value) in (int, float) and 0.0 < value <= 1.0


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
        complaints.append("; ".join(lacks))
    raise SceneError(f"link {name}: heat needs: {' or: '.join(complaints)}. Link others.")


class Heat:
    """Temperature to the wall, heat to the nodes."""

    def __init__(
        self, name: str, wall: str, mesh: str, relaxation: tuple[float, ...] = (1.0,)
    ) -> None:
        self.name, self.wall, self.mesh, self.relaxation = name, wall, mesh, relaxation
        self.partner: dict[str, str] = {}
        self.works: dict[str, Works] = {}
        self.transfers = (
            Transfer(
                mesh,
                wall,
                reads=("node_temperature.temperature",),
                fills=("wall_temperature.temperature",),
            ),
            Transfer(wall, mesh, reads=(HEAT[0],), fills=(HEAT[1],), sums=(HEAT,)),
        )

    def demands(self) -> Demands:
        """Any steps; its relaxation is from window to window, so windows are not repeated."""
        if self.relaxation == (1.0,):
            return Demands()
        return Demands(
            schemes=("serial", "parallel"),
            relaxation=self.relaxation,
            reason="its temperature is relaxed from window to window, so windows are not repeated",
        )

    def bind(self, described: Mapping[str, Fields]) -> Binding:
        """Find the faces on which the points of the wall lie."""
        mesh = described[self.mesh]
        shape = project(
            described[self.wall]["wall_heat.position"],
            mesh["node_temperature.start"],
            mesh["node_temperature.corner"],
        )

        def hold(_: Ends, end: Ends) -> Mapped:
            temperature = end[self.mesh]["node_temperature.temperature"]
            return {"wall_temperature.temperature": shape.gather(temperature[:, None])[:, 0]}

        def heat(_: Ends, end: Ends) -> Mapped:
            return {HEAT[1]: shape.spread(end[self.wall][HEAT[0]][:, None])[:, 0]}

        return Binding({}, (hold, heat))
