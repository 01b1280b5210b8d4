"""What is found by looking over all of the fluid: its totals, and where it failed."""

import math

import numpy as np

from quintet.components.sph_fluid.build import TAIT
from quintet.components.sph_fluid.laws import Fluid
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.state import Array, State
from quintet.interfaces.component import Totals


def totals(state: State, params: SphFluidParams, fluid: Fluid) -> Totals:
    """Mass, momentum and energies of the fluid that is left."""
    mass, rows = fluid.mass * params.thickness, slice(state.fluid)
    points, velocity = state.place[rows, :3], state.motion[rows, :3]
    return Totals(
        mass=mass * len(points),
        momentum=mass * velocity.sum(axis=0),
        angular_momentum=mass * np.cross(points, velocity).sum(axis=0),
        kinetic=0.5 * mass * float(np.einsum("nd,nd->", velocity, velocity)),
        potential=-mass * float((points @ np.array(params.gravity)).sum()),
        internal=mass * float(_elastic(state.place[rows, 3], params, fluid).sum()),
    )


def _elastic(density: Array, params: SphFluidParams, fluid: Fluid) -> Array:
    """∫ p/ρ² dρ from ρ₀ [J/kg]."""
    ratio = density / fluid.density
    if not params.tension:
        ratio = np.maximum(ratio, 1.0)
    power = TAIT - 1
    return np.asarray(
        fluid.stiffness / fluid.density * ((ratio**power - 1.0) / power + 1.0 / ratio - 1.0)
    )


def failure(state: State, params: SphFluidParams, dt: float) -> str:
    """Say which particle a step [s] failed on, and what to do."""
    worst = _worst(state, params.spacing, dt)
    x, y, z, density = state.place[worst].tolist()
    speed = math.hypot(*state.motion[worst, :3].tolist())
    return (
        f"step {state.steps} of {dt:.3g} s: a fluid particle must stay finite, have a positive "
        f"density and move less than a spacing ({params.spacing:.3g} m); particle "
        f"{state.identity[worst]} at ({x:.4g}, {y:.4g}, {z:.4g}) m has {speed:.4g} m/s and "
        f"{density:.4g} kg/m3. Lower courant (now {params.courant}), raise viscosity or "
        "sound_speed, or look for a surface that moves too fast."
    )


def _worst(state: State, spacing: float, dt: float) -> int:
    """Row of the fluid particle that is not finite, or the fastest, or the thinnest."""
    rows = slice(state.fluid)
    place, motion = state.place[rows], state.motion[rows]
    finite = np.isfinite(place).all(axis=1) & np.isfinite(motion).all(axis=1)
    if not finite.all():
        return int(np.argmin(finite))
    speed = np.linalg.norm(motion[:, :3], axis=1)
    fast = float(speed.max()) * dt > spacing
    return int(np.argmax(speed) if fast else np.argmin(place[:, 3]))
