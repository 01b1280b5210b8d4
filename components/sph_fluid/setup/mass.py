"""The mass of a fluid: what its particles weigh together is what its boxes hold.

Edges are cut into whole numbers of cells, so that those of a box that is no multiple of the spacing
are not as large as spacing³. All particles have one mass, that of the fluid asked for over their
number. Where boxes are cut differently one of them then has too much and another too little: this
is told above NOTED of the whole, and refused above MOST.
"""

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

from quintet.components.sph_fluid.setup.geometry import cells, named_boxes, named_shapes

if TYPE_CHECKING:
    from quintet.components.sph_fluid.params import SphFluidParams

NOTED, MOST = 0.005, 0.02  # of the mass of all the fluid
EVEN = 1e-9  # of a volume: what differs from it by less is as large
TOLD = 1e-3  # of a mass: smaller differences are not worth a word


class RegionMass(NamedTuple):
    """A box or another shape of fluid."""

    name: str  # in a scene
    volume: float  # m3; m2 in two dimensions
    particles: int


def regions(params: "SphFluidParams") -> Iterator[RegionMass]:
    """All regions of a fluid."""
    for name, box in named_boxes(params):
        edges = [b - a for a, b in zip(*box, strict=True)]
        if params.dimensions == 2:
            edges[1] = 1.0
        yield RegionMass(name, math.prod(edges), math.prod(cells(box, params)))
    if params.shapes:
        # Left out of scenes whose fluid is in boxes.
        from quintet.components.sph_fluid.setup.shape_filling import particle_count

        planar = params.dimensions == 2
        for name, shape in named_shapes(params):
            (_, low, _), (_, high, _) = shape.bounds
            volume = shape.volume / (high - low if planar else 1.0)
            count = particle_count(shape, params.spacing, planar)
            yield RegionMass(name, volume, count)


def particle_volume(params: "SphFluidParams") -> float:
    """Volume [m3] of a particle at rest; area [m2] in two dimensions."""
    nominal = params.spacing**params.dimensions
    parts = list(regions(params))
    share = sum(part.volume for part in parts) / (nominal * sum(part.particles for part in parts))
    return nominal if abs(share - 1.0) < EVEN else nominal * share


def check_mass(params: "SphFluidParams") -> None:
    """Refuse fluid of which a region would not hold what it should."""
    for region, excess in _excesses(params, MOST):
        raise ValueError(
            f"{region.name} must hold its mass of fluid within {100.0 * MOST:g} % of that of all; "
            f"it would differ by {100.0 * excess / region.volume:+.2g} % of its own in "
            f"{region.particles} particles. Choose a spacing of which its edges are multiples, or "
            "a finer one."
        )


def _excesses(params: "SphFluidParams", share: float) -> Iterator[tuple[RegionMass, float]]:
    """Parts that hold more or less than they should [m3] by so much of all the fluid."""
    volume, parts = particle_volume(params), list(regions(params))
    whole = sum(region.volume for region in parts)
    for region in parts:
        excess = region.particles * volume - region.volume
        if abs(excess) > share * whole:
            yield region, excess


def mass_notes(params: "SphFluidParams") -> tuple[str, ...]:
    """Say where particles do not hold what spacing³ would."""
    nominal, volume = params.spacing**params.dimensions, particle_volume(params)
    change = volume / nominal - 1.0
    uneven = tuple(
        f"{region.name} holds {100.0 * excess / region.volume:+.2g} % of its mass more or less "
        "than it should, and others the rest: their edges are cut differently"
        for region, excess in _excesses(params, NOTED)
    )
    if abs(change) < TOLD:
        return uneven
    return (
        f"edges of the fluid are no multiples of the spacing, {params.spacing:g} m: particles of "
        f"density · spacing^{params.dimensions} would hold {-100.0 * change / (1.0 + change):+.2g} "
        f"% of the mass asked for; so the mass of each is changed by {100.0 * change:+.2g} %",
        *uneven,
    )
