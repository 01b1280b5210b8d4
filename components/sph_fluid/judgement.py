"""Signs that the results of a fluid are wrong: compression, loss, leaks and energy from nowhere.

A fluid that flows at a Mach number M changes its density by about M² (Monaghan 1994): beyond a few
hundredths it is no longer weakly compressible, and its sound_speed too low. Fluid that leaves the
tank's walls, and kinetic energy that gravity does not bring, are signs of a step that is too long
or of walls that do not hold it.
"""

import math

import numpy as np

from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.ranks.method import Ranks
from quintet.components.sph_fluid.state import Array, State
from quintet.interfaces.component import Totals

Limit = tuple[float, str]  # and why

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
LEAST_REYNOLDS = 50.0  # at 53 the front of a dam break is 8 % behind, at 30 13 %
LEAST_MACH = 1e-3  # of fluid without gravity: slower, it is at rest
MOST_DAMPED = 0.1  # of a wave's amplitude, in a period
# Decay of standing waves of 40 particles over that of Lamb: Wendland 0.95 at 1.5, 0.93 at 1.4,
# 1.10 at 1.3, 1.55 at 1.2, 1.66 at 1; cubic spline 1.13 at 1.2, 1.39 at 1.3, 1.70 at 1.5; of 20
# particles Wendland 0.95 and quintic spline 1.05 at 1.5.
LEAST_WAVE_SMOOTHING = {"wendland": 1.4, "quintic": 1.5, "cubic": math.inf}
TINY = 1e-300  # kg
# Places in what is remembered.
FIRST, LEAST, GAINED, KINETIC, COMPRESSED, LEAKED, JUDGED, HIGHEST, RELEASED, SHEARED = range(10)


def note(
    state: State, params: SphFluidParams, totals: Totals, isolated: bool, ranks: Ranks
) -> None:
    """Take down what the present state shows; `isolated` if nothing outside moves."""
    judged, fluid = state.judged, slice(state.fluid)
    energy = totals.kinetic + totals.potential + totals.internal
    if not judged[JUDGED]:
        judged[FIRST] = judged[LEAST] = energy
        judged[HIGHEST] = totals.potential
    judged[JUDGED] = 1.0
    judged[KINETIC] = max(judged[KINETIC], totals.kinetic)
    drift = float(totals.momentum @ totals.momentum) / (2.0 * max(totals.mass, TINY))
    judged[SHEARED] = max(judged[SHEARED], totals.kinetic - drift)
    judged[HIGHEST] = max(judged[HIGHEST], totals.potential)
    judged[RELEASED] = max(judged[RELEASED], judged[HIGHEST] - totals.potential)
    if isolated:
        # What was lost is not gained back: a rise counts from the lowest energy before it.
        judged[LEAST] = min(judged[LEAST], energy)
        judged[GAINED] = max(judged[GAINED], energy - judged[LEAST])
    change = state.position_density[fluid, 3] / params.density - 1.0
    if params.negative_pressure:
        change = np.abs(change)
    dense, outside = ranks.count(int((change > DENSE).sum()), _outside(state, params))
    judged[COMPRESSED] = max(judged[COMPRESSED], dense / max(ranks.fluid(state), 1))
    judged[LEAKED] = max(judged[LEAKED], float(outside + _lost(state, params)))


def _is_open_above_alone(params: SphFluidParams) -> bool:
    """Whether fluid has no way out of the tank but over its rim."""
    edge = params.boundary
    return edge.tank is not None and set(edge.open_faces) <= {"z+"}


def _lost(state: State, params: SphFluidParams) -> int:
    return state.lost if _is_open_above_alone(params) else 0


def _outside(state: State, params: SphFluidParams) -> int:
    """Number of particles beyond a closed face of the tank by more than a spacing."""
    if params.boundary.tank is None or not _is_open_above_alone(params):
        return 0
    (low, high), points = params.boundary.tank, state.position_density[: state.fluid]
    is_outside = np.zeros(state.fluid, bool)
    for face in params.closed_faces:
        axis = "xyz".index(face[0])
        if face[1] == "-":
            is_outside |= points[:, axis] < low[axis] - params.spacing
        else:
            is_outside |= points[:, axis] > high[axis] + params.spacing
    return int(is_outside.sum())


def _layers(params: SphFluidParams) -> float:
    """Particles in the lesser of the depth and the longest level extent of the largest box."""
    if not params.boxes:
        return np.inf
    sizes = [np.subtract(high, low) for low, high in params.boxes]
    return _shorter(max(sizes, key=np.prod), params) / params.spacing


def _extent(params: SphFluidParams) -> float:
    """Lesser of the depth and the longest level extent [m] of all the fluid."""
    lows, highs = zip(*params.extents, strict=True)
    return _shorter(np.max(highs, axis=0) - np.min(lows, axis=0), params)


def _shorter(size: Array, params: SphFluidParams) -> float:
    x, y, z = size
    return min(float(x) if params.dimensions == 2 else float(max(x, y)), float(z))


