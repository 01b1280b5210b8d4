"""Growth of waves in a step of fluid at rest, by von Neumann's analysis on its lattice.

    python -m quintet.components.sph_fluid.analysis.lattice_limit SCENE.toml [NAME]

prints the value of the parameter of a scene's limit of stability NAME (the first if none is named)
at which some wave begins to grow, by the fluid's own lattice, kernel, viscosity and diffusion.

A wave e^{ik·r} of the lattice has velocity u and density ρ₀(1 + r/c₀); pairs see

    du/dt = i c₀ s r + V u,   dr/dt = i c₀ s·u + D r,   s = Σ V sin(k·r) ∇W,

with V of the viscosities and D of the diffusion of density, and a damper of sound adds
i ζ h c₀ s (s·u) to du/dt. Artificial viscosity acts between what comes nearer: half of the pairs.
Walls, gravity and pressure at rest are left out.
"""

import copy
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np

from quintet.components.shared.scene_limits import keys_of, put, scene_at_limit
from quintet.components.shared.smoothing.smoothing import gradient, smoothing
from quintet.components.sph_fluid.build import OFFSETS
from quintet.components.sph_fluid.features import courant_limit
from quintet.components.sph_fluid.integration.extrapolated import AHEAD
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.interfaces.component import Array
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import read

PHASES = {2: 24, 3: 12}  # between 0 and 2π, of each axis
REACH = 5  # spacings, beyond any kernel's support
GROWTH = 1e-4  # of a wave in a step; one that grows by less is drowned by what walls dissipate
APPROACHING = 0.5  # share of the pairs that artificial viscosity acts between
ACCURACY = 1e-3  # of the limit
SOFTENING = 0.01  # of h², added to r²


class Waves(NamedTuple):
    """What pairs see of waves on a lattice; lengths over the spacing, speeds over c₀."""

    slope: Array  # (k, d) s
    viscosity: Array  # (k, d, d) V
    diffusion: Array  # (k,) D
    damper: float  # ζ h


def waves(params: SphFluidParams) -> Waves:
    """Return the waves of a fluid's lattice."""
    d, h = params.dimensions, params.smoothing
    wave, whole, arms = _lattice(params)
    squares = (arms**2).sum(axis=1)
    is_near = (squares > 0.0) & (squares < (2.0 * h) ** 2)
    whole, arms, squares = whole[is_near], arms[is_near], squares[is_near]
    choice = smoothing(params.kernel, d, h)
    slopes = np.array([gradient.py_func(r2, r2**-0.5, choice) for r2 in squares])
    soft = squares + SOFTENING * h * h
    phases = wave @ whole.T
    difference = 1.0 - np.cos(phases)
    pairs = (slopes / soft)[:, None, None] * arms[:, :, None] * arms[:, None, :]
    along = np.einsum("kj,jab->kab", difference, pairs)
    laplacian = 2.0 * difference @ (slopes * squares / soft)
    kinematic = params.viscosity.kinematic / (params.sound_speed * params.spacing)
    viscosity = APPROACHING * params.viscosity.alpha * h * along
    if params.viscosity.form == "stress":
        viscosity += 2.0 * (d + 2) * kinematic * along
    else:
        viscosity += kinematic * laplacian[:, None, None] * np.eye(d)
    return Waves(
        np.sin(phases) @ (slopes[:, None] * arms),
        viscosity,
        params.density_diffusion * h * laplacian,
        params.acoustic_damper * h,
    )


def _lattice(params: SphFluidParams) -> tuple[Array, Array, Array]:
    """Phases (k, d) of waves, and neighbours (n, d): numbers of cells, and places in spacings."""
    d = params.dimensions
    angles = np.linspace(0.0, 2.0 * np.pi, PHASES[d], endpoint=False)
    wave = np.stack(np.meshgrid(*[angles] * d, indexing="ij"), axis=-1).reshape(-1, d)
    wave = wave[wave[:, -1] <= np.pi][1:]  # those of -k are the same
    counts = np.arange(-REACH, REACH + 1.0)
    whole = np.stack(np.meshgrid(*[counts] * d, indexing="ij"), axis=-1).reshape(-1, d)
    arms = whole.copy()
    if params.staggered:
        arms[:, 0] += whole @ np.array(OFFSETS)[[0, 1, 2] if d == 3 else [0, 2]]
    return wave, whole, arms


