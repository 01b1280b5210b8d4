"""A lattice from its parameters: points, bonds, pair force, highest frequency."""

import math
from typing import NamedTuple

import numpy as np

from quintet.components.particle_dynamics.coefficients import ForceTable, SevenRoots
from quintet.components.particle_dynamics.kernels.stiffness import highest_eigenvalue, tridiagonal
from quintet.components.particle_dynamics.laws import force as pair_force
from quintet.components.particle_dynamics.neighbours import SKIN, pairs_within
from quintet.components.particle_dynamics.params import Lattice, ParticleLatticeParams
from quintet.components.particle_dynamics.potential import (
    force_table,
    highest_frequency,
    seven_roots,
    stiffness,
)
from quintet.components.particle_dynamics.state import Model, State, Whole
from quintet.components.shared.search.nearest import nearest_rows
from quintet.interfaces.component import Array
from quintet.interfaces.errors import SceneError

Law = SevenRoots | ForceTable
LARGEST = 2000  # points; the highest frequency of larger lattices is that of the infinite one
KRYLOV = 150  # steps of Lanczos
CLOSE = 1.0 - 1e-9  # of a cut-off: a shell at the cut-off is outside


class Built(NamedTuple):
    """Points and their pair force."""

    start: Array  # (n, 3) m
    period: Array | None  # (6,) m and 1/m, lengths of periodic sides and inverses; None: open
    law: Law
    frequency: float  # rad/s, the highest of the bonds
    bonds: Whole  # (b, 2) of nearest points
    frozen: Whole  # (f,) points


def lattice_cells(lattice: Lattice) -> Whole:
    """Places (n, 3) of the points in spacings, counted along z first."""
    axes = [np.arange(count) for count in lattice.points]
    return np.stack(np.meshgrid(*axes, indexing="ij"), -1).reshape(-1, 3)


def lattice_points(lattice: Lattice) -> Array:
    """Positions (n, 3) m, counted along z first."""
    return np.array(lattice.lowest) + lattice.spacing * lattice_cells(lattice)


def place_at_start(lattice: Lattice, point: int) -> Array:
    """Position (3,) m of a point at the start."""
    return np.array(lattice.lowest) + lattice.spacing * np.array(
        np.unravel_index(point, lattice.points)
    )


def build(params: ParticleLatticeParams) -> Built:
    """Build a lattice."""
    lattice = params.lattice
    start = lattice_points(lattice)
    period = _period(lattice)
    frozen = np.unique(nearest_rows(start, params.frozen))
    law, frequency = _law(params, start, period, frozen)
    _require_long_sides(lattice, law)
    bonds = _bonds(start, 1.1 * lattice.spacing, np.array(lattice.lowest), period)
    return Built(start, period, law, frequency, bonds, frozen)


def initial_state(
    params: ParticleLatticeParams, start: Array, model: Model, temperature: Array
) -> State:
    """Points at their places, with random velocities if they are warm; baths (b,) K."""
    lattice, count = params.lattice, len(start)
    damped = count if params.damping is not None and params.damping.coefficient > 0.0 else 0
    random = np.random.default_rng(params.seed)
    width = math.sqrt(2.0 * params.boltzmann * lattice.temperature / lattice.mass)
    velocity = width * random.normal(size=(count, 3))
    velocity[model.frozen] = 0.0
    if not len(model.frozen):
        velocity -= velocity.mean(axis=0)
    return State(
        position=start.copy(),
        velocity=velocity,
        acceleration=np.zeros((count, 3)),
        listed=start.copy(),
        kinetic=np.zeros(count),
        temperature=temperature.copy(),
        heat=np.zeros(len(temperature)),
        flow=np.zeros(len(temperature)),
        lost=np.zeros(damped),
        dissipated=np.zeros(damped),
        energies=np.zeros(4),
        generator=np.array([params.seed], np.uint64),
    )


def _period(lattice: Lattice) -> Array | None:
    if not lattice.periodic:
        return None
    sides = zip("xyz", lattice.cells, strict=True)
    length = [n * lattice.spacing if axis in lattice.periodic else 0.0 for axis, n in sides]
    return np.array([*length, *(1.0 / side if side else 0.0 for side in length)])


def _require_long_sides(lattice: Lattice, law: Law) -> None:
    """Refuse periodic sides so short that a point may meet another and its image."""
    reach = (1.0 + SKIN) * math.sqrt(law.cutoff2)  # m
    for axis, count in zip("xyz", lattice.cells, strict=True):
        length = count * lattice.spacing  # m
        if axis in lattice.periodic and length < 2.0 * reach:
            raise SceneError(
                f"lattice: a periodic axis must be at least {2.0 * reach:.4g} m long, "
                f"{2 + 2 * SKIN:g} times the distance at which the pair force ends; found "
                f"{axis} of {length:.4g} m. Make it longer, or the force shorter."
            )


def _bonds(start: Array, reach: float, lowest: Array, period: Array | None) -> Whole:
    """Pairs (b, 2) of points within a reach [m]."""
    pairs = pairs_within(reach, start, lowest, period)
    rows = np.repeat(np.arange(len(start)), np.diff(pairs.begin))
    bonds = np.stack([rows, pairs.neighbour], -1).astype(np.int64)
    return bonds[np.lexsort((bonds[:, 1], bonds[:, 0]))]


def _law(
    params: ParticleLatticeParams, start: Array, period: Array | None, frozen: Whole
) -> tuple[Law, float]:
    """Pair law, and the highest angular frequency [rad/s] of the lattice."""
    lattice, roots = params.lattice, params.seven_roots
    if roots is None:
        assert params.force_table is not None
        law: Law = force_table(params.force_table)
    else:
        law = seven_roots(roots, lattice.spacing, roots.amplitude or 1.0)
    if len(start) > LARGEST:
        frequency = highest_frequency(law, lattice.spacing, lattice.mass)
    else:
        frequency = _highest(law, params, start, period, frozen)
    if not frequency > 0.0:
        raise SceneError(
            "pair force: the lattice must have a stiffness, from which the step follows; it has "
            "none at the positions of its points. Take other roots, or another table."
        )
    if roots is not None and roots.top_frequency is not None:
        top = 2.0 * math.pi * roots.top_frequency
        law = seven_roots(roots, lattice.spacing, (top / frequency) ** 2)
        frequency = top
    return law, frequency


def _highest(
    law: Law, params: ParticleLatticeParams, start: Array, period: Array | None, frozen: Whole
) -> float:
    """Highest angular frequency [rad/s] with the frozen points held."""
    lattice = params.lattice
    reach = math.sqrt(law.cutoff2) * CLOSE
    bonds = _bonds(start, reach, np.array(lattice.lowest), period)
    arm = start[bonds[:, 0]] - start[bonds[:, 1]]
    if period is not None:
        arm -= period[:3] * np.rint(arm * period[3:])
    length = np.linalg.norm(arm, axis=1)
    shells, shell = np.unique(length.round(12), return_inverse=True)
    along = np.array([stiffness(law, r) for r in shells.tolist()])[shell]
    across = np.array([pair_force(law, r) / r for r in shells.tolist()])[shell]
    free = np.ones(len(start))
    free[frozen] = 0.0
    first = np.random.default_rng(0).normal(size=start.shape) * free[:, None]
    steps = min(KRYLOV, 3 * int(free.sum()))
    direction = arm / length[:, None]
    diagonal, beside = tridiagonal(bonds, direction, along, across, free, first, steps)
    return math.sqrt(max(highest_eigenvalue(diagonal, beside), 0.0) / lattice.mass)
