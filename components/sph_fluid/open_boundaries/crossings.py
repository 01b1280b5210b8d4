"""The weight of fluid that goes round in a tank that repeats."""

from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.state import State


def potential_of_crossings(state: State, params: SphFluidParams, mass: float) -> float:
    """Potential energy [J] by which particles are deeper than their places in the tank tell.

    A particle that goes on from the opposite face has fallen by a period along the gravity that
    drives the flow; energy is counted as if it had gone straight on.

    Parameters
    ----------
    mass : float, kg
        Of a particle.
    """
    if not params.boundary.periodic or params.boundary.tank is None:
        return 0.0
    ends = zip(*params.boundary.tank, params.gravity, state.crossings.tolist(), strict=True)
    return -mass * sum((high - low) * g * count for low, high, g, count in ends)
