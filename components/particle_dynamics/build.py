"""A lattice as its parameters describe it: points, bonds, frequency, what holds and heats them."""

import math
from typing import NamedTuple

import numpy as np

from quintet.components.particle_dynamics.integrators import STAGES
from quintet.components.particle_dynamics.kernels.stiffness import highest_eigenvalue, tridiagonal
from quintet.components.particle_dynamics.laws import force as pair_force
from quintet.components.particle_dynamics.neighbours import pairs_within
from quintet.components.particle_dynamics.params import (
    Bath,
    Drive,
    Lattice,
    ParticleLatticeParams,
)
from quintet.components.particle_dynamics.potential import (
    ForceTable,
    PairDamping,
    SevenRoots,
    force_table,
    highest_frequency,
    pair_damping,
    seven_roots,
    stiffness,
)
from quintet.components.particle_dynamics.state import Bathed, Driven, Model, State, Whole
from quintet.interfaces.component import Array
from quintet.interfaces.errors import SceneError

Law = SevenRoots | ForceTable
LARGEST = 2000  # points of which the highest frequency is found; of more that of infinitely many
KRYLOV = 150  # steps of Lanczos
CLOSE = 1.0 - 1e-9  # of a cut-off: a shell that stands on it is not within
AXES = "xyz"


class Built(NamedTuple):
    """All that is known before the first step."""

    start: Array  # (n, 3) m
    period: Array | None  # (6,) m and 1/m, lengths of periodic sides and inverses; None: open
    law: Law
    damping: PairDamping | None
    frequency: float  # rad/s, the highest
    model: Model
    bonds: Whole  # (b, 2) of nearest points
    temperature: Array  # (b,) K, of bathed points
    wall: Whole  # rows of the bathed points that are coupled


def lattice_points(lattice: Lattice) -> Array:
    """Places (n, 3) m, counted along z first."""
    axes = [np.arange(count) for count in lattice.points]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), -1).reshape(-1, 3)
    return np.array(lattice.lowest) + lattice.spacing * grid


def build(params: ParticleLatticeParams) -> Built:
    """Build a lattice."""
    lattice = params.lattice
    start = lattice_points(lattice)
    spacing = lattice.spacing
    period = _period(lattice)
    frozen = np.array(sorted({_nearest(start, one) for one in params.frozen}), np.int64)
    driven = _driven(start, lattice, params.drive)
    law, frequency = _law(params, start, period, frozen)
    bathed, temperature, wall = _bathed(start, params.baths)
    held = {*frozen.tolist(), *({driven.first, driven.second} - {-1})}
    if shared := held & set(bathed.point.tolist()):
        raise SceneError(
            f"baths: points in a bath must be neither frozen nor driven; found "
            f"{start[min(shared)].tolist()} m. Make the boxes smaller."
        )
    bonds = _bonds(start, 1.1 * spacing, np.array(lattice.lowest), period)
    loose = ~np.isin(bonds, sorted(held)).any(axis=1)
    damping = params.damping
    is_literal = damping is not None and damping.range == "all"
    model = Model(
        mass=lattice.mass,
        frozen=frozen,
        driven=driven,
        bathed=bathed,
        bonds=bonds[loose],
        collision_rate=params.collision_rate if loose.any() else 0.0,
        stages=np.array(STAGES[params.integrator]),
        literal_damping=damping.coefficient if damping is not None and is_literal else 0.0,
    )
    stiffest = bathed.tether.max() if len(bathed.point) else 0.0
    frequency = math.sqrt(frequency**2 + stiffest / lattice.mass)
    made = pair_damping(damping, spacing)
    return Built(start, period, law, made, frequency, model, bonds, temperature, wall)


def initial_state(params: ParticleLatticeParams, built: Built) -> State:
    """Points at their places, with random velocities if they are warm."""
    lattice, model, count = params.lattice, built.model, len(built.start)
    random = np.random.default_rng(params.seed)
    width = math.sqrt(2.0 * params.boltzmann * lattice.temperature / lattice.mass)
    velocity = width * random.normal(size=(count, 3))
    velocity[model.frozen] = 0.0
    if not len(model.frozen):
        velocity -= velocity.mean(axis=0)
    baths = len(model.bathed.point)
    return State(
        position=built.start.copy(),
        velocity=velocity,
        acceleration=np.zeros((count, 3)),
        listed=built.start.copy(),
        kinetic=np.zeros(count),
        temperature=built.temperature.copy(),
        heat=np.zeros(baths),
        energies=np.zeros(6),
        generator=np.array([params.seed], np.uint64),
    )


def _period(lattice: Lattice) -> Array | None:
    if not lattice.periodic:
        return None
    sides = zip(AXES, lattice.cells, strict=True)
    length = [n * lattice.spacing if axis in lattice.periodic else 0.0 for axis, n in sides]
    return np.array([*length, *(1.0 / one if one else 0.0 for one in length)])


