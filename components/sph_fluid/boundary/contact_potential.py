"""The contact potential between fluid and walls or samples; imported only by a scene that asks.

Boundary particles have no pressure of their own. In its place acts (Campbell, Vignjevic & Libersky,
Comput. Methods Appl. Mech. Eng. 184 (2000) 49; Vignjevic, De Vuyst & Campbell, CMES 13 (2006) 35)

    F_i = -Σ_j V² K_j n W_ij^(n-1)/W(Δp)^n ∇_iW_ij = -F_j,  V = m/ρ₀

which depends on distance alone. Fluid and boundary still count in each other's continuity, and the
fluid's own pressure acts on the boundary. Left out, as those papers have it, the fluid near a wall
does not feel how densely it lies there, and packs by about a third of a spacing more, so that
bodies displace too little. What is left conserves energy: the work of p_i/ρ_i² is what continuity
changes in the fluid, and the rest comes from Σ V² K_j (W_ij/W(Δp))^n and the repulsion's own
potential; but samples that are placed deeper or higher change their K_j, which no force pays for.

Under a pressure p the fluid comes as near as p = p s(d) + K Δpᵈ S(d) says: S is the pressure
between two cubic lattices, d apart, over K Δpᵈ, and s the share of p that p_i/ρ_i² brings, one half
where d is a spacing, as between the fluid's own planes. K Δpᵈ = (1-s(1))p/S(1) holds p there.

Walls and samples are given it for the pressure that water at rest has where they are, samples again
whenever they are placed, so that a body that goes deeper is held up there too; with n = 1 the
potential then has the shape of what the fluid lacks at a wall, and its lattice stays at rest. Dry
bodies are given it for the fluid's mean pressure. Dry walls have none: there, and under pressures
that are higher, the repulsion of walls (`laws.WallRepulsion`) turns the fluid.
"""

import math

import numpy as np

from quintet.components.shared.search.neighbours import Lists
from quintet.components.shared.smoothing import cubic_spline, quintic_spline, wendland
from quintet.components.shared.smoothing.cubic_spline import SUPPORT
from quintet.components.shared.threads import Team
from quintet.components.sph_fluid.boundary.kernels.contact_energy import stored_energy
from quintet.components.sph_fluid.constants import constants, wall_repulsion
from quintet.components.sph_fluid.laws import ContactPotential
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.setup.geometry import levels
from quintet.components.sph_fluid.state import Array, State, Whole

SAFE = 0.2  # of √(m/(∂F/∂d)): the step


def contact_potential(params: SphFluidParams) -> ContactPotential:
    """Numbers of the contact potential, which acts at the whole boundary."""
    # W(Δp), 1/m3
    width = constants(params).smoothing.height * shape(1.0 / params.smoothing, params)
    power = params.boundary.potential_exponent - 1
    strength = (power + 1) / (width * params.spacing**params.dimensions)
    once, twice, four = (float(power >> bit & 1) for bit in range(3))
    return ContactPotential(True, None, strength, 1.0 / width, once, twice, four)


class ContactStiffness:
    """How stiff the contact potential of one fluid is at walls and samples."""

    def __init__(self, params: SphFluidParams) -> None:
        self.params, self.numbers = params, contact_potential(params)
        self.share = float(stiffness(np.ones(1), params)[0])  # K Δpᵈ over the pressure held
        self.step = step_limit(1.0, params)  # s √Pa

    def write(self, state: State, rows: Whole, body: Array | None = None) -> float:
        """Write K Δpᵈ/ρ₀² in place of p/ρ² of rows (k,), of walls or of samples of bodies (k,).

        Returns the largest step [s] that it allows there.
        """
        if self.params.boundary.potential_stiffness is not None:
            stiffness = np.full(len(rows), self.params.boundary.potential_stiffness)
        else:
            places = state.position_density[rows, :3]
            stiffness = self.share * pressure_at_rest(places, self.params, body)
        state.velocity_pressure[rows, 3] = stiffness / self.params.density**2
        return self.limit(state, rows)

    def limit(self, state: State, rows: Whole) -> float:
        """Largest step [s] that the steepest part of the potential at rows (k,) allows."""
        largest = float(state.velocity_pressure[rows, 3].max(initial=0.0))
        stiffest = self.params.density**2 * largest
        return self.step / math.sqrt(stiffest) if stiffest > 0.0 else math.inf

    def energy(self, state: State, lists: Lists, team: Team, mask: Array | float = 1.0) -> float:
        """Energy [J] of the contact potential where the mask (n,) is 1, and of the repulsion."""
        params, fluid = self.params, constants(self.params)
        stiff = state.velocity_pressure[:, 3] * mask
        exponent = params.boundary.potential_exponent
        numbers = (self.numbers.inverse, exponent, params.spacing**-params.dimensions)
        energies = np.zeros(state.fluid)
        laws = (wall_repulsion(params), fluid)
        arrays = (state.position_density, stiff, lists, *numbers, *laws, energies)
        team.run(stored_energy, state.fluid, *arrays)
        return float(energies.sum()) * fluid.mass**2 * params.slab_thickness


