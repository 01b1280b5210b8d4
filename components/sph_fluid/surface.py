"""The port of surfaces, and which of their samples a contact potential holds."""

from dataclasses import replace

import numpy as np

from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.plane import planar_surface
from quintet.components.sph_fluid.state import Whole
from quintet.interfaces.component import Fields, Port
from quintet.interfaces.errors import PortError
from quintet.interfaces.ports import CONTACT, MIRRORED_SURFACE, SURFACE


def surface(params: SphFluidParams) -> Port:
    """Port as the boundary asks for it; it lets links choose their contact where that can be.

    Dynamic boundary particles know no other contact; films know no potential.
    """
    port = MIRRORED_SURFACE if params.mirrored else SURFACE
    if params.dimensions == 2:
        port = planar_surface(port)
    fixed = params.boundary.method == "dbc" or params.boundary.lubrication_films
    return port if fixed else replace(port, static=(*port.static, CONTACT))


def chosen(static: Fields, params: SphFluidParams) -> Whole:
    """Samples (k,) that the contact potential holds."""
    count = len(static["surface.volume"])
    if params.boundary.method == "potential":
        return np.arange(count)
    contact = static.get("surface.contact", np.zeros(count))
    if len(contact) != count:
        raise PortError(
            f"surface.contact must be said of all {count} samples or of none; found "
            f"{len(contact)}. Let every link that brings samples say it."
        )
    return np.flatnonzero(contact)
