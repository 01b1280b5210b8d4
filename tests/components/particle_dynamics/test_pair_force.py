"""The seven-root force, its potential and tables, and lattices with this force."""

import math

import numpy as np
import pytest

from quintet.components.particle_dynamics.build import build
from quintet.components.particle_dynamics.component import ParticleLattice
from quintet.components.particle_dynamics.kernels.forces import sum_forces
from quintet.components.particle_dynamics.kernels.motion import accelerate
from quintet.components.particle_dynamics.laws import energy, force
from quintet.components.particle_dynamics.neighbours import pairs_within
from quintet.components.particle_dynamics.params import (
    Damping,
    Lattice,
    ParticleLatticeParams,
    SevenRootForce,
)
from quintet.components.particle_dynamics.potential import (
    SHELLS,
    force_table,
    highest_frequency,
    seven_roots,
    stiffness,
)
from quintet.interfaces.errors import SceneError

A = 0.003  # m
ENVELOPES = [("power", 0.0), ("power", 2.0), ("ratio", 0.0), ("ratio", 4.0), ("ratio", 6.0)]


def law(envelope="ratio", exponent=6.0, cut_off=0.9):
    force_params = SevenRootForce(
        envelope=envelope, exponent=exponent, cut_off=cut_off, amplitude=1.0
    )
    return seven_roots(force_params, A)


def bar(cells=(3, 1, 1), **settings):
    """A lattice of aluminium-like points; f_top is 50 Hz by default."""
    settings = {"seven_roots": SevenRootForce(top_frequency=50.0), "boltzmann": 1.0} | settings
    lattice = settings.pop("lattice", {})
    lattice_params = Lattice(**({"cells": cells, "spacing": A, "mass": 1e-3} | lattice))
    return ParticleLattice(ParticleLatticeParams(lattice=lattice_params, **settings))


def frequencies(solver):
    """All angular frequencies [rad/s] of a small lattice from differences of its forces."""
    position, count = solver.built.start, len(solver.built.start)
    reach = 2.6 * A
    pairs = pairs_within(reach, position, position.min(axis=0), solver.built.period)
    matrix = np.empty((3 * count, 3 * count))
    step = 1e-6 * A
    for k in range(3 * count):
        forces = []
        for sign in (1.0, -1.0):
            displaced = position.copy()
            displaced.reshape(-1)[k] += sign * step
            force = np.empty_like(position)
            sum_forces(
                displaced,
                np.zeros_like(position),
                pairs,
                solver.built.law,
                None,
                None,
                force,
                np.zeros(0),
            )
            forces.append(force.ravel())
        matrix[k] = -(forces[0] - forces[1]) / (2.0 * step)
    frozen = np.repeat(np.isin(np.arange(count), solver.rows.model.frozen), 3)
    matrix = 0.5 * (matrix + matrix.T)[~frozen][:, ~frozen]
    squares = np.linalg.eigvalsh(matrix) / solver.params.lattice.mass
    return np.sqrt(np.maximum(squares, 0.0))


@pytest.mark.parametrize(("envelope", "exponent"), ENVELOPES)
def test_the_force_vanishes_at_its_roots_and_rises_where_it_is_stable(envelope, exponent):
    pair_law = law(envelope, exponent)
    largest = max(abs(force(pair_law, A * x)) for x in np.linspace(0.8, 2.0, 200))
    for root in pair_law.roots:
        assert abs(force(pair_law, A * root)) < 1e-13 * largest
    slopes = [stiffness(pair_law, A * x) for x in SHELLS]
    # The first is flat under the literal envelope with p > 0, the last by the cut-off.
    if envelope == "ratio" or exponent == 0.0:
        assert slopes[0] > 0.0
    else:
        assert slopes[0] == pytest.approx(0.0, abs=1e-12 * max(slopes))
    assert slopes[1] > 0.0 and slopes[2] > 0.0
    assert slopes[3] == pytest.approx(0.0, abs=1e-9 * max(slopes))
    for x in pair_law.roots[1::2]:
        assert stiffness(pair_law, A * x) < 0.0
    assert force(pair_law, 2.1 * A) == 0.0


