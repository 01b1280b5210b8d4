"""Largest Courant number at which no wave grows, by von Neumann's analysis on an even lattice.

    python -m quintet.components.meshless_gas.analysis.von_neumann --mach 0.73 --order 1

The Euler equations are linearised about a uniform stream, with the fluxes' derivatives by either
side; a stage of SSP-RK3 multiplies waves of the rate λ by 1 + z + z²/2 + z³/6, z = λ Δt. On its own
that holds to 1.73 of an imaginary λ Δt, and to 2.51 of a real one. A wave counts as one that grows
if a step makes it more than 1 % larger: with neighbours along lines alone, near the speed of sound,
some grow by less in steps of any length, and are swept out.
"""

import argparse
import itertools
import math
from typing import NamedTuple

import numpy as np

from quintet.components.meshless_gas.laws.fluxes import ausmpw
from quintet.interfaces.component import Array

TINY = 1e-6  # over what the fluxes' derivatives are taken
PHASES = 13  # between 0 and π, of each axis
GROWTH = 1e-2  # of a wave in a step; one that grows by less is swept out
TOP = 4.0  # step times the fastest rate, beyond which SSP-RK3 holds nowhere


class Lattice(NamedTuple):
    """Neighbours of a node, the same for all."""

    arms: Array  # (K, 3) m
    coefficients: Array  # (K, 3) 1/m


class Fluid(NamedTuple):
    """Properties of the gas that is linearised; the speed of sound and the density are 1."""

    gamma: float = 1.4
    viscosity: float = 0.0  # Pa s, times 1 m/s and over 1 kg/m3: 1 over the Reynolds number of 1 m
    prandtl: float = 0.72


def block(ratio: float = 1.0) -> Lattice:
    """Eight neighbours, spacings 1 along x and `ratio` along z, with the Gaussian weights."""
    steps = [step for step in itertools.product((-1.0, 0.0, 1.0), repeat=2) if any(step)]
    arms = np.array([(x, 0.0, z * ratio) for x, z in steps])
    distance = np.sqrt((arms**2).sum(axis=1))
    last = math.exp(-4.0)
    weight = (np.exp(-((distance / distance.max()) ** 2)) - last) / distance
    flat = arms[:, ::2]
    moment = np.einsum("k,ka,kb->ab", weight, flat, flat)
    coefficients = np.zeros_like(arms)
    coefficients[:, ::2] = weight[:, None] * flat @ np.linalg.inv(moment)
    return Lattice(arms, coefficients)


def cross(ratio: float = 1.0, turned: float | None = None) -> Lattice:
    """Four neighbours along lines, spacings 1 along x and `ratio` along z.

    Round an axis two more, at the distance `turned` across the plane: what is there is the same.
    """
    ends = [(1.0, 0.0, 0.0), (0.0, 0.0, ratio)]
    ends += [] if turned is None else [(0.0, turned, 0.0)]
    arms = np.array([sign * np.array(end) for end in ends for sign in (1.0, -1.0)])
    return Lattice(arms, 0.5 * arms / (arms**2).sum(axis=1)[:, None])


def flux(left: Array, right: Array, normal: Array, gamma: float) -> Array:
    """Flux (5,) between two states of density, velocity and pressure, along a unit vector."""
    speed = [float(side[1:4] @ normal) for side in (left, right)]
    low = min(left[4], right[4])
    carried = ausmpw.py_func(
        left[0], speed[0], left[4], right[0], speed[1], right[4], low, gamma
    )  # fmt: skip
    flux = np.zeros(5)
    for mass, side in zip(carried[:2], (left, right), strict=True):
        heat = gamma / (gamma - 1.0) * side[4] / side[0] + 0.5 * side[1:4] @ side[1:4]
        flux += mass * np.concatenate([[1.0], side[1:4], [heat]])
    flux[1:4] += carried[2] * normal
    return flux


