"""What a scene leaves open of viscosity, and what is taken for it."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from quintet.components.sph_fluid.params import SphFluidParams


def viscosity_notes(params: "SphFluidParams") -> tuple[str, ...]:
    """Say that there is no artificial viscosity where the fluid's own is given alone."""
    viscosity = params.viscosity
    if viscosity.artificial is not None or not viscosity.kinematic:
        return ()
    return (
        f"viscosity.kinematic is given ({viscosity.kinematic:g} m2/s) and viscosity.artificial is "
        "not: it is 0, so that the fluid is as viscous as it should be",
    )
