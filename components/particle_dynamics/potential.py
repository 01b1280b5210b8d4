"""Pair laws from parameters: roots, potentials and stiffnesses by polynomials; tables of files."""

import math

import numpy as np
from numpy.polynomial import polynomial

from quintet.components.particle_dynamics.coefficients import (
    MIDDLE,
    ForceTable,
    PairDamping,
    SevenRoots,
)
from quintet.components.particle_dynamics.force_params import Damping, SevenRootForce
from quintet.interfaces.component import Array
from quintet.interfaces.errors import SceneError

SHELLS = (1.0, math.sqrt(2.0), math.sqrt(3.0), 2.0)  # spacings, the stable roots
STEPS = 4096  # of a table, between its first and its last distance


def seven_roots(keys: SevenRootForce, spacing: float, strength: float = 1.0) -> SevenRoots:
    """Law of a strength c [N] for a lattice of a spacing [m]."""
    a, b, c, d = SHELLS
    first, second, third = keys.unstable_roots
    roots = (a, first, b, second, c, third, d)
    base = 1.0 if keys.envelope == "power" else 0.0
    exponent, begin = int(keys.exponent), 2.0 * keys.cut_off
    inner, outer = _potential(roots, base, exponent, begin)
    return SevenRoots(
        strength=strength,
        per_metre=1.0 / spacing,
        roots=roots,
        base=base,
        factors=(1.0,) * exponent,
        begin=begin,
        per_width=1.0 / (2.0 - begin),
        cutoff2=4.0 * spacing * spacing,
        inner=inner,
        outer=outer,
    )


def _potential(
    roots: tuple[float, ...], base: float, exponent: int, begin: float
) -> tuple[Array, Array]:
    """Integrals of the force over c a before and within the cut-off, 0 at two spacings."""
    force = polynomial.polyfromroots(np.array([*roots, *[base] * exponent]) - MIDDLE)
    u = np.array([MIDDLE - begin, 1.0]) / (2.0 - begin)
    falling = polynomial.polymul(polynomial.polymul(u, u), polynomial.polysub([3.0], 2.0 * u))
    step = polynomial.polysub([1.0], falling)
    outer = polynomial.polyint(polynomial.polymul(force, step))
    outer[0] -= polynomial.polyval(2.0 - MIDDLE, outer)
    inner = polynomial.polyint(force)
    join = begin - MIDDLE
    inner[0] += polynomial.polyval(join, outer) - polynomial.polyval(join, inner)
    return inner, outer


def stiffness(law: SevenRoots | ForceTable, r: float) -> float:
    """dF/dr [N/m] of a pair at a distance [m]."""
    if isinstance(law, ForceTable):
        place = (r - law.first) * law.per_metre
        k = math.floor(place)
        if not 0 <= k < len(law.force) - 1:
            return 0.0
        return float((law.force[k + 1] - law.force[k]) * law.per_metre)
    x = r * law.per_metre
    if x >= 2.0:
        return 0.0
    series = law.inner if x <= law.begin else law.outer
    curvature = polynomial.polyval(x - MIDDLE, polynomial.polyder(series, 2))
    return float(law.strength * law.per_metre * curvature)


def tension(law: SevenRoots | ForceTable, r: float) -> float:
    """F/r [N/m] of a pair at a distance [m] of the lattice, where seven roots have no force."""
    if not isinstance(law, ForceTable):
        return 0.0
    places = law.first + np.arange(len(law.force)) / law.per_metre
    return float(np.interp(r, places, law.force)) / r


def highest_frequency(law: SevenRoots | ForceTable, spacing: float, mass: float) -> float:
    """Highest angular frequency [rad/s] of the infinite lattice, over wave vectors in steps of π/6.

    A finite lattice has lower ones, because each bond that is missing reduces the stiffness.
    """
    reach = math.floor(math.sqrt(law.cutoff2) / spacing + 1e-9)
    axis = np.arange(-reach, reach + 1)
    bonds = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), -1).reshape(-1, 3)
    length = np.linalg.norm(bonds, axis=1)
    near = (length > 0.0) & (length * spacing < math.sqrt(law.cutoff2) * (1.0 - 1e-12))
    bonds, length = bonds[near], length[near]
    lengths = (spacing * length).tolist()
    along = np.array([stiffness(law, r) for r in lengths])
    across = np.array([tension(law, r) for r in lengths])
    direction = bonds / length[:, None]
    dyads = (along - across)[:, None, None] * direction[:, :, None] * direction[:, None, :]
    dyads += across[:, None, None] * np.eye(3)
    wave = np.pi / 6.0 * np.arange(7)
    highest = 0.0
    for vector in np.stack(np.meshgrid(wave, wave, wave, indexing="ij"), -1).reshape(-1, 3):
        weight = 1.0 - np.cos(bonds @ vector)
        matrix = (weight[:, None, None] * dyads).sum(axis=0)
        highest = max(highest, float(np.linalg.eigvalsh(matrix)[-1]))
    return math.sqrt(highest / mass)


def force_table(name: str) -> ForceTable:
    """Read a table of distance [m] and force [N], attraction positive."""
    rows = np.loadtxt(name, delimiter=",", ndmin=2, comments="#")
    where = f"force_table {name}"
    if rows.shape[1:] != (2,) or len(rows) < 2:
        raise SceneError(
            f"{where}: it must have two columns, distance [m] and force [N], and two rows or more; "
            f"found {rows.shape}. Correct it."
        )
    r, force = rows.T
    if not (np.diff(r) > 0.0).all() or r[0] <= 0.0 or force[-1] != 0.0:
        raise SceneError(
            f"{where}: distances must be positive and rise, and the last force must be 0, beyond "
            f"which there is none; found {r[0]:g} m to {r[-1]:g} m and {force[-1]:g} N. Correct it."
        )
    place = np.linspace(r[0], r[-1], STEPS + 1)
    even = np.interp(place, r, force)
    width = (r[-1] - r[0]) / STEPS
    parts = 0.5 * width * (even[1:] + even[:-1])
    energy = np.concatenate([np.cumsum(parts), [0.0]])
    energy = np.concatenate([[0.0], energy[:-1]]) - parts.sum()
    return ForceTable(float(r[0]), 1.0 / width, even, energy, float(r[-1]) ** 2)


def pair_damping(damping: Damping | None, spacing: float) -> PairDamping | None:
    """Damping within two spacings; None if there is none, or if it acts on all pairs."""
    if damping is None or damping.coefficient == 0.0 or damping.range == "all":
        return None
    if damping.range == "cut-off":
        return PairDamping(damping.coefficient, 1.0 / spacing, 2.0, 1e12)
    begin = 2.0 * damping.cut_off
    return PairDamping(damping.coefficient, 1.0 / spacing, begin, 1.0 / (2.0 - begin))