@pytest.mark.parametrize("cut_off", [0.7, 0.9])
@pytest.mark.parametrize(("envelope", "exponent"), ENVELOPES)
def test_the_potential_is_the_integral_of_the_force(envelope, exponent, cut_off):
    """By differences of fifth order, to 1e-8 of the largest force; and 0 at two spacings."""
    pair_law = law(envelope, exponent, cut_off)
    distances = A * np.linspace(0.7, 1.99, 300)
    exact = np.array([force(pair_law, r) for r in distances])
    # Not across the end of the cut-off's plateau, where the second derivative jumps.
    h = 2e-3 * A
    smooth = np.abs(distances - 2.0 * cut_off * A) > 4.0 * h
    weights = zip((1, 2, 3), (3.0 / 4.0, -3.0 / 20.0, 1.0 / 60.0), strict=True)
    derivative = np.zeros(len(distances))
    for k, w in weights:
        ahead = np.array([energy(pair_law, r + k * h) for r in distances])
        behind = np.array([energy(pair_law, r - k * h) for r in distances])
        derivative += w / h * (ahead - behind)
    assert np.abs(derivative - exact)[smooth].max() < 1e-8 * np.abs(exact).max()
    assert energy(pair_law, 2.0 * A) == 0.0
    # The plateau's end: the potential is continuous there.
    plateau_end = 2.0 * cut_off * A
    jump = energy(pair_law, plateau_end * (1 + 1e-12)) - energy(pair_law, plateau_end * (1 - 1e-12))
    assert abs(jump) < 1e-9 * abs(energy(pair_law, A * 1.2071))


@pytest.mark.parametrize("periodic", [(), ("x", "y", "z")])
def test_the_perfect_lattice_bears_no_force(periodic):
    solver = bar((6, 6, 7), lattice={"periodic": periodic})
    spring_constant = solver.built.frequency**2 * solver.params.lattice.mass
    assert np.abs(solver.state.acceleration).max() * 1e-3 < 1e-12 * spring_constant * A


def test_two_frozen_points_leave_one_mode_without_frequency():
    """It is the rotation about the line through both points."""
    solver = bar((6, 2, 2), frozen=((6 * A, 0.0, 0.0), (6 * A, 0.0, 2 * A)))
    modes = frequencies(solver)
    top = solver.built.frequency
    assert modes[0] < 1e-4 * top
    assert modes[1] > 5e-3 * top  # 0.0098 by the table of modes


def test_the_highest_frequency_is_that_of_the_whole_matrix():
    solver = bar((6, 2, 2), frozen=((6 * A, 0.0, 0.0), (6 * A, 0.0, 2 * A)))
    assert solver.built.frequency == pytest.approx(100.0 * math.pi, rel=1e-12)
    assert frequencies(solver)[-1] == pytest.approx(solver.built.frequency, rel=1e-7)


def test_the_infinite_lattice_has_the_highest_frequency_of_all():
    built = build(bar((8, 8, 8)).params)
    periodic = bar(
        (12, 12, 12),
        lattice={"periodic": ("x", "y", "z")},
        seven_roots=SevenRootForce(amplitude=built.law.strength),
    )
    bound = highest_frequency(built.law, A, 1e-3)
    assert built.frequency < bound
    assert periodic.built.frequency == pytest.approx(bound, rel=1e-6)


def springs(tmp_path, end):
    """File of springs that pull at rest, of 200 N/m at a distance A, and end at some spacings."""
    rows = np.stack([A * np.array([0.5, 1.1, end]), [-0.21, 0.15, 0.0]], -1)
    np.savetxt(tmp_path / "springs.csv", rows, delimiter=",", fmt="%.12e")
    return str(tmp_path / "springs.csv")


def test_the_highest_frequency_knows_forces_of_a_table_between_points_at_rest(tmp_path):
    file = springs(tmp_path, 1.3)
    periodic = {"cells": (6, 6, 6), "periodic": ("x", "y", "z")}
    small = bar(lattice=periodic, seven_roots=None, force_table=file)
    bound = highest_frequency(force_table(file), A, 1e-3)
    assert small.built.frequency == pytest.approx(bound, rel=1e-6)
    # All neighbours move against a point: 4 F'(a) + 8 F(a)/a.
    assert bound == pytest.approx(math.sqrt((4.0 * 200.0 + 8.0 * 0.09 / A) / 1e-3), rel=1e-3)


def test_periodic_sides_shorter_than_twice_the_reach_of_a_table_are_refused(tmp_path):
    file = springs(tmp_path, 2.8)
    periodic = {"cells": (6, 8, 8), "periodic": ("x", "y")}
    with pytest.raises(SceneError, match=r"at least 0.01848 m long, 2.2 times .* found x of 0.018"):
        bar(lattice=periodic, seven_roots=None, force_table=file)


@pytest.mark.parametrize(
    ("settings", "reason"),
    [
        ({"envelope": "power", "exponent": 1.0}, "does not change its sign"),
        ({"envelope": "power", "exponent": 3.0}, "does not change its sign"),
        ({"envelope": "power", "exponent": 1.5}, "has no value where points are nearer"),
        ({"envelope": "ratio", "exponent": 2.5}, "has no value where points are nearer"),
        ({"unstable_roots": (1.2, 1.8, 1.9)}, "between 1"),
        ({"top_frequency": None, "amplitude": None}, "must be given once"),
    ],
)
def test_exponents_and_roots_without_sense_are_refused_with_the_reason(settings, reason):
    with pytest.raises(ValueError, match=reason):
        SevenRootForce(**({"top_frequency": 50.0} | settings))


