"""Largest Courant number of a scene's flow, by von Neumann's analysis at each of its nodes.

    python -m quintet.components.meshless_gas.analysis.flow_limit SCENE.toml [NAME]

The gas of a scene file, with the settings of its limit of stability NAME (the first if not said),
is run by itself to the end of that limit at the Courant number that holds; each node's neighbours
are then taken for a lattice, and its state, and share of slopes that shocks leave, for those all
over.
"""

import sys
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quintet.components.meshless_gas.analysis.von_neumann import Fluid, Lattice, largest_step
from quintet.components.meshless_gas.component import MeshlessGas
from quintet.components.meshless_gas.laws.fluxes import smoothness
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.components.meshless_gas.viscous.terms import Viscous
from quintet.components.shared.scene_limits import keys_of, scene_at_limit
from quintet.interfaces.component import Array
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import read

Rows = NDArray[np.int32]
Flags = NDArray[np.bool_]
NODES = 250  # that are looked at
SPREAD = 3.0  # times the least bound, beyond which no node limits a step that all take
STILL = 1e-3  # change of the density that counts as none
OFF = 1e-3  # speeds of sound by which velocities are moved off the kinks of the fluxes


def flow_limit(gas: MeshlessGas) -> tuple[float, int]:
    """Return the largest Courant number of a flow as it is now, and the node that limits it."""
    gas.scheme.write_gradients(gas.motion.domain.every)
    bounds = gas.fluxes.bounds
    rows = gas.motion.domain.inner[np.argsort(bounds[gas.motion.domain.inner], kind="stable")]
    least = bounds[rows[0]]
    if not gas.params.local_steps:
        rows = rows[bounds[rows] < SPREAD * least]
    rows = rows[is_disturbed(gas, rows)]
    rows = rows[:: -(-len(rows) // NODES)]
    steps = np.array([longest_step(gas, int(row)) for row in rows])
    steps /= bounds[rows] if gas.params.local_steps else least
    return float(steps.min()), int(rows[steps.argmin()])


def is_disturbed(gas: MeshlessGas, rows: Rows) -> Flags:
    """Whether the gas at nodes is not as it was at the start: what is not has no waves to grow."""
    if gas.params.initial is None:
        return np.ones(len(rows), bool)
    before = gas.params.initial.primitive(gas.params.gas)[0]
    return np.asarray(np.abs(gas.fluxes.primitive[rows, 0] / before - 1.0) > STILL)


def longest_step(gas: MeshlessGas, row: int) -> float:
    """Return the longest stable step [s] of a lattice whose nodes are all as this one."""
    state, gamma = gas.fluxes.primitive[row], gas.params.gas.gamma
    sound = float(np.sqrt(gamma * state[4] / state[0]))
    speed = state[1:4] - (0.0 if gas.motion.frame is None else gas.motion.frame[row])
    near = gas.motion.domain.stencils.neighbours[row]
    arms = gas.motion.domain.cloud.positions[near] - gas.motion.domain.cloud.positions[row]
    apart = (arms != 0.0).any(axis=1)
    arms, coefficients = arms[apart], gas.motion.domain.stencils.coefficients[row][apart]
    lattice = Lattice(  # even: as many and as far on either side
        np.concatenate([arms, -arms]), 0.5 * np.concatenate([coefficients, -coefficients])
    )
    fluid = Fluid(gamma)
    if isinstance(gas.friction, Viscous):
        viscosity = float(gas.friction.transported[row, 1]) / (state[0] * sound)
        fluid = Fluid(gamma, viscosity, gas.params.gas.prandtl)
    moved = speed / sound + OFF * np.array([1.0, 0.0, 0.7])
    return largest_step(lattice, moved, slopes(gas, row, near[apart]), fluid) / sound


def slopes(gas: MeshlessGas, row: int, near: Array) -> float:
    """Share of a node's slopes that shocks leave, mean of its neighbours."""
    if gas.params.order == 1:
        return 0.0
    least, pressure = gas.fluxes.lowest, gas.fluxes.primitive[:, 4]
    shares = [
        smoothness.py_func(least[row], least[j], pressure[row], pressure[j], 0.0) for j in near
    ]
    return float(np.mean(shares))


def gas_of(path: Path, name: str = "", number: int = 0) -> tuple[MeshlessGas, dict[str, Any]]:
    """Make the gas of a scene file as its limit of that name has it; return it, and the limit.

    `number` counts the values of a second parameter.
    """
    scene, limit = scene_at_limit(path, name, number)
    keys = keys_of(scene, "meshless_gas")
    params, mistakes = read(MeshlessGasParams, keys, "gas")
    if mistakes:
        raise SceneError(mistakes[0])
    return MeshlessGas(params), limit


def main(words: list[str]) -> None:
    """Print the limit."""
    gas, limit = gas_of(Path(words[0]), "".join(words[1:2]))
    while gas.state.time < limit["end"] and np.isfinite(dt := gas.stable_dt()):
        gas.step(dt)
    step, row = flow_limit(gas)
    place = np.array2string(gas.motion.domain.cloud.positions[row], precision=3)
    print(f"{limit['name']}: {step:.2f}, by the node at {place} m")


if __name__ == "__main__":
    main(sys.argv[1:])