def _equivalent(params: SphFluidParams) -> float:
    """Kinematic viscosity [m2/s] as which artificial viscosity acts.

    It is ν = α h c₀ / (4 (D + 2)) in D dimensions, between particles that near each other
    (Monaghan, Rep. Prog. Phys. 68 (2005) 1703, of both directions twice that).
    """
    sound = params.smoothing_length * params.sound_speed
    return params.viscosity.alpha * sound / (4.0 * (params.dimensions + 2))


def _most_artificial(
    params: SphFluidParams, weight_energy: float, judged: Array, mass: float
) -> Limit:
    """Largest equivalent viscosity [m2/s] that leaves the flow as it is, and why.

    `weight_energy` [J] is m g depth, `mass` [kg] that of all the fluid. No limit
    holds for fluid at rest.
    """
    kinematic = params.viscosity.kinematic
    if kinematic > 0.0:
        return MOST_ARTIFICIAL * kinematic, f"viscosity.kinematic is {kinematic:g} m2/s"
    if params.wave is not None:
        # Lamb 1932, article 348: A falls as exp(-2νk²t).
        number, g = 2.0 * np.pi / params.wave.length, float(np.linalg.norm(params.gravity))
        period = 2.0 * np.pi / params.wave.frequency(params.depth, g)
        limit = MOST_DAMPED / (2.0 * number**2 * period)
        return limit, f"a wave must lose less than {MOST_DAMPED:.0%} of its height in a period"
    speed = float(np.sqrt(2.0 * judged[SHEARED] / mass))
    if weight_energy > 0.0:
        if max(judged[KINETIC], judged[RELEASED]) < FLOWING * weight_energy:
            return np.inf, ""
        speed = max(speed, float(np.sqrt(weight_energy / mass)))
    elif speed < LEAST_MACH * params.sound_speed:
        return np.inf, ""
    extent = _extent(params)
    return (
        speed * extent / LEAST_REYNOLDS,
        f"the Reynolds number of {speed:.3g} m/s and {extent:.3g} m must be {LEAST_REYNOLDS:g} or "
        "more",
    )


def _of_viscosity(
    params: SphFluidParams, weight_energy: float, judged: Array, mass: float
) -> dict[str, str]:
    """Whether artificial viscosity is so large that it changes the flow."""
    equivalent = _equivalent(params)
    limit, reason = _most_artificial(params, weight_energy, judged, mass)
    if equivalent <= limit:
        return {}
    alpha = params.viscosity.alpha
    return {
        "viscosity": f"viscosity.artificial must be small beside what moves or thickens the fluid; "
        f"{alpha:g} acts as {equivalent:.2g} m2/s, and {reason}. Set viscosity.artificial to "
        f"{alpha * limit / equivalent:.2g} or less, or refine the spacing; of a fluid that is as "
        "viscous set viscosity.kinematic, and viscosity.artificial to 0."
    }


def warnings(state: State, params: SphFluidParams, mass: float, ranks: Ranks) -> dict[str, str]:
    """Reasons why the results may be wrong, by subject; `mass` [kg] of a particle."""
    judged, texts = state.judged, dict[str, str]()
    if judged[COMPRESSED] > MOST_DENSE:
        texts["compression"] = (
            f"the fluid must keep its density within {DENSE:.0%}; {judged[COMPRESSED]:.0%} of it "
            f"did not, so that its flow is that of a gas. Raise sound_speed (now "
            f"{params.sound_speed:g} m/s) to ten times the largest velocity."
        )
    leaked, fluid = judged[LEAKED], ranks.fluid(state) + state.lost
    if leaked > max(MOST_LOST * fluid, FEWEST):
        texts["loss"] = (
            f"the fluid must stay in the tank; {leaked:.0f} of {fluid} particles are beyond its "
            "walls or lost. Lower courant (now "
            f"{params.courant:g}), refine the spacing, raise the walls, or open the faces through "
            "which it shall leave."
        )
    weight_energy = mass * fluid * float(np.linalg.norm(params.gravity)) * params.depth  # J
    texts |= _of_viscosity(params, weight_energy, judged, mass * fluid)
    layers = _layers(params)
    if layers < LEAST_LAYERS and judged[KINETIC] > FLOWING * weight_energy > 0.0:
        texts["resolution"] = (
            f"fluid that flows must be {LEAST_LAYERS} particles or more wide and deep at the "
            f"start; found {layers:.3g}. Refine the spacing."
        )
    if params.wave is not None and params.smoothing < LEAST_WAVE_SMOOTHING[params.kernel]:
        least = [f"{name} with {value:g}" for name, value in LEAST_WAVE_SMOOTHING.items()][:2]
        texts["smoothing"] = (
            f"a wave needs kernel and smoothing {' or '.join(least)} or more, or it decays 10 % to "
            f"70 % too fast; found {params.kernel} with {params.smoothing:g}. Set them."
        )
    threshold = READY * weight_energy
    scale = max(float(judged[KINETIC]), threshold)
    if judged[GAINED] > MOST_GAINED * scale > 0.0:
        texts["energy"] = (
            "the energy of fluid in a tank at rest must not rise; it rose by "
            f"{judged[GAINED]:.3g} J, {judged[GAINED] / scale:.0%} of its largest kinetic energy "
            f"or of {READY:.0%} of m g depth. Lower courant (now {params.courant:g}), or raise "
            "viscosity.artificial or density_diffusion."
        )
    return texts