def extrapolated(step: float, pairs: Waves) -> Array:
    """Matrices of a step of `integration/extrapolated.py` on (u, r, dr/dt of the last step)."""
    count, d = pairs.slope.shape
    size = d + 2
    rate = np.zeros((count, size), complex)
    rate[:, :d], rate[:, d] = 1j * pairs.slope, pairs.diffusion
    matrix = np.zeros((count, size, size), complex)
    matrix[:, :d, :d] = np.eye(d) + step * pairs.viscosity
    matrix[:, :d, d] = 1j * step * pairs.slope
    matrix[:, d] = step * (1.0 + AHEAD) * rate
    matrix[:, d, d] += 1.0
    matrix[:, d, d + 1] -= step * AHEAD
    matrix[:, d + 1] = rate
    return matrix


def symplectic(step: float, pairs: Waves) -> Array:
    """Matrices of `integration/position_verlet.py` on (u, r, du/dt, dr/dt, dr/dt by the flow)."""
    count, d = pairs.slope.shape
    size = 2 * d + 3
    start = np.repeat(np.eye(size, dtype=complex)[None], count, axis=0)
    velocity, density = start[:, :d], start[:, d : d + 1]
    acceleration, density_rate = start[:, d + 1 : 2 * d + 1], start[:, 2 * d + 1 : 2 * d + 2]
    flow = start[:, 2 * d + 2 :]
    slope = 1j * pairs.slope[:, :, None]

    def force(velocity: Array, density: Array, flow: Array) -> Array:
        return np.asarray(pairs.viscosity @ velocity + slope * (density + pairs.damper * flow))

    middle = density + 0.5 * step * density_rate
    half = velocity + 0.5 * step * acceleration
    velocity = velocity + step * force(half, middle, flow)
    flow = 1j * pairs.slope[:, None, :] @ half
    acceleration = force(velocity, middle, flow)
    flow = 1j * pairs.slope[:, None, :] @ velocity
    density_rate = flow + pairs.diffusion[:, None, None] * middle
    density = middle + 0.5 * step * density_rate
    return np.concatenate([velocity, density, acceleration, density_rate, flow], axis=1)


def growth(params: SphFluidParams) -> float:
    """Largest factor of any wave in a step of a fluid at rest, as long as the solver takes it."""
    scheme = symplectic if params.integration == "symplectic" else extrapolated
    step = courant_limit(params) * params.smoothing
    stiff = params.viscosity.kinematic * (3.0 if params.viscosity.form == "stress" else 1.0)
    if stiff > 0.0:  # as of `component.stable_dt`
        step = min(step, 0.125 * params.smoothing**2 * params.spacing * params.sound_speed / stiff)
    return float(np.abs(np.linalg.eigvals(scheme(step, waves(params)))).max())


def limit(params_at: Callable[[float], SphFluidParams], holds: float, breaks: float) -> float:
    """Bisect a parameter between a value at which no wave grows, and a value at which some does."""
    if growth(params_at(holds)) > 1.0 + GROWTH or growth(params_at(breaks)) <= 1.0 + GROWTH:
        raise SceneError(
            f"from {holds} to {breaks}: no wave may grow at the first value and some must at the "
            "last; found otherwise. Widen the range."
        )
    while abs(breaks - holds) > ACCURACY * abs(breaks):
        middle = 0.5 * (holds + breaks)
        if growth(params_at(middle)) > 1.0 + GROWTH:
            breaks = middle
        else:
            holds = middle
    return 0.5 * (holds + breaks)


def scene_limit(path: Path, name: str = "") -> float:
    """Limit of the parameter of a scene's limit of stability; the first if none is named."""
    scene, table = scene_at_limit(path, name)
    if not isinstance(table["parameter"], str):
        raise SceneError(
            f"{path}: the parameter of {table['name']} must be one key of the fluid; found "
            f"{table['parameter']}. Name another limit."
        )

    def params_at(value: float) -> SphFluidParams:
        varied = copy.deepcopy(scene)
        put(varied, table["parameter"], value)
        params, mistakes = read(SphFluidParams, keys_of(varied, "sph_fluid"), "water", path.parent)
        if mistakes:
            raise SceneError(mistakes[0])
        return params

    return limit(params_at, table["from"], table["to"])


if __name__ == "__main__":
    print(f"{scene_limit(Path(sys.argv[1]), *sys.argv[2:3]):.3g}")
