"""What a run of bodies of particles will need: their number, step and time, before any is made."""

import math

from quintet.components.shared.materials.params import material
from quintet.components.sph_solid.body import Body
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
        extent = sum(map(_half_plane, params.bodies))
    else:
        extent = sum(_computed_volume(body, params) for body in params.bodies)
    return max(1, round(extent / params.spacing**params.dimensions))


def expected_step(params: SphSolidParams) -> float:
    """Stable step [s] of the stiffest material at rest."""
    speeds = []
    for body in params.bodies:
        law = material(body.material)
        speeds.append(math.sqrt((law.bulk + 4.0 / 3.0 * law.shear) / law.density))
    drag = 1.0 if params.viscosity_linear is None else params.viscosity_linear
    return params.courant * params.length / ((1.0 + 1.2 * drag) * max(speeds))


def _computed_volume(body: Body, params: SphSolidParams) -> float:
    """Volume [m3] of a body's box that planes of symmetry leave, times the body's share of it."""
    volume = body.volume(params.dimensions)
    for plane in params.symmetry:
        k = "xyz".index(plane.axis)
        low, high = body.bounds[0][k], body.bounds[1][k]
        inside = high - plane.position if plane.side == "+" else plane.position - low
        volume *= min(max(inside / (high - low), 0.0), 1.0)
    return volume


def _half_plane(body: Body) -> float:
    """Area [m2] of a body of rings in the half-plane."""
    (low, _, bottom), (high, _, top) = body.bounds
    share = 0.25 * math.pi if body.shape == "sphere" else 1.0
    return share * (high - max(low, 0.0)) * (top - bottom)
