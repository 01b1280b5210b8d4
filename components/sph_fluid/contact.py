"""The contact potential between fluid and walls or samples; imported only by a scene that asks.

Boundary particles have no pressure of their own. In its place acts (Campbell, Vignjevic & Libersky,
Comput. Methods Appl. Mech. Eng. 184 (2000) 49; Vignjevic, De Vuyst & Campbell, CMES 13 (2006) 35)

    F_i = -Σ_j V² K_j n W_ij^(n-1)/W(Δp)^n ∇_iW_ij = -F_j,  V = m/ρ₀

which depends on distance alone. Fluid and boundary still count in each other's continuity, and the
fluid's own pressure acts on the boundary. Left out, as those papers have it, the fluid near a wall
does not feel how densely it lies there, and packs by about a third of a spacing more, so that
bodies displace too little. What is left conserves energy: the work of p_i/ρ_i² is what continuity
changes in the fluid, and the rest comes from Σ V² K_j (W_ij/W(Δp))^n and the guard's own potential;
but samples that are placed deeper or higher change their K_j, which no force pays for.

Under a pressure p the fluid comes as near as p = p s(d) + K Δpᵈ S(d) says: S is the pressure
between two cubic lattices, d apart, over K Δpᵈ, and s the share of p that p_i/ρ_i² brings, one half
where d is a spacing, as between the fluid's own planes. K Δpᵈ = (1-s(1))p/S(1) holds p there.

Walls and samples are given it for the pressure that water at rest has where they are, samples anew
whenever they are placed, so that a body that goes deeper is held up there too; with n = 1 the
potential then has the shape of what the fluid lacks at a wall, and its lattice stays at rest. Dry
bodies are given it for the fluid's mean pressure. Dry walls have none: there, and under pressures
that are higher, the guard of mirrored walls (`laws.Guard`) turns the fluid.
"""

import math

import numpy as np
from numba import njit

from quintet.components.shared.numba_options import FAST
from quintet.components.shared.search.neighbours import Lists
from quintet.components.shared.smoothing import cubic_spline, wendland
from quintet.components.shared.smoothing.cubic_spline import SUPPORT
from quintet.components.shared.smoothing.smoothing import kernel
from quintet.components.shared.threads import Team
from quintet.components.sph_fluid.geometry import depth, levels, slab_thickness
from quintet.components.sph_fluid.laws import Contact, Fluid, Guard, constants, guard
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.state import Array, State, Whole

SAFE = 0.2  # of √(m/(∂F/∂d)): the step


def contact(params: SphFluidParams) -> Contact:
    """Numbers of the contact potential."""
    width = constants(params).smoothing.height * shape(
        1.0 / params.smoothing, params
    )  # 1/m3, W(Δp)
    power = params.boundary.potential_exponent - 1
    strength = (power + 1) / (width * params.spacing**params.dimensions)
    once, twice, four = (float(power >> bit & 1) for bit in range(3))
    return Contact(strength, 1.0 / width, once, twice, four)


class Hold:
    """How strongly the potential of one fluid holds walls and samples."""

    def __init__(self, params: SphFluidParams) -> None:
        self.params = params
        self.share = float(stiffness(np.ones(1), params)[0])  # K Δpᵈ over the pressure held
        self.step = limit(1.0, params)  # s √Pa

    def walls(self, state: State) -> float:
        """Hold all walls, before there are samples; return the step limit [s]."""
        rows = np.arange(state.fluid, state.particles)
        self._place(state, rows)
        return self.limit(state, rows)

    def bodies(self, state: State, rows: Whole, body: Array) -> float:
        """Hold samples of bodies (k,), in rows (k,), where they are; return the step limit [s]."""
        self._place(state, rows, body)
        return self.limit(state, rows)

    def _place(self, state: State, rows: Whole, body: Array | None = None) -> None:
        """Write K Δpᵈ/ρ₀² in place of p/ρ²."""
        if self.params.boundary.potential_stiffness is not None:
            held_by = np.full(len(rows), self.params.boundary.potential_stiffness)
        else:
            held_by = self.share * pressure(state.place[rows, :3], self.params, body)
        state.motion[rows, 3] = held_by / self.params.density**2

    def limit(self, state: State, samples: Whole) -> float:
        """Largest step [s] that the steepest part of the potential of all it holds allows.

        Rows of samples (k,); walls are held where the boundary is a potential.
        """
        if self.params.boundary.method == "potential":
            samples = np.arange(state.fluid, state.particles)
        stiffest = self.params.density**2 * float(state.motion[samples, 3].max(initial=0.0))
        return self.step / math.sqrt(stiffest) if stiffest > 0.0 else math.inf