def _nearest(start: Array, place: tuple[float, float, float]) -> int:
    return int(((start - place) ** 2).sum(axis=1).argmin())


def _bonds(start: Array, reach: float, lowest: Array, period: Array | None) -> Whole:
    """Pairs (b, 2) of points that are nearer than a reach [m]."""
    pairs = pairs_within(reach, start, lowest, period)
    rows = np.repeat(np.arange(len(start)), np.diff(pairs.begin))
    found = np.stack([rows, pairs.neighbour], -1).astype(np.int64)
    return found[np.lexsort((found[:, 1], found[:, 0]))]


def _law(
    params: ParticleLatticeParams, start: Array, period: Array | None, frozen: Whole
) -> tuple[Law, float]:
    """Pair law, and the highest angular frequency [rad/s] of the lattice that it holds together."""
    lattice, given = params.lattice, params.seven_roots
    table = params.force_table
    law: Law
    if given is None:
        assert table is not None
        law = force_table(table)
    else:
        law = seven_roots(given, lattice.spacing, given.amplitude or 1.0)
    if len(start) > LARGEST:
        frequency = highest_frequency(law, lattice.spacing, lattice.mass)
    else:
        frequency = _highest(law, params, start, period, frozen)
    if not frequency > 0.0:
        raise SceneError(
            "pair force: the lattice must have a stiffness, from which the step follows; it has "
            "none at its places. Take other roots, or another table."
        )
    if given is not None and given.top_frequency is not None:
        told = 2.0 * math.pi * given.top_frequency
        law = seven_roots(given, lattice.spacing, (told / frequency) ** 2)
        frequency = told
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
    shells, which = np.unique(length.round(12), return_inverse=True)
    along = np.array([stiffness(law, one) for one in shells.tolist()])[which]
    across = np.array([pair_force(law, one) / one for one in shells.tolist()])[which]
    free = np.ones(len(start))
    free[frozen] = 0.0
    first = np.random.default_rng(0).normal(size=start.shape) * free[:, None]
    steps = min(KRYLOV, 3 * int(free.sum()))
    direction = arm / length[:, None]
    diagonal, beside = tridiagonal(bonds, direction, along, across, free, first, steps)
    return math.sqrt(max(highest_eigenvalue(diagonal, beside), 0.0) / lattice.mass)


def _driven(start: Array, lattice: Lattice, drive: Drive | None) -> Driven:
    if drive is None:
        return Driven(-1, -1, 0, 0.0, 0.0, 0.0, 0.0, 0.0, False, 0.0, 0.0)
    first, axis = _nearest(start, drive.point), AXES.index(drive.partner[1])
    towards = 1.0 if drive.partner[0] == "+" else -1.0
    place = start[first].copy()
    place[axis] += towards * lattice.spacing
    second = _nearest(start, tuple(place.tolist()))
    if np.abs(start[second] - place).max() > 0.5 * lattice.spacing:
        raise SceneError(
            f"drive: partner must be a point of the lattice; towards {drive.partner} of "
            f"{start[first].tolist()} m there is none. Take another direction."
        )
    distance = -towards * lattice.spacing
    shares = {"relative": (0.5, 0.5), "symmetric": (0.5, 0.5), "point": (1.0, 0.0)}
    share_first, share_second = shares.get(drive.mode, (0.0, 1.0))
    return Driven(
        first=first,
        second=second,
        axis=axis,
        distance=distance,
        amplitude=math.copysign(drive.amplitude, distance),
        frequency=2.0 * math.pi * drive.frequency,
        share_first=share_first,
        share_second=share_second,
        is_free=drive.mode == "relative",
        rest_first=float(start[first, axis]),
        rest_second=float(start[second, axis]),
    )


def _bathed(start: Array, baths: tuple[Bath, ...]) -> tuple[Bathed, Array, Whole]:
    """Points in baths, their temperatures [K], and which of them are coupled."""
    slack = 1e-9 * float(np.abs(start).max() + 1e-300)
    of = np.full(len(start), -1)
    for number, one in enumerate(baths):
        inside = (start >= np.array(one.lowest) - slack) & (start <= np.array(one.highest) + slack)
        found = inside.all(axis=1)
        if not found.any() or (of[found] >= 0).any():
            what = "holds none" if not found.any() else "shares one with another bath"
            raise SceneError(
                f"baths.{number}: its box must hold points of its own; it {what}. Correct the box."
            )
        of[found] = number
    point = np.flatnonzero(of >= 0)
    bath = of[point]
    rows = [baths[number] for number in bath.tolist()]
    made = Bathed(
        point=point,
        bath=bath,
        rate=np.array([one.rate for one in rows], float),
        tether=np.array([one.tether for one in rows], float),
        rest=start[point].copy(),
    )
    wall = np.flatnonzero([one.coupled for one in rows]) if rows else np.zeros(0, np.int64)
    return made, np.array([one.temperature for one in rows], float), wall
