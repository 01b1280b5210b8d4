"""Longest stable step of a structure at rest: 2/ω of its fastest mode, by its own forces.

    python -m quintet.components.fe_plate.analysis.longest_step SCENE.toml [NAME [NUMBER]]

prints 2/ω [s] of the structure in a scene file, and its ratio to the proven bound. This ratio is
the largest stable `courant`. The structure has the settings of the scene's limit of stability NAME
(the first if none is named), with value NUMBER (from 0) of its second parameter. Damping, loads,
walls and erosion are off, and there is no partner.

The forces of a step of small displacements u are -K u; Lanczos's method finds the largest
eigenvalue ω² of M^-½ K M^-½ from such steps alone.
"""

import math
import sys
from pathlib import Path

import numpy as np
from scipy.sparse.linalg import LinearOperator, eigsh

from quintet.components.fe_plate.component import FePlate
from quintet.components.fe_plate.params import FePlateParams
from quintet.components.shared.scene_limits import keys_of, scene_at_limit
from quintet.interfaces.component import Array
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import read

UNDAMPED_AND_UNLOADED = {
    "gravity": [0.0, 0.0, 0.0], "pressures": [], "rigid_walls": [], "erosion": [],
    "viscosity_linear": 0.0, "viscosity_quadratic": 0.0, "mass_damping": 0.0,
    "stiffness_damping": 0.0,
}  # fmt: skip
DISPLACEMENT = 1e-6  # of the shortest edge, at most
STEP = 1e-3  # of the proven bound: the step that makes the displacement
TOLERANCE = 1e-6  # of ω²


def structure_of(path: Path, name: str = "", number: int = 0) -> FePlate:
    """Make the structure with the settings of a limit, without damping and loads."""
    scene, _ = scene_at_limit(path, name, number)
    keys = keys_of(scene, "fe_plate") | UNDAMPED_AND_UNLOADED
    params, mistakes = read(FePlateParams, keys, "structure", path.parent)
    if mistakes:
        raise SceneError(mistakes[0])
    return FePlate(params)


def greatest_frequency(structure: FePlate) -> float:
    """ω [rad/s] of the fastest mode of a structure on one rank; its state is restored.

    Parameters
    ----------
    structure : FePlate
        At rest, without loads and damping.
    """
    before, free = structure.save(), structure.model.free.astype(np.float64)
    root = np.sqrt(structure.model.inverse_mass)[:, None] * free  # 1/√kg
    still = structure.state.internal.copy()
    dt = STEP * structure.bound

    def product(vector: Array) -> Array:
        motion = root * vector.reshape(root.shape)
        scale = DISPLACEMENT * structure.built.shortest / np.abs(motion).max()
        structure.load(before)
        structure.state.velocity[:] = scale / dt * motion
        structure.step(dt)
        return (root * (still - structure.state.internal) / scale).ravel()

    operator = LinearOperator((root.size, root.size), matvec=product, dtype=np.float64)
    start = np.random.default_rng(0).normal(size=root.size) * free.ravel()
    squares = eigsh(operator, 1, which="LA", v0=start, return_eigenvectors=False, tol=TOLERANCE)
    structure.load(before)
    return math.sqrt(squares[0])


def main(path: str, name: str = "", number: str = "0") -> None:
    """Print the longest step of a scene's structure."""
    structure = structure_of(Path(path), name, int(number))
    step = 2.0 / greatest_frequency(structure)
    print(f"{step:.4g} s, {step / structure.bound:.4g} times the proven bound")


if __name__ == "__main__":
    main(*sys.argv[1:])
