"""The numbers of all laws that act between pairs, in the precision that pairs are computed in."""

from dataclasses import dataclass

from quintet.components.sph_fluid.laws import (
    Contact,
    Diffusion,
    Fluid,
    Guard,
    constants,
    diffusion,
    guard,
)
from quintet.components.sph_fluid.params import SphFluidParams


@dataclass(frozen=True, slots=True)
class Terms:
    """None is what a scene leaves out."""

    fluid: Fluid
    diffusion: Diffusion | None
    guard: Guard | None
    contact: Contact | None


def terms(params: SphFluidParams) -> Terms:
    """Numbers of the laws that a scene asks for."""
    touch = None
    if params.boundary == "potential":
        from quintet.components.sph_fluid.contact import contact

        touch = contact(params)
    laws = (constants(params), diffusion(params), guard(params), touch)
    if params.precision == "float32":
        from quintet.components.sph_fluid.single import rounded

        laws = tuple(map(rounded, laws))
    return Terms(*laws)
