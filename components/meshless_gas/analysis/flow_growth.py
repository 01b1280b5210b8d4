"""Largest Courant number at which no disturbance of a scene's flow grows, by its own steps.

    python -m quintet.components.meshless_gas.analysis.flow_growth SCENE.toml [NAME]

The gas of a scene file, with the settings of its limit of stability NAME (the first if not named),
is run by itself at the Courant number that holds. From half of the end of that limit a random
disturbance of all nodes takes linearised steps of another Courant number along that run, with its
boundaries, limiter and shocks: power iteration, which yields the growth of the fastest disturbance.
`flow_limit` takes each node for a lattice: waves that are swept out of the flow, or into a shock,
before they have grown count there.
"""

import math
import sys
from pathlib import Path

import numpy as np

from quintet.components.meshless_gas.analysis.flow_limit import gas_of
from quintet.components.meshless_gas.analysis.von_neumann import GROWTH, TOP
from quintet.components.meshless_gas.component import MeshlessGas
from quintet.interfaces.component import Array, Fields
from quintet.interfaces.errors import StepError

SIZE = 1e-6  # of a disturbance, over density, momentum ρa and energy of its node
STEPS = 150  # of a power iteration; growth is that of the second half
ENORMOUS = 1e30  # times a disturbance, beyond which its iteration ends
ACCURACY = 0.01  # relative, of a limit
LEAST = 0.5  # Courant number from which limits are sought


def largest_courant(gas: MeshlessGas) -> float:
    """Return the largest Courant number at which no disturbance of the flow grows from now on.

    A disturbance counts as growing if it gains more than `GROWTH` a step.
    """
    low, high, saved = LEAST, TOP, gas.save()
    while high - low > ACCURACY * high:
        middle = 0.5 * (low + high)
        gas.load(saved)
        low, high = (middle, high) if growth(gas, middle) <= 1.0 + GROWTH else (low, middle)
    return 0.5 * (low + high)


def growth(gas: MeshlessGas, courant: float) -> float:
    """Return the factor by which a disturbance grows in a step; infinite where no step holds."""
    shape = gas.state.conservative.shape
    disturbance = np.random.default_rng(0).standard_normal(shape) * is_free(gas)
    gained: list[float] = []
    while len(gained) < STEPS and sum(gained) < math.log(ENORMOUS):
        gas.monitor.unsettle()
        flow, dt = gas.save(), courant * gas.scheme.shortest_step
        try:
            change = linear_step(gas, flow, disturbance, dt)
        except StepError:
            return math.inf
        gas.load(flow)
        advance(gas, dt)
        change *= is_free(gas) / scale(gas)
        gained.append(math.log(np.linalg.norm(change) / np.linalg.norm(disturbance)))
        disturbance = change / np.abs(change).max()
    return math.exp(np.mean(gained[len(gained) // 2 :]))


def advance(gas: MeshlessGas, dt: float) -> None:
    """Advance the flow itself by dt [s], in steps at its own Courant number."""
    end = gas.state.time + dt
    while (left := end - gas.state.time) > 1e-9 * dt:
        gas.monitor.unsettle()
        gas.step(left / math.ceil(left / gas.stable_dt() - 1e-9))


def linear_step(gas: MeshlessGas, flow: Fields, disturbance: Array, dt: float) -> Array:
    """Change (n, 5) kg/m3, kg/(m2 s), J/m3 after dt [s] by a disturbance, over its size."""
    gas.load(flow)
    whole, size = disturbance * scale(gas), SIZE / float(np.abs(disturbance).max())
    sides = []
    for sign in (size, -size):
        gas.load(disturbed(flow, sign * whole, gas.params.gas.gamma))
        gas.step(dt)
        sides.append(np.array(gas.state.conservative))
    return (sides[0] - sides[1]) / (2.0 * size)


def disturbed(flow: Fields, change: Array, gamma: float) -> Fields:
    """Saved state of a flow whose conserved quantities differ by a change (n, 5)."""
    conservative, primitive = flow["conservative"] + change, np.array(flow["primitive"])
    rows = np.flatnonzero(change.any(axis=1))
    mass, momentum, energy = np.split(conservative[rows], (1, 4), axis=1)
    kinetic = (momentum**2).sum(axis=1, keepdims=True) / (2.0 * mass)
    primitive[rows] = np.hstack([mass, momentum / mass, (gamma - 1.0) * (energy - kinetic)])
    return {**flow, "conservative": conservative, "primitive": primitive}


def is_free(gas: MeshlessGas) -> Array:
    """1 for each number (n, 5) that steps advance, else 0."""
    free = np.zeros(gas.state.conservative.shape)
    free[gas.motion.domain.inner] = 1.0
    free[:, 2] *= not gas.params.planar
    return free


def scale(gas: MeshlessGas) -> Array:
    """Density, momentum ρa and energy (n, 5) kg/m3, kg/(m2 s), J/m3 of the nodes."""
    gamma = gas.params.gas.gamma
    density, pressure = np.abs(gas.state.primitive[:, [0, 4]]).T
    momentum = np.sqrt(gamma * pressure * density)
    return np.stack([density, *[momentum] * 3, pressure / (gamma - 1.0)], axis=1) + 1e-300


def main(words: list[str]) -> None:
    """Print the limit, for each value of a second parameter."""
    gas, limit = gas_of(Path(words[0]), "".join(words[1:2]))
    for number, value in enumerate(limit.get("against", {}).get("values", [None])):
        gas, _ = gas_of(Path(words[0]), limit["name"], number)
        while gas.state.time < 0.5 * limit["end"] and np.isfinite(dt := gas.stable_dt()):
            gas.step(dt)
        case = "" if value is None else f" at {value:g}"
        print(f"{limit['name']}{case}: {largest_courant(gas):.2f}")


if __name__ == "__main__":
    main(sys.argv[1:])