def test_a_table_of_the_force_moves_points_as_the_force_does(tmp_path):
    pair_law = law()
    distances = A * np.linspace(0.6, 2.0, 4000)
    rows = np.stack([distances, [force(pair_law, r) for r in distances]], -1)
    rows[-1, 1] = 0.0
    file = tmp_path / "force.csv"
    np.savetxt(file, rows, delimiter=",", header="distance m, force N", fmt="%.12e")
    table = force_table(str(file))
    largest = np.abs(rows[:, 1]).max()
    for r in A * np.array([0.95, 1.0, 1.1, 1.3, 1.6, 1.95]):
        assert force(table, r) == pytest.approx(force(pair_law, r), abs=1e-6 * largest)
        assert energy(table, r) == pytest.approx(energy(pair_law, r), abs=1e-6 * largest * A)
        h = 1e-9 * A  # within one step of the table the potential is its exact integral
        slope = (energy(table, r + h) - energy(table, r - h)) / (2.0 * h)
        assert slope == pytest.approx(force(table, r), abs=1e-4 * largest)
    tabulated = bar(seven_roots=None, force_table=str(file))
    unit_force = SevenRootForce(amplitude=1.0)
    assert tabulated.built.frequency == pytest.approx(
        bar(seven_roots=unit_force).built.frequency, rel=1e-3
    )


def test_a_table_that_does_not_end_at_zero_is_refused(tmp_path):
    file = tmp_path / "force.csv"
    file.write_text("0.001, -1.0\n0.002, 0.5\n")
    with pytest.raises(SceneError, match="last force must be 0"):
        force_table(str(file))


@pytest.mark.parametrize("periodic", [(), ("x",), ("x", "y", "z")])
def test_lists_hold_each_near_pair_once(periodic):
    solver = bar((7, 6, 6), lattice={"periodic": periodic, "lowest": (0.1, -0.2, 0.3)})
    random = np.random.default_rng(4)
    position = solver.built.start + 0.2 * A * random.normal(size=solver.built.start.shape)
    reach, period = 2.2 * A, solver.built.period
    pairs = pairs_within(reach, position, np.array([0.1, -0.2, 0.3]), period)
    rows = np.repeat(np.arange(len(position)), np.diff(pairs.begin))
    listed = sorted(tuple(sorted(pair)) for pair in zip(rows, pairs.neighbour, strict=True))
    arm = position[:, None] - position[None]
    if period is not None:
        arm -= period[:3] * np.rint(arm * period[3:])
    near = np.argwhere(np.triu((arm**2).sum(-1) < reach**2, 1))
    assert listed == [tuple(pair) for pair in near.tolist()]


@pytest.mark.parametrize("kind", ["all", "cut-off", "step"])
def test_damping_takes_what_the_pairs_lose(kind):
    """Momentum is kept; the dissipated power is force times velocity."""
    solver = bar((4, 2, 2), damping=Damping(coefficient=2.0, range=kind))
    # Stretched, because the shell at two spacings would lie on the edge of the cut-off.
    solver.state.position[:] *= 1.01
    random = np.random.default_rng(5)
    state = solver.state
    speed = 0.1 * random.normal(size=state.velocity.shape)
    state.velocity[:] = speed
    rows, terms = solver.rows, solver.rows.terms
    forces = terms.law, terms.damping, terms.period
    accelerate(0.0, rows.model, state, speed, rows.lists.pairs, *forces)
    force_of = 1e-3 * state.acceleration
    assert np.abs(force_of.sum(axis=0)).max() < 1e-13 * np.abs(force_of).max()
    # An independent sum over the damped pairs.
    arm = state.position[:, None] - state.position[None]
    r = np.linalg.norm(arm, axis=-1) + np.eye(len(arm))
    opening = ((speed[:, None] - speed[None]) * arm).sum(-1) / r
    u = np.clip((r / A - 1.8) / 0.2, 0.0, 1.0)
    fade = 1.0 - u * u * (3.0 - 2.0 * u)
    weight = {"all": np.ones_like(r), "cut-off": 1.0 * (r < 2.0 * A), "step": fade}[kind]
    exact = 2.0 * (weight * opening**2)[np.triu_indices(len(r), 1)].sum()
    assert state.lost.sum() == pytest.approx(exact, rel=1e-12)