def pressure(points: Array, params: SphFluidParams, body: Array | None = None) -> Array:
    """Pressure (n,) Pa of water at rest at points (n, 3) m of walls, or of bodies (n,).

    It stands as high as the highest fluid does at the start. On bodies that it does not reach it is
    the mean of all the fluid's.
    """
    gravity = params.hydrostatic_gravity
    size = math.hypot(*gravity)
    top = max(levels(box, gravity)[1] for box in params.fluid)  # m, against gravity
    found = np.maximum(params.density * (size * top + points @ np.array(gravity)), 0.0)
    if body is None:
        return np.asarray(found)
    number = body.astype(np.int64)
    dry = np.bincount(number, found) == 0.0
    mean = 0.5 * params.density * size * depth(params)
    return np.where(dry[number], mean, found)


def stiffness(pressures: Array, params: SphFluidParams) -> Array:
    """K Δpᵈ [Pa] that holds pressures (n,) [Pa] at one spacing."""
    return np.asarray(pressures * (1.0 - shared(1.0, params)) / held(1.0, params))


def limit(stiffest: float, params: SphFluidParams) -> float:
    """Largest step [s] where the greatest K Δpᵈ is `stiffest` [Pa]."""
    apart = np.linspace(0.0, SUPPORT * params.smoothing, 61)
    push = [push_of_wall(one, params) for one in apart]
    steepest = float(-np.gradient(push, apart).min())
    return SAFE * params.spacing * math.sqrt(params.density / (stiffest * steepest))


def held(apart: float, params: SphFluidParams, exponent: int | None = None) -> float:
    """S, the pressure over K Δpᵈ between two lattices so many spacings apart."""
    layers = range(math.ceil(SUPPORT * params.smoothing))
    return sum(push_of_wall(apart + layer, params, exponent) for layer in layers)


def shared(apart: float, params: SphFluidParams) -> float:
    """s, the share of the fluid's pressure that its own p_i/ρ_i² brings over so many spacings."""
    numbers = contact(params)
    return held(apart, params, 1) / (numbers.inverse * params.spacing**-params.dimensions)


def push_of_wall(apart: float, params: SphFluidParams, exponent: int | None = None) -> float:
    """Force over K Δpᵈ⁺¹ (d dimensions, 3 or 2) on a particle so many spacings before a wall."""
    reach = math.ceil(SUPPORT * params.smoothing)
    line = np.arange(-reach, reach + 1.0)
    axes = [line, line if params.dimensions == 3 else np.zeros(1), apart + np.arange(reach)]
    x, y, z = (axis.ravel() for axis in np.meshgrid(*axes))
    r = np.sqrt(x * x + y * y + z * z)
    r, z = r[r > 0.0], z[r > 0.0]
    h, n = params.smoothing, exponent or params.boundary.potential_exponent
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


def energy(state: State, near: Lists, touch: Contact, params: SphFluidParams, team: Team) -> float:
    """Energy [J] of the contact potential and of the guard."""
    turn, fluid = guard(params), constants(params)
    held_by = state.motion[:, 3] * (1.0 if touch.some is None else touch.some)
    assert turn is not None
    numbers = (
        touch.inverse,
        params.boundary.potential_exponent,
        params.spacing**-params.dimensions,
    )
    found = np.zeros(state.fluid)
    arrays = (state.place, held_by, near, *numbers, turn, fluid, found)
    team.run(store, state.fluid, *arrays)
    return float(found.sum()) * fluid.mass**2 * slab_thickness(params)


@njit(**FAST)
def store(
    first: int, last: int, place: Array, held_by: Array, near: Lists, inverse: float, exponent: int,
    per_volume: float, guard: Guard, fluid: Fluid, found: Array,
) -> None:  # fmt: skip
    """Write the energy over m² of fluid rows [first, last) with their boundary neighbours."""
    _, middle, end, neighbour = near
    for i in range(first, last):
        total = 0.0
        for k in range(np.uint64(middle[i]), np.uint64(end[i])):
            j = np.uint64(neighbour[k])
            x, y, z = (
                place[i, 0] - place[j, 0],
                place[i, 1] - place[j, 1],
                place[i, 2] - place[j, 2],
            )
            r2 = x * x + y * y + z * z
            total += held_by[j] * per_volume * (kernel(r2, fluid.smoothing) * inverse) ** exponent
            close = max(1.0 - r2 / guard.reach2, 0.0)
            total += 0.25 * guard.stiffness * guard.reach2 * close * close
        found[i] = total
