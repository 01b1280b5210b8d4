"""Fluid and structure: surface samples move with bodies or faces, whose loads they map back.

The fluid takes samples and gives a force on each; it never learns what moves them. Whoever moves a
surface says where its samples are; it never learns who asked. `contact` says what
presses between the fluid and the samples of this link: what does at the fluid's walls, or a contact
potential, of a fluid whose port asks for it.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Literal

from quintet.coupler.coupling.link import (
    Binding,
    Demands,
    Link,
    Ports,
    Transfer,
)
from quintet.coupler.coupling.links.keys import Between, with_keys
from quintet.coupler.coupling.links.port_checks import refuse_other_dimensions, requires
from quintet.coupler.coupling.links.sampled_structures import (
    FACES_OF_A_MESH,
    RIGID_BODIES,
    Sampling,
    Structure,
    request,
)
from quintet.interfaces.component import Fields, Port
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import parameters
from quintet.interfaces.ports import (
    FACES,
    MIRRORED_SURFACE,
    MOTION,
    SURFACE,
    SURFACE_LOAD,
)

# Static field of a fluid that lets links choose: 1 where a contact potential presses on a sample.
CONTACT = "contact"


@parameters
class FsiKeys:
    """A fluid meets rigid bodies, or the faces of a mesh.

    Parameters
    ----------
    between
        The fluid and the structure, in either order.
    contact
        What presses between the fluid and this structure: what does at the fluid's walls, or a
        contact potential, of a fluid with mirrored walls.
    """

    between: Between
    contact: Literal["walls", "potential"] = "walls"


@with_keys(FsiKeys)
def make(name: str, keys: FsiKeys, ports: Mapping[str, Ports]) -> Link:
    """Make a link, with the contact that it asks for."""
    return join(name, keys.between, ports, keys.contact == "potential")


def join(
    name: str, pair: tuple[str, str], ports: Mapping[str, Ports], potential: bool = False
) -> "Fsi":
    """Match two components: one samples a surface, the other moves bodies or faces.

    With `potential` the fluid is asked to press on the samples by a contact potential.
    """
    first, second = pair
    for fluid, body in ((first, second), (second, first)):
        takes = {port.name for port in ports[fluid][0]}
        gives = {port.name for port in ports[body][1]}
        if SURFACE.name not in takes or not gives & {MOTION.name, FACES.name}:
            continue
        structure = RIGID_BODIES if MOTION.name in gives else FACES_OF_A_MESH
        motion, load = structure.motion, structure.load
        lacks = requires(ports[fluid], fluid, MIRRORED_SURFACE, SURFACE_LOAD)
        # What is moved by a path or a recording takes no load, and is sent none.
        loaded = load.name in {port.name for port in ports[body][0]}
        lacks += requires(ports[body], body, load if loaded else None, motion)
        if lacks:
            raise SceneError(f"link {name}: {'; '.join(lacks)}. Correct the ports.")
        surface = next(port for port in ports[fluid][0] if port.name == SURFACE.name)
        mirrored = any(field.name == "mirror" for field in surface.fields)
        moving = next(port for port in ports[body][1] if port.name == motion.name)
        refuse_other_dimensions(name, {fluid: surface, body: moving})
        contact = _contact(name, fluid, surface, potential)
        return Fsi(Sampling(name, fluid, body, mirrored, contact), structure, loaded)
    raise SceneError(
        f"link {name}: fsi needs a component that takes surface and gives surface_load, and one "
        f"that gives motion and takes load, or gives faces and takes node_load; {first} takes "
        f"{_names(ports[first][0])} and gives {_names(ports[first][1])}, {second} takes "
        f"{_names(ports[second][0])} and gives {_names(ports[second][1])}. Link others."
    )


def _contact(name: str, fluid: str, surface: Port, potential: bool) -> float | None:
    """Code of what presses on the samples, for a fluid that lets its links choose it."""
    if any(field.name == CONTACT for field in surface.static):
        return float(potential)
    if potential:
        raise SceneError(
            f"link {name}: contact potential needs a fluid that lets links choose their contact; "
            f"port {surface.name} of {fluid} does not say {CONTACT}. Remove contact, or "
            f"choose a boundary of {fluid} that does, without films."
        )
    return None


def _names(ports: tuple[Port, ...]) -> str:
    return ", ".join(port.name for port in ports) or "nothing"


class Fsi(Link):
    """Samples ride on a structure, and their forces become loads on it."""

    def __init__(self, sampling: Sampling, structure: Structure, loaded: bool) -> None:
        self.sampling, self.structure = sampling, structure
        self.name, fluid, body = sampling.link, sampling.fluid, sampling.body
        move = Transfer(body, fluid, reads=structure.reads, fills=_sampled(sampling.mirrored))
        load = Transfer(
            fluid,
            body,
            reads=("surface_load.force",),
            fills=structure.fills,
            needs=structure.needs,
        )
        self.transfers = (move, load) if loaded else (move,)

    def demands(self) -> Demands:
        """Any steps and schemes; fluids that sample surfaces are compressible, if only weakly."""
        return Demands(by_sound=True)

    def requests(self, described: Mapping[str, Fields]) -> dict[str, Fields]:
        """Samples of the surface, as the fluid asks for them."""
        stated = described[self.sampling.fluid]
        return {self.sampling.body: request(self.sampling, self.structure.motion.name, stated)}

    def bind(self, described: Mapping[str, Fields]) -> Binding:
        """Let the samples of the surface ride on what moves it."""
        binding = self.structure.bind(self.sampling, described[self.sampling.body])
        count = len(self.transfers)
        return replace(binding, maps=binding.maps[:count], moment=binding.moment[:count])


def _sampled(mirrored: bool) -> tuple[str, ...]:
    """Inputs of a fluid whose surface samples are moved."""
    moved = ("surface.position", "surface.velocity")
    return (*moved, "surface.mirror") if mirrored else moved
