"""The port of surfaces, and which of their samples a contact potential holds."""

from dataclasses import replace

import numpy as np

from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.state import Whole
from quintet.interfaces.component import Fields, Port
from quintet.interfaces.errors import PortError
from quintet.interfaces.ports import CONTACT, MIRRORED_SURFACE, SURFACE


def surface(params: SphFluidParams) -> Port:
    """Port as the boundary asks for it; all but dynamic ones let links choose their contact."""
    port = MIRRORED_SURFACE if params.mirrored else SURFACE
    return port if params.boundary == "dbc" else replace(port, static=(*port.static, CONTACT))


def chosen(static: Fields, params: SphFluidParams) -> Whole:
    """Samples (k,) that the contact potential holds."""
    count = len(static["surface.volume"])
    if params.boundary == "potential":
        return np.arange(count)
    found = np.flatnonzero(static.get("surface.contact", np.zeros(count)))
    if len(found) and params.gaps:
        raise PortError(
            f"surface: contact potential, of {len(found)} of {count} samples, knows no films; "
            "found gaps on. Leave one of the two out."
        )
    return found
