"""How strong the contact potential is; imported only by a scene that asks.

Between fluid and boundary particles acts (Campbell, Vignjevic & Libersky, Comput. Methods Appl.
Mech. Eng. 184 (2000) 49; Vignjevic, De Vuyst & Campbell, CMES 13 (2006) 35)

    F_i = -Σ_j V_i V_j K n W_ij^(n-1)/W(Δp)^n ∇_iW_ij = -F_j

in place of their part in continuity and pressure: it depends on distance alone, so that walls push
and never pull, and a fluid under a pressure σ comes as near as S(d) = σ/(K Δpᵈ) says, where S is
the pressure between two cubic lattices, d apart, over K Δpᵈ.
"""

import math

import numpy as np

from quintet.components.shared import cubic_spline, wendland
from quintet.components.shared.cubic_spline import SUPPORT
from quintet.components.sph_fluid.laws import Contact, constants
from quintet.components.sph_fluid.params import SphFluidParams

SAFE = 0.2  # of √(m/(∂F/∂d)): the step
FLOW = 0.1  # of the speed of sound, velocity whose ρ₀u² is held at one spacing


def contact(params: SphFluidParams) -> Contact:
    """Numbers of the contact potential."""
    width = constants(params).height * shape(1.0 / params.smoothing, params)  # 1/m3, W(Δp)
    power = params.potential_exponent - 1
    strength = stiffness(params) / params.spacing**params.dimensions * (power + 1) / width
    once, twice, four = (float(power >> bit & 1) for bit in range(3))
    return Contact(strength, 1.0 / width, once, twice, four)


def stiffness(params: SphFluidParams) -> float:
    """K Δpᵈ [Pa]: as given, or what holds ρ₀(c₀/10)² at one spacing."""
    if params.potential_stiffness is not None:
        return params.potential_stiffness
    return params.density * (FLOW * params.sound_speed) ** 2 / held(1.0, params)


def step_limit(params: SphFluidParams) -> float:
    """Largest step [s] that the steepest part of the potential allows."""
    apart = np.linspace(0.0, SUPPORT * params.smoothing, 61)
    push = [push_of_wall(one, params) for one in apart]
    steepest = float(-np.gradient(push, apart).min())
    return SAFE * params.spacing * math.sqrt(params.density / (stiffness(params) * steepest))


def held(apart: float, params: SphFluidParams) -> float:
    """S, the pressure over K Δpᵈ between two lattices so many spacings apart."""
    layers = range(math.ceil(SUPPORT * params.smoothing))
    return sum(push_of_wall(apart + layer, params) for layer in layers)


def push_of_wall(apart: float, params: SphFluidParams) -> float:
    """Force over K Δpᵈ⁺¹ (d dimensions, 3 or 2) on a particle so many spacings before a wall."""
    reach = math.ceil(SUPPORT * params.smoothing)
    line = np.arange(-reach, reach + 1.0)
    axes = [line, line if params.dimensions == 3 else np.zeros(1), apart + np.arange(reach)]
    x, y, z = (axis.ravel() for axis in np.meshgrid(*axes))
    r = np.sqrt(x * x + y * y + z * z)
    r, z = r[r > 0.0], z[r > 0.0]
    h, n = params.smoothing, params.potential_exponent
    width = shape(1.0 / h, params)  # W(Δp) over its scale
    ratio = np.array([shape(one, params) for one in r / h]) / width
    fall = np.array([slope(one, params) for one in r / h]) / h / width
    return float((n * ratio ** (n - 1) * fall * z / r).sum())


def shape(q: float, params: SphFluidParams) -> float:
    """W over its scale, q = r/h."""
    kernel = wendland if params.kernel == "wendland" else cubic_spline
    return float(kernel.shape.py_func(q))


def slope(q: float, params: SphFluidParams) -> float:
    """-dW/dq over the same."""
    if params.kernel == "wendland":
        return 10.0 * q * float(wendland.slope.py_func(q))
    return 3.0 * float(cubic_spline.slope.py_func(q))
