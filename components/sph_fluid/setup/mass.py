"""The mass of a fluid: what its particles weigh together is what its regions hold.

Edges are cut into whole numbers of cells, so that those of a box that is no multiple of the spacing
are not as large as spacing³. All particles have one mass, that of the fluid asked for over their
number. Where boxes are cut differently, some then have too much mass and others too little: above
NOTED of the whole a note says so, above MOST the scene is refused.
"""

import math
from collections.abc import Iterator
from typing import NamedTuple

from quintet.components.sph_fluid.setup.geometry import cells
from quintet.components.sph_fluid.setup.shapes import Fluid, FluidRegion, named_boxes, named_shapes

NOTED, MOST = 0.005, 0.02  # of the mass of all the fluid
EVEN = 1e-9  # of a volume: what differs from it by less is as large
TOLD = 1e-3  # of a mass: smaller differences are not worth a word


class RegionMass(NamedTuple):
    """A box or another shape of fluid."""

    name: str  # in a scene
    volume: float  # m3; m2 in two dimensions
    particles: int


def region_masses(fluid: Fluid, spacing: float, dimensions: int) -> Iterator[RegionMass]:
    """All regions of a fluid."""
    for name, box in named_boxes(fluid):
        edges = [b - a for a, b in zip(*box, strict=True)]
        if dimensions == 2:
            edges[1] = 1.0
        yield RegionMass(name, math.prod(edges), math.prod(cells(box, spacing, dimensions)))
    for name, shape in named_shapes(fluid):
        yield _shape_mass(name, shape, spacing, dimensions == 2)


def _shape_mass(name: str, shape: FluidRegion, spacing: float, planar: bool) -> RegionMass:
    # Left out of scenes whose fluid is in boxes.
    from quintet.components.sph_fluid.setup.shape_filling import particle_count

    (_, low, _), (_, high, _) = shape.bounds
    volume = shape.volume / (high - low if planar else 1.0)
    return RegionMass(name, volume, particle_count(shape, spacing, planar))


def particle_volume(fluid: Fluid, spacing: float, dimensions: int) -> float:
    """Volume [m3] of a particle at rest; area [m2] in two dimensions."""
    nominal = spacing**dimensions
    regions = list(region_masses(fluid, spacing, dimensions))
    volume = sum(region.volume for region in regions)
    share = volume / (nominal * sum(region.particles for region in regions))
    return nominal if abs(share - 1.0) < EVEN else nominal * share


def check_mass(fluid: Fluid, spacing: float, dimensions: int) -> None:
    """Refuse fluid of which a region would not hold what it should."""
    for region, excess in _excesses(fluid, spacing, dimensions, MOST):
        raise ValueError(
            f"{region.name} must hold its mass to within {100.0 * MOST:g} % of the mass of all "
            f"fluid; its {region.particles} particles would hold {_much(excess / region.volume)} "
            "mass. Choose a spacing of which its edges are multiples, or a finer one."
        )


def _excesses(
    fluid: Fluid, spacing: float, dimensions: int, share: float
) -> Iterator[tuple[RegionMass, float]]:
    """Regions that hold more or less than they should [m3] by so much of all the fluid."""
    volume = particle_volume(fluid, spacing, dimensions)
    regions = list(region_masses(fluid, spacing, dimensions))
    whole = sum(region.volume for region in regions)
    for region in regions:
        excess = region.particles * volume - region.volume
        if abs(excess) > share * whole:
            yield region, excess


def mass_notes(fluid: Fluid, spacing: float, dimensions: int) -> tuple[str, ...]:
    """Say where particles do not hold what spacing³ would."""
    change = particle_volume(fluid, spacing, dimensions) / spacing**dimensions - 1.0
    uneven = tuple(
        f"{region.name} holds {_much(excess / region.volume)} mass, and other regions make up for "
        "it: the spacing divides their edges differently"
        for region, excess in _excesses(fluid, spacing, dimensions, NOTED)
    )
    if abs(change) < TOLD:
        return uneven
    return (
        f"the fluid's edges are not multiples of the spacing ({spacing:g} m), so particles of "
        f"density · spacing^{dimensions} would hold {_much(-change / (1.0 + change))} mass; the "
        f"mass of each was {'raised' if change > 0.0 else 'lowered'} by {100.0 * abs(change):.2g} "
        "%",
        *uneven,
    )


def _much(excess: float) -> str:
    """Text of a share by which there is too much, or below 0 too little."""
    return f"{100.0 * abs(excess):.2g} % too {'much' if excess > 0.0 else 'little'}"