def pressure_at_rest(points: Array, params: SphFluidParams, body: Array | None = None) -> Array:
    """Pressure (n,) Pa of water at rest at points (n, 3) m of walls, or of bodies (n,).

    It stands as high as the highest fluid does at the start. On bodies that it does not reach it is
    the mean of all the fluid's.
    """
    gravity = params.hydrostatic_gravity
    size = math.hypot(*gravity)
    top = max(levels(box, gravity)[1] for box in params.extents)  # m, against gravity
    pressures = np.maximum(params.density * (size * top + points @ np.array(gravity)), 0.0)
    if body is None:
        return np.asarray(pressures)
    number = body.astype(np.int64)
    dry = np.bincount(number, pressures) == 0.0
    mean = 0.5 * params.density * size * params.depth
    return np.where(dry[number], mean, pressures)


def stiffness(pressures: Array, params: SphFluidParams) -> Array:
    """K Δpᵈ [Pa] that holds pressures (n,) [Pa] at one spacing."""
    return np.asarray(pressures * (1.0 - fluid_share(1.0, params)) / lattice_pressure(1.0, params))


def step_limit(stiffest: float, params: SphFluidParams) -> float:
    """Largest step [s] where the greatest K Δpᵈ is `stiffest` [Pa]."""
    distance = np.linspace(0.0, SUPPORT * params.smoothing, 61)
    force = [wall_force(place, params) for place in distance]
    steepest = float(-np.gradient(force, distance).min())
    return SAFE * params.spacing * math.sqrt(params.density / (stiffest * steepest))


def lattice_pressure(distance: float, params: SphFluidParams, exponent: int | None = None) -> float:
    """S, the pressure over K Δpᵈ between two lattices so many spacings apart."""
    layers = range(math.ceil(SUPPORT * params.smoothing))
    return sum(wall_force(distance + layer, params, exponent) for layer in layers)


def fluid_share(distance: float, params: SphFluidParams) -> float:
    """s, the share of the fluid's pressure that its own p_i/ρ_i² brings over so many spacings."""
    per_volume = params.spacing**-params.dimensions
    numbers = contact_potential(params)
    return lattice_pressure(distance, params, 1) / (numbers.inverse * per_volume)


def wall_force(distance: float, params: SphFluidParams, exponent: int | None = None) -> float:
    """Force over K Δpᵈ⁺¹ (d dimensions, 3 or 2) on a particle so many spacings before a wall."""
    reach = math.ceil(SUPPORT * params.smoothing)
    line = np.arange(-reach, reach + 1.0)
    across = line if params.dimensions == 3 else np.zeros(1)
    x, y, z = (axis.ravel() for axis in np.meshgrid(line, across, distance + np.arange(reach)))
    r = np.sqrt(x * x + y * y + z * z)
    r, z = r[r > 0.0], z[r > 0.0]
    h, n = params.smoothing, exponent or params.boundary.potential_exponent
    width = shape(1.0 / h, params)  # W(Δp) over its scale
    ratio = np.array([shape(q, params) for q in r / h]) / width
    fall = np.array([slope(q, params) for q in r / h]) / h / width
    return float((n * ratio ** (n - 1) * fall * z / r).sum())


def shape(q: float, params: SphFluidParams) -> float:
    """W over its scale, q = r/h."""
    kernels = {"cubic": cubic_spline, "quintic": quintic_spline, "wendland": wendland}
    return float(kernels[params.kernel].shape.py_func(q))


def slope(q: float, params: SphFluidParams) -> float:
    """-dW/dq over the same."""
    if params.kernel == "wendland":
        return 10.0 * q * float(wendland.slope.py_func(q))
    if params.kernel == "quintic":
        return 15.0 * float(quintic_spline.slope.py_func(q))
    return 3.0 * float(cubic_spline.slope.py_func(q))