def derivatives(state: Array, normal: Array, gamma: float) -> tuple[Array, Array]:
    """Derivatives (5, 5) of the flux by the states on its left and on its right."""
    jacobians = np.zeros((2, 5, 5))
    for side, q in itertools.product(range(2), range(5)):
        for sign in (1.0, -1.0):
            both = np.array([state, state])
            both[side, q] += sign * TINY
            jacobians[side, :, q] += sign * flux(both[0], both[1], normal, gamma) / (2.0 * TINY)
    return jacobians[0], jacobians[1]


def to_conservative(state: Array, gamma: float) -> Array:
    """Derivatives (5, 5) of density, momentum and energy by density, velocity and pressure."""
    density, velocity = state[0], state[1:4]
    matrix = np.zeros((5, 5))
    matrix[0, 0] = 1.0
    matrix[1:4, 0], matrix[1:4, 1:4] = velocity, density * np.eye(3)
    matrix[4, 0], matrix[4, 1:4] = 0.5 * velocity @ velocity, density * velocity
    matrix[4, 4] = 1.0 / (gamma - 1.0)
    return matrix


def limit(
    lattice: Lattice, velocity: Array, slopes: float = 1.0, fluid: Fluid | None = None
) -> float:
    """Return the largest Courant number at which no wave of a uniform stream grows.

    It is over 1/Σ_j (|v·c_ij| + a |c_ij| + 2 |c_ij|/|r_ij| max(γ/Pr, 4/3) μ/ρ), the component's own
    bound; parameters as of `largest_step`.
    """
    fluid = fluid or Fluid()
    arms, coefficients = lattice
    size = np.sqrt((coefficients**2).sum(axis=1))
    length = np.sqrt((arms**2).sum(axis=1))
    thermal = 2.0 * fluid.gamma * fluid.viscosity / fluid.prandtl
    spread = max(thermal, 8.0 / 3.0 * fluid.viscosity)
    bound = (np.abs(coefficients @ velocity) + size + spread * size / length).sum()
    return float(bound * largest_step(lattice, velocity, slopes, fluid))


def largest_step(lattice: Lattice, velocity: Array, slopes: float, fluid: Fluid) -> float:
    """Return the largest step [s] at which no wave of a uniform stream grows.

    Parameters
    ----------
    lattice : Lattice
    velocity : (3,) array, speeds of sound
        Of the gas past the nodes; not 0 or 1 along a neighbour, since the fluxes have kinks there.
    slopes : float
        Share of them that is kept: 1 of the scheme of second order, without limiter, 0 of first.
    fluid : Fluid

    References
    ----------
    Hirsch, Numerical Computation of Internal and External Flows (2007), chapters 8 and 9; Shu &
    Osher, J. Comput. Phys. 77 (1988) 439.
    """
    state = np.concatenate([[1.0], velocity, [1.0 / fluid.gamma]])
    arms, coefficients = lattice
    size = np.sqrt((coefficients**2).sum(axis=1))
    sides = [derivatives(state, c / length, fluid.gamma) for c, length in zip(
        coefficients, size, strict=True)]  # fmt: skip
    back = np.linalg.inv(to_conservative(state, fluid.gamma))
    waves = phases(arms)
    whole = np.zeros((len(waves), 5, 5), complex)
    shift = np.exp(1j * (waves @ arms.T))  # (m, K)
    slope = (shift - 1.0) @ coefficients  # of waves of size 1
    for k, (left, right) in enumerate(sides):
        across, along = shift[:, k] - 1.0, slope @ arms[k]
        half = slopes * (along / 3.0 + across / 6.0)  # κ = 1/3
        other = slopes * (along * shift[:, k] / 3.0 + across / 6.0)
        whole -= 2.0 * size[k] * (
            left * half[:, None, None] + right * (across - other)[:, None, None]
        )  # fmt: skip
    if fluid.viscosity:
        for number, wave in enumerate(shift):
            whole[number] += friction(lattice, wave, slope[number], state, fluid)
    return largest(np.linalg.eigvals(back @ whole).ravel())


