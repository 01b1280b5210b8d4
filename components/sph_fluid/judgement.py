"""Signs that the results of a fluid are wrong: compression, loss, leaks and energy from nowhere.

A fluid that flows at a Mach number M changes its density by about M² (Monaghan 1994): beyond a few
hundredths it is no longer weakly compressible, and its sound_speed too low. Fluid that leaves the
tank's walls, and kinetic energy that gravity does not bring, are signs of a step that is too long
or of walls that do not hold it.
"""

import numpy as np

from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.setup.geometry import closed_faces, depth
from quintet.components.sph_fluid.state import State
from quintet.interfaces.component import Totals

EVERY = 128  # steps
DENSE = 0.05  # of the density: a Mach number of 0.22
MOST_DENSE = 0.1  # of the fluid
MOST_LOST = 1e-3  # of the fluid
FEWEST = 3  # particles: single drops are let go
MOST_GAINED = 0.05  # of the kinetic energy, or of what gravity holds ready
READY = 0.05  # of m g depth: a fluid at rest is judged by this energy
LEAST_LAYERS = 8  # particles
FLOWING = 0.02  # of m g depth: fluid at rest has less kinetic energy
MOST_ARTIFICIAL = 0.1  # of the kinematic viscosity
# Places in what is remembered.
FIRST, LEAST, GAINED, KINETIC, COMPRESSED, LEAKED, JUDGED = range(7)


def note(state: State, params: SphFluidParams, totals: Totals, isolated: bool) -> None:
    """Take down what the present state shows; `isolated` if nothing outside moves."""
    judged, fluid = state.judged, slice(state.fluid)
    energy = totals.kinetic + totals.potential + totals.internal
    if not judged[JUDGED]:
        judged[FIRST] = judged[LEAST] = energy
    judged[JUDGED] = 1.0
    judged[KINETIC] = max(judged[KINETIC], totals.kinetic)
    if isolated:
        # What was lost is not gained back: a rise counts from the lowest energy before it.
        judged[LEAST] = min(judged[LEAST], energy)
        judged[GAINED] = max(judged[GAINED], energy - judged[LEAST])
    change = state.position_density[fluid, 3] / params.density - 1.0
    if params.negative_pressure:
        change = np.abs(change)
    count = np.count_nonzero(change > DENSE)
    judged[COMPRESSED] = max(judged[COMPRESSED], count / max(state.fluid, 1))
    judged[LEAKED] = max(judged[LEAKED], float(_outside(state, params) + _lost(state, params)))


def _is_open_above_alone(params: SphFluidParams) -> bool:
    """Whether fluid has no way out of the tank but over its rim."""
    edge = params.boundary
    return edge.walls is not None and set(edge.open_faces) <= {"z+"}


def _lost(state: State, params: SphFluidParams) -> int:
    return state.lost if _is_open_above_alone(params) else 0


def _outside(state: State, params: SphFluidParams) -> int:
    """Number of particles beyond a closed face of the tank by more than a spacing."""
    if params.boundary.walls is None or not _is_open_above_alone(params):
        return 0
    (low, high), points = params.boundary.walls, state.position_density[: state.fluid]
    beyond = np.zeros(state.fluid, bool)
    for face in closed_faces(params):
        axis = "xyz".index(face[0])
        if face[1] == "-":
            beyond |= points[:, axis] < low[axis] - params.spacing
        else:
            beyond |= points[:, axis] > high[axis] + params.spacing
    return int(beyond.sum())


def _layers(params: SphFluidParams) -> float:
    """Particles in the lesser of the depth and the longest level extent of the largest box."""
    if not params.fluid:
        return np.inf
    sizes = [np.subtract(high, low) for low, high in params.fluid]
    x, y, z = max(sizes, key=np.prod)
    wide = float(x) if params.dimensions == 2 else float(max(x, y))
    return min(wide, float(z)) / params.spacing


def _of_viscosity(params: SphFluidParams) -> dict[str, str]:
    """Whether artificial viscosity is more than a share of the fluid's own.

    It acts as ν = α h c₀ / (4 (D + 2)) in D dimensions, between particles that near each other
    (Monaghan, Rep. Prog. Phys. 68 (2005) 1703, of both directions twice that).
    """
    viscosity = params.viscosity
    sound = params.smoothing_length * params.sound_speed
    equivalent = viscosity.artificial * sound / (4.0 * (params.dimensions + 2))
    if not 0.0 < MOST_ARTIFICIAL * viscosity.kinematic < equivalent:
        return {}
    return {
        "viscosity": f"viscosity.artificial (now {viscosity.artificial:g}) must be small beside "
        f"the fluid's own; it acts as {equivalent:.2g} m2/s, and viscosity.kinematic is "
        f"{viscosity.kinematic:g} m2/s. Set viscosity.artificial to 0, or lower it."
    }


def warnings(state: State, params: SphFluidParams, mass: float) -> dict[str, str]:
    """Reasons why the results may be wrong, by subject; `mass` [kg] of a particle."""
    judged, texts = state.judged, dict[str, str]()
    if judged[COMPRESSED] > MOST_DENSE:
        texts["compression"] = (
            f"the fluid must keep its density within {DENSE:.0%}; {judged[COMPRESSED]:.0%} of it "
            f"did not, so that its flow is that of a gas. Raise sound_speed (now "
            f"{params.sound_speed:g} m/s) to ten times the largest velocity."
        )
    texts |= _of_viscosity(params)
    leaked, fluid = judged[LEAKED], state.fluid + state.lost
    if leaked > max(MOST_LOST * fluid, FEWEST):
        texts["loss"] = (
            f"the fluid must stay in the tank; {leaked:.0f} of {fluid} particles are beyond its "
            "walls or lost. Lower courant (now "
            f"{params.courant:g}), refine the spacing, raise the walls, or open the faces through "
            "which it shall leave."
        )
    held = mass * fluid * float(np.linalg.norm(params.gravity)) * depth(params)  # J
    layers = _layers(params)
    if layers < LEAST_LAYERS and judged[KINETIC] > FLOWING * held > 0.0:
        texts["resolution"] = (
            f"fluid that flows must be {LEAST_LAYERS} particles or more wide and deep at the "
            f"start; found {layers:.3g}. Refine the spacing."
        )
    ready = READY * held
    scale = max(float(judged[KINETIC]), ready)
    if judged[GAINED] > MOST_GAINED * scale > 0.0:
        texts["energy"] = (
            "the energy of fluid in a tank at rest must not rise; it rose by "
            f"{judged[GAINED]:.3g} J, {judged[GAINED] / scale:.0%} of its largest kinetic energy "
            f"or of {READY:.0%} of m g depth. Lower courant (now {params.courant:g}), or raise "
            "viscosity.artificial or density_diffusion."
        )
    return texts
