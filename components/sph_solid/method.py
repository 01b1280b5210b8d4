"""The method of a scene: its own settings, and defaults that suit its materials.

Elastic bodies keep the neighbours of the start: they lose no motion and cannot tear. Bodies that
flow, meet slowly and have no equation of state for shocks get corrected gradients and little
viscosity: with more, Taylor's bar is 0.4 to 0.7 mm too long. Shocks need more.
"""

import math
from typing import NamedTuple

from quintet.components.shared.materials.params import Material, material
from quintet.components.sph_solid.body import Body
from quintet.components.sph_solid.params import SphSolidParams


class Method(NamedTuple):
    """The settings that a scene may leave out."""

    total_lagrangian: bool
    kernel_correction: bool
    linear: float  # α of the artificial viscosity
    quadratic: float  # β


FAST = 0.1  # impacts at more of the speed of longitudinal waves are shocks
LEAST_LINEAR = 0.3  # of shocks: with 0.2 the free surface of `flyer` is 5 % off, with 0 13 %
MOST_LINEAR, MOST_QUADRATIC = 5.0, 500.0  # 10 and 1000: 18 and 9 %
MOST_SLOW = 0.7  # of slow bodies that flow: with 1 the foot of `taylor_bar_sph` is 10 % off
NONE, LITTLE, SHOCKS = (0.0, 0.0), (0.1, 0.5), (1.0, 2.0)  # viscosities


def method(params: SphSolidParams) -> Method:
    """Settings of a scene, and those that suit its materials where it has none."""
    materials = [material(body.material) for body in params.bodies]
    is_plain = not any(law.mie_gruneisen or _may_fail(law) for law in materials)
    is_elastic = is_plain and not any(law.johnson_cook for law in materials)
    is_calm = is_elastic or (is_plain and not is_fast(params))
    total, corrected = params.total_lagrangian, params.kernel_correction
    repels = params.artificial_stress > 0.0
    if total is None:
        total = is_elastic and corrected is None and not (repels or params.axisymmetric)
    if corrected is None:
        corrected = is_calm and not (total or repels)
    linear, quadratic = SHOCKS
    if is_calm and (total or corrected):
        linear, quadratic = NONE if total and is_elastic else LITTLE
    if params.viscosity_linear is not None:
        linear = params.viscosity_linear
    if params.viscosity_quadratic is not None:
        quadratic = params.viscosity_quadratic
    return Method(total, corrected, linear, quadratic)


def is_fast(params: SphSolidParams) -> bool:
    """Whether bodies meet so fast that shocks run through them."""
    slowest = min(_wave(material(body.material)) for body in params.bodies)
    return _impact(params) >= FAST * slowest


def viscosity_warning(params: SphSolidParams) -> str:
    """Why the viscosities do not suit the speed of the impact; empty if they do."""
    total, _, linear, quadratic = method(params)
    usual = "Shocks need about 1 and 2 (viscosity_linear, viscosity_quadratic)"
    values = f"found {linear:g} and {quadratic:g}."
    materials = [material(body.material) for body in params.bodies]
    flows = any(law.johnson_cook for law in materials)
    if is_fast(params) and linear < LEAST_LINEAR and not total:
        return (
            "bodies meet at more than a tenth of the speed of sound, where particles run through "
            f"each other with too little artificial viscosity; {values} {usual}."
        )
    is_slow = not is_fast(params) and _impact(params) > 0.0
    is_plain = not any(law.mie_gruneisen or _may_fail(law) for law in materials)
    most = MOST_SLOW if is_slow and is_plain and flows else MOST_LINEAR
    if linear > most or quadratic > MOST_QUADRATIC:
        return (
            "so much artificial viscosity slows the material and smears its waves; "
            f"{values} {usual}, slower bodies 0.1 and 0.5, elastic ones with total_lagrangian none."
        )
    return ""


def viscosity_note(params: SphSolidParams) -> str:
    """Better settings for a slow impact of a material that flows; empty if these are good."""
    is_chosen = params.viscosity_linear is not None or is_fast(params)
    flows = all(material(body.material).johnson_cook for body in params.bodies)
    if is_chosen or not flows or method(params).linear < SHOCKS[0] or not _impact(params):
        return ""
    return (
        "bodies meet below a tenth of the speed of sound. The viscosities 1 and 2, taken for their "
        "equation of state or law of failure, leave a bar that strikes a wall about 2 % too long; "
        "without shocks viscosity_linear = 0.1, viscosity_quadratic = 0.5 and kernel_correction = "
        "true are better."
    )


def _may_fail(law: Material) -> bool:
    return not (law.spall_stress is None and law.failure_strain is None and law.damage is None)


def _wave(law: Material) -> float:
    """Speed [m/s] of longitudinal waves at rest."""
    return math.sqrt((law.bulk + 4.0 / 3.0 * law.shear) / law.density)


def _impact(params: SphSolidParams) -> float:
    """Greatest speed [m/s] at which bodies begin to meet each other or what stands still."""
    motions = [(0.0, 0.0, 0.0), *(body.velocity for body in params.bodies)]
    fastest = max(math.dist(a, b) for a in motions for b in motions)
    return fastest + max(map(_inner_speed, params.bodies))


def _inner_speed(body: Body) -> float:
    """Greatest speed [m/s] within a body, to its middle, at the start."""
    half = 0.5 * math.dist(*body.bounds)
    return half * (
        math.hypot(*body.angular_velocity) + math.hypot(*sum(body.velocity_gradient, ()))
    )