def phases(arms: Array) -> Array:
    """Phases (m, 3) 1/m of waves in the plane; the others are images of them.

    Along the axes in which the neighbours reach farthest and least.
    """
    _, _, axes = np.linalg.svd(arms[:, ::2], full_matrices=False)
    reach = np.abs(arms[:, ::2] @ axes.T).max(axis=0)
    along = np.linspace(0.0, math.pi, PHASES) / reach[0]
    across = np.linspace(-math.pi, math.pi, 2 * PHASES - 1) / reach[1]
    flat = np.array([(a, b) for a in along for b in across]) @ axes
    return np.stack([flat[:, 0], 0.0 * flat[:, 0], flat[:, 1]], axis=1)


def friction(lattice: Lattice, shift: Array, slope: Array, state: Array, fluid: Fluid) -> Array:
    """Rates (5, 5) of momentum and energy by friction and conduction, of one wave."""
    arms, coefficients = lattice
    matrix = np.zeros((5, 5), complex)
    conduction = fluid.gamma / (fluid.gamma - 1.0) / fluid.prandtl * fluid.viscosity  # of R T
    warmth = np.array([-state[4] / state[0] ** 2, 0.0, 0.0, 0.0, 1.0 / state[0]])  # of R T, too
    square = (arms**2).sum(axis=1)
    for k, (arm, c) in enumerate(zip(arms, coefficients, strict=True)):
        mean = 0.5 * slope * (1.0 + shift[k])
        middle = mean - (mean @ arm - (shift[k] - 1.0)) / square[k] * arm
        middle = middle - slope  # what leaves less what the node has itself
        # c·(∇v + ∇vᵀ - 2/3 ∇·v), by velocities.
        push = middle @ c * np.eye(3) + np.outer(middle, c) - 2.0 / 3.0 * np.outer(c, middle)
        push = 2.0 * fluid.viscosity * push
        matrix[1:4, 1:4] += push
        matrix[4, 1:4] += state[1:4] @ push
        matrix[4] += 2.0 * conduction * (middle @ c) * warmth
    return matrix


def largest(rates: Array) -> float:
    """Return the largest step over whose rates no wave grows by SSP-RK3."""
    low, high = 0.0, TOP / float(np.abs(rates).max())
    while high - low > 1e-3 * high:
        middle = 0.5 * (low + high)
        z = middle * rates
        grown = np.abs(1.0 + z + z * z / 2.0 + z**3 / 6.0).max()
        low, high = (middle, high) if grown <= 1.0 + GROWTH else (low, middle)
    return low


def main() -> None:
    """Print the limit of what the command line tells."""
    add = (parser := argparse.ArgumentParser(description=__doc__)).add_argument
    add("--mach", type=float, nargs="+", default=[0.0], help="of streams; the least limit is told")
    add("--angle", type=float, nargs="+", default=[0.0], help="degrees, to the lattice")
    add("--order", type=int, default=2, choices=(1, 2), help="of the scheme")
    add("--cross", action="store_true", help="neighbours along lines of nodes alone")
    add("--ratio", type=float, nargs="+", default=[1.0], help="spacing across over that along")
    add("--turned", type=float, help="of a cross round an axis: distance of what is turned")
    add("--viscosity", type=float, default=0.0, help="over density, sound speed and spacing")
    add("--prandtl", type=float, default=0.72)
    options = parser.parse_args()
    fluid = Fluid(viscosity=options.viscosity, prandtl=options.prandtl)
    rows = []
    for mach, angle, ratio in itertools.product(options.mach, options.angle, options.ratio):
        turn = math.radians(angle)
        speed = (mach + 1e-3) * np.array([math.cos(turn), 0.0, math.sin(turn)])
        lattice = cross(ratio, options.turned) if options.cross else block(ratio)
        value = limit(lattice, speed, options.order - 1.0, fluid)
        rows.append(value)
        print(f"Mach {mach:g} at {angle:g} degrees, ratio {ratio:g}: {value:.2f}")
    print(f"least: {min(rows):.2f}")


if __name__ == "__main__":
    main()
