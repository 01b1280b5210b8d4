"""What a run of bodies of particles will need: their number, step and time, before any is made."""

import math

from quintet.components.shared.materials.params import material
from quintet.components.sph_solid.body import Body
from quintet.components.sph_solid.filling import computed_shares
from quintet.components.sph_solid.method import method
from quintet.components.sph_solid.params import SphSolidParams
from quintet.interfaces.manifest import Plan

RATE = 8e5  # particles stepped per second and thread
BYTES = 1500.0  # of a particle


def plan(params: SphSolidParams) -> Plan:
    """What a run will need."""
    return Plan(expected_count(params), expected_step(params), RATE, BYTES)


def expected_count(params: SphSolidParams) -> int:
    """About how many particles there will be."""
    if params.axisymmetric:
        extent = sum(_half_plane(body, params) for body in params.bodies)
    else:
        extent = sum(_computed_volume(body, params) for body in params.bodies)
    return max(1, round(extent / params.spacing**params.dimensions))


def expected_step(params: SphSolidParams) -> float:
    """Stable step [s] of the stiffest material at rest."""
    speeds = []
    for body in params.bodies:
        law = material(body.material)
        speeds.append(math.sqrt((law.bulk + 4.0 / 3.0 * law.shear) / law.density))
    drag = 1.2 * method(params).linear
    return params.courant * params.length / ((1.0 + drag) * max(speeds))


def _computed_volume(body: Body, params: SphSolidParams) -> float:
    """Volume [m3] of a body's box that planes of symmetry leave, times the body's share of it."""
    return body.volume(params.dimensions) * math.prod(computed_shares(body, params.symmetry))


def _half_plane(body: Body, params: SphSolidParams) -> float:
    """Area [m2] of a body of rings in the half-plane, that planes of symmetry leave."""
    (low, _, bottom), (high, _, top) = body.bounds
    share = 0.25 * math.pi if body.shape == "sphere" else 1.0
    computed = computed_shares(body, params.symmetry)[2]
    return share * (high - max(low, 0.0)) * (top - bottom) * computed
