"""The numbers of the pair law, from a fluid's parameters."""

import math

from quintet.components.shared.smoothing.smoothing import smoothing
from quintet.components.sph_fluid.laws import (
    Constants,
    ContactPotential,
    DensityDiffusion,
    KinematicViscosity,
    On,
    PairLaw,
    PairTerms,
    WallRepulsion,
)
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.setup.tait import TAIT

# All walls but dynamic ones press as still water does, and would let fast particles by. Within
# NEAREST spacings, which a particle half a spacing off the face does not reach, their particles
# repel: softly beside the fluid's own stiffness, but enough to turn a tenth of the speed of sound.
REPULSION = 0.2
NEAREST = 0.9

NO_DIFFUSION = DensityDiffusion(None, 0.0, 0.0, 0.0, 0.0)
NO_REPULSION = WallRepulsion(None, 0.0, 1.0)
NO_POTENTIAL = ContactPotential(None, None, 0.0, 0.0, 0.0, 0.0, 0.0)


def constants(params: SphFluidParams) -> Constants:
    """Numbers of every fluid."""
    h, dimensions = params.smoothing_length, params.dimensions
    return Constants(
        mass=params.density * params.particle_volume,
        smoothing=smoothing(params.kernel, dimensions, h),
        softening=0.01 * h * h,
        density=params.density,
        stiffness=params.sound_speed**2 * params.density / TAIT,
        lowest=-math.inf if params.negative_pressure else 0.0,
        base=0.0,
    )


def density_diffusion(params: SphFluidParams) -> DensityDiffusion:
    """Numbers of the diffusion of density."""
    if params.density_diffusion == 0.0:
        return NO_DIFFUSION
    sound = params.sound_speed
    x, y, z = (params.density * g / sound**2 for g in params.hydrostatic_gravity)
    strength = 4.0 * params.density_diffusion * params.smoothing_length * sound
    return DensityDiffusion(True, strength, x, y, z)


def kinematic_viscosity(params: SphFluidParams, factor: float = 1.0) -> KinematicViscosity:
    """Numbers of the viscosity of the fluid itself, of which a share acts."""
    kinematic = params.viscosity.kinematic
    on = True if kinematic > 0.0 else None
    if params.viscosity.form == "stress":
        strength = 4.0 * (params.dimensions + 2) * kinematic
        return KinematicViscosity(on, True, strength * factor)
    return KinematicViscosity(on, None, 4.0 * kinematic * factor)


def wall_repulsion(params: SphFluidParams) -> WallRepulsion:
    """Numbers of the repulsion of walls; dynamic ones repel by themselves."""
    if params.boundary.method == "dbc":
        return NO_REPULSION
    mass = params.density * params.particle_volume
    stiffness = REPULSION * (params.sound_speed / params.spacing) ** 2 / mass
    return WallRepulsion(True, stiffness, (NEAREST * params.spacing) ** 2)


def pair_law(
    params: SphFluidParams, contact: ContactPotential = NO_POTENTIAL, own_volume: On = None
) -> PairLaw:
    """Numbers of all terms that a scene asks for."""
    factor = params.boundary.wall_viscosity_factor
    artificial = 2.0 * params.viscosity.alpha * params.sound_speed * params.smoothing_length
    return PairLaw(
        constants=constants(params),
        fluid=PairTerms(
            artificial=artificial,
            viscosity=kinematic_viscosity(params),
            diffusion=density_diffusion(params),
            repulsion=NO_REPULSION,
            contact=NO_POTENTIAL,
            volume=None,
            xsph=True if params.xsph > 0.0 else None,
        ),
        boundary=PairTerms(
            artificial=artificial * factor,
            viscosity=kinematic_viscosity(params, factor),
            diffusion=NO_DIFFUSION,
            repulsion=wall_repulsion(params),
            contact=contact,
            volume=own_volume,
            xsph=None,
        ),
        damper=True if params.acoustic_damper > 0.0 else None,
    )
