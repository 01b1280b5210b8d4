"""What is found by looking over all of the fluid: its totals, and where it failed."""

import math

import numpy as np

from quintet.components.sph_fluid.laws import TAIT, Constants
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.state import Array, State
from quintet.interfaces.component import Totals
from quintet.interfaces.errors import StepError

MACH = 0.5  # of the speed of sound: what strikes the fluid faster is refused
FEW = 1e-3  # of the fluid: so many particles may be denser for no such reason


def totals(state: State, params: SphFluidParams, constants: Constants) -> Totals:
    """Mass, momentum and energies of the fluid that is left."""
    mass, rows = constants.mass * params.slab_thickness, slice(state.fluid)
    points, velocity = state.position_density[rows, :3], state.velocity_pressure[rows, :3]
    return Totals(
        mass=mass * len(points),
        momentum=mass * velocity.sum(axis=0),
        angular_momentum=mass * np.cross(points, velocity).sum(axis=0),
        kinetic=0.5 * mass * float(np.einsum("nd,nd->", velocity, velocity)),
        potential=-mass * float((points @ np.array(params.gravity)).sum()),
        internal=mass * float(_elastic(state.position_density[rows, 3], params, constants).sum()),
    )


def _elastic(density: Array, params: SphFluidParams, constants: Constants) -> Array:
    """∫ p/ρ² dρ from ρ₀ [J/kg]."""
    ratio = density / constants.density
    if not params.negative_pressure:
        ratio = np.maximum(ratio, 1.0)
    power = TAIT - 1
    return np.asarray(
        constants.stiffness / constants.density * ((ratio**power - 1.0) / power + 1.0 / ratio - 1.0)
    )


def failure(state: State, params: SphFluidParams, dt: float) -> str:
    """Say which particle a step [s] failed on, and what to do."""
    worst = _worst(state, params.spacing, dt)
    x, y, z, density = state.position_density[worst].tolist()
    speed = math.hypot(*state.velocity_pressure[worst, :3].tolist())
    return (
        f"step {state.steps} of {dt:.3g} s: a fluid particle must stay finite, have a positive "
        f"density and move less than a spacing ({params.spacing:.3g} m); particle "
        f"{state.identity[worst]} at ({x:.4g}, {y:.4g}, {z:.4g}) m has {speed:.4g} m/s and "
        f"{density:.4g} kg/m3. Lower courant (now {params.courant}), raise viscosity.artificial or "
        "sound_speed, or look for a surface that moves too fast."
    )


def _worst(state: State, spacing: float, dt: float) -> int:
    """Row of the fluid particle that is not finite, or the fastest, or the thinnest."""
    rows = slice(state.fluid)
    position, velocity = state.position_density[rows], state.velocity_pressure[rows]
    finite = np.isfinite(position).all(axis=1) & np.isfinite(velocity).all(axis=1)
    if not finite.all():
        return int(np.argmin(finite))
    speed = np.linalg.norm(velocity[:, :3], axis=1)
    fast = float(speed.max()) * dt > spacing
    return int(np.argmax(speed) if fast else np.argmin(position[:, 3]))


def refuse_dense(state: State, params: SphFluidParams) -> None:
    """Raise where the fluid was struck faster than a weakly compressible one can be.

    A surface that meets it with a velocity u raises its pressure by ρ₀c₀u, whatever moves: that of
    u = c₀/2 is a density that nothing slower reaches. Single drops of spray that walls squeeze are
    let go.
    """
    density = state.position_density[: state.fluid, 3]
    worst = int(np.argmax(density))
    most = params.density * (1.0 + TAIT * MACH) ** (1.0 / TAIT)
    if not density[worst] > most or np.count_nonzero(density > most) <= FEW * len(density):
        return
    raise StepError(
        f"step {state.steps}: what strikes the fluid must be slower than half its sound_speed "
        f"({MACH * params.sound_speed:.3g} m/s), a tenth to be right, so that its density stays "
        f"below {most:.4g} kg/m3; {_met(state, worst)} Raise sound_speed to ten times the largest "
        "velocity, or slow what moves."
    )


def _met(state: State, worst: int) -> str:
    x, y, z, density = state.position_density[worst].tolist()
    speed = math.hypot(*state.velocity_pressure[worst, :3].tolist())
    fastest = float(np.linalg.norm(state.velocity_pressure[:, :3], axis=1).max())
    return (
        f"particle {state.identity[worst]} at ({x:.4g}, {y:.4g}, {z:.4g}) m has {density:.4g} "
        f"kg/m3 and {speed:.3g} m/s, and the fastest of all, surfaces too, {fastest:.3g} m/s."
    )
