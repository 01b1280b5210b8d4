"""Glue: particles hang on the faces of a mesh, give it force and mass, and move with it.

Seed: Dyanov, Kazantsev, Chelakov, LOGOS, equations 2 to 4: f_M += φ f_S, M_M += φ m_S,
v_S = Σ φ v_M, with the shape functions φ of the face on which a particle lies at the start.
"""

from collections.abc import Mapping

from quintet.coupler.coupling.exchange import Leg, Ports, Works, requires
from quintet.coupler.coupling.mapping import ShapeMap, project
from quintet.interfaces.component import Array, Fields
from quintet.interfaces.errors import SceneError
from quintet.interfaces.ports import GLUED, GLUED_LOAD, NODE_GLUE, NODE_LOAD

FORCE = ("glued_load.force", "node_load.force")


def join(name: str, between: tuple[str, str], ports: Mapping[str, Ports]) -> "Glue":
    """Match two components: one has glued particles, the other faces with nodes."""
    first, second = between
    complaints = []
    for particles, mesh in ((first, second), (second, first)):
        lacks = requires(ports[particles], particles, GLUED, GLUED_LOAD)
        lacks += requires(ports[mesh], mesh, NODE_LOAD, NODE_GLUE)
        if not lacks:
            return Glue(name, particles, mesh)
        complaints.append("; ".join(lacks))
    raise SceneError(f"link {name}: glue needs: {' or: '.join(complaints)}. Link others.")


class Glue:
    """Forces and masses to nodes, velocities back."""

    def __init__(self, name: str, particles: str, mesh: str) -> None:
        self.name, self.particles, self.mesh = name, particles, mesh
        self.map: ShapeMap
        self.memory = None
        self.partner: dict[str, str] = {}
        self.works: dict[str, Works] = {particles: [("glued_load.force", "glued.velocity", "")]}
        self.legs = [
            Leg(
                particles,
                mesh,
                self._load,
                sums=(FORCE,),
                works_on=(("node_load.force", "node_glue.velocity", "integral"),),
            ),
            Leg(mesh, particles, self._move),
        ]

    def describe(self, described: Mapping[str, Fields]) -> dict[str, dict[str, Array]]:
        """Hang the particles on the faces, and their mass on the nodes."""
        glued, mesh = described[self.particles], described[self.mesh]
        self.map = project(
            glued["glued_load.position"], mesh["node_glue.start"], mesh["node_glue.corner"]
        )
        mass = self.map.spread(glued["glued_load.mass"][:, None])[:, 0]
        return {self.mesh: {"node_load.added_mass": mass}}

    def _load(self, given: Fields) -> dict[str, Array]:
        return {FORCE[1]: self.map.spread(given[FORCE[0]])}

    def _move(self, given: Fields) -> dict[str, Array]:
        return {"glued.velocity": self.map.gather(given["node_glue.velocity"])}
