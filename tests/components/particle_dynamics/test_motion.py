"""Steps of lattices: accuracy, stability, drive, baths, collisions, and lost points."""

import math

import numpy as np
import pytest

from quintet.components.particle_dynamics.averages import BlockMeans
from quintet.components.particle_dynamics.component import ParticleLattice
from quintet.components.particle_dynamics.integrators import LIMIT
from quintet.components.particle_dynamics.params import (
    Averages,
    Bath,
    Damping,
    Drive,
    Lattice,
    ParticleLatticeParams,
    SevenRootForce,
)
from quintet.components.particle_dynamics.potential import stiffness as slope
from quintet.components.particle_dynamics.state import TIME, WORK
from quintet.interfaces.errors import SceneError, StepError

A, MASS, TOP = 0.01, 1e-3, 50.0  # m, kg, Hz
UNIT = MASS * (A * 2.0 * math.pi * TOP) ** 2  # J; also the unit of temperature, with k = 1


def lattice(cells=(3, 1, 1), **settings):
    keys = {name: settings.pop(name) for name in ("periodic", "temperature") if name in settings}
    force = {"seven_roots": SevenRootForce(top_frequency=TOP), "boltzmann": 1.0}
    lattice_params = Lattice(cells=cells, spacing=A, mass=MASS, **keys)
    return ParticleLattice(ParticleLatticeParams(lattice=lattice_params, **(force | settings)))


def bar(
    spacings=1,
    amplitude=0.05,
    damping=0.3,
    frequency=50.0,
    mode="relative",
    kind="cut-off",
    **settings,
):
    """The paper's bar: two frozen vertices at one end, a driven pair at the other."""
    n = spacings
    end = 3 * n * A
    return lattice(
        (3 * n, n, n),
        frozen=((end, 0.0, 0.0), (end, 0.0, n * A)),
        drive=Drive(
            point=(0.0, n * A, n * A),
            partner="-y",
            frequency=frequency,
            amplitude=amplitude * A,
            mode=mode,
        ),
        damping=Damping(coefficient=damping * MASS, range=kind),
        **settings,
    )


def run(solver, seconds):
    while solver.state.energies[TIME] < seconds * (1.0 - 1e-9):
        solver.step(solver.stable_dt())


def energy(solver):
    return sum(solver.budget.energies())


def test_a_driven_and_damped_bar_accounts_for_its_energy_over_15_s():
    """Kinetic + potential + dissipated - work within 1e-3 of the work, at the default step."""
    solver = bar(substeps=200)
    for second in range(1, 16):
        run(solver, second)
        outputs = solver.give({"energies.audit", "energies.work", "energies.intact"})
        assert abs(outputs["energies.audit"][0]) < 1e-3
    assert outputs["energies.work"][0] > 10.0 * energy(solver) > 0.0
    assert outputs["energies.intact"][0] == 1.0


def ends_of_a_free_lattice(integrator, step, seconds=0.04):
    solver = lattice((3, 1, 1), temperature=2e-4 * UNIT, integrator=integrator)
    for _ in range(round(seconds / step)):
        solver.step(step)
    return solver.state.position / A, energy(solver)


@pytest.mark.parametrize(("integrator", "order"), [("velocity_verlet", 2), ("yoshida", 4)])
def test_the_error_of_each_integrator_falls_by_its_order(integrator, order):
    exact, _ = ends_of_a_free_lattice("yoshida", 5e-5)
    steps = (8e-4, 4e-4, 2e-4)  # s; 0.25, 0.125, 0.06 over the highest frequency
    errors = [np.abs(ends_of_a_free_lattice(integrator, step)[0] - exact).max() for step in steps]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders[-1] == pytest.approx(order, abs=0.25)


def test_a_driven_pair_and_damping_keep_the_second_order():
    def end(step):
        solver = bar(damping=20.0, kind="step")
        for _ in range(round(0.04 / step)):
            solver.step(step)
        return np.append(solver.state.position.ravel() / A, solver.state.energies[WORK] / UNIT)

    exact = end(2.5e-5)
    errors = [np.abs(end(step) - exact).max() for step in (8e-4, 4e-4, 2e-4)]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders[-1] == pytest.approx(2.0, abs=0.25)


@pytest.mark.parametrize("integrator", ["velocity_verlet", "yoshida"])
def test_the_limit_of_the_step_is_that_of_the_highest_frequency(integrator):
    """Small motion is stable at 0.95 of the limit and unstable at 1.05."""
    solver = lattice((3, 1, 1), temperature=1e-14 * UNIT, integrator=integrator)
    limit = LIMIT[integrator] / solver.built.frequency
    start = float((solver.state.velocity**2).sum())
    for _ in range(300):
        solver.step(0.95 * limit)
    assert float((solver.state.velocity**2).sum()) < 100.0 * start
    solver = lattice((3, 1, 1), temperature=1e-14 * UNIT, integrator=integrator)
    with pytest.raises(StepError, match="smaller courant"):
        for _ in range(300):
            solver.step(1.05 * limit)


def test_results_depend_on_ratios_only():
    """Twice the frequencies and damping, four times the strength: the same at half the time."""
    slow, fast = (
        bar(),
        bar(frequency=100.0, damping=0.6, seven_roots=SevenRootForce(top_frequency=2.0 * TOP)),
    )
    for _ in range(400):
        slow.step(2e-4)
        fast.step(1e-4)
    assert slow.state.position == pytest.approx(fast.state.position, abs=1e-10 * A)
    hotness = [
        solver.give({"points.relative_hotness"})["points.relative_hotness"]
        for solver in (slow, fast)
    ]
    assert hotness[0] == pytest.approx(hotness[1], abs=1e-9)


@pytest.mark.parametrize("mode", ["relative", "symmetric", "point", "partner"])
def test_the_driven_pair_has_the_distance_that_is_told(mode):
    solver = bar(mode=mode)
    driven = solver.rows.model.driven
    start = solver.built.start
    for _ in range(97):
        solver.step(2e-4)
    time = solver.state.energies[TIME]
    distance = solver.state.position[driven.first, 1] - solver.state.position[driven.second, 1]
    expected_distance = A * (1.0 + 0.05 * math.sin(2.0 * math.pi * 50.0 * time))
    assert distance == pytest.approx(expected_distance, rel=1e-13)
    displacement = solver.state.position[[driven.first, driven.second], 1]
    displacement -= start[[driven.first, driven.second], 1]
    sine = 0.05 * A * math.sin(2.0 * math.pi * 50.0 * time)
    expected = {"symmetric": (0.5, -0.5), "point": (1.0, 0.0), "partner": (0.0, -1.0)}
    if mode in expected:
        assert displacement == pytest.approx(sine * np.array(expected[mode]), abs=1e-13 * A)
    else:
        assert displacement.sum() != 0.0  # their mean is free
    assert abs(solver.give({"energies.audit"})["energies.audit"][0]) < 1e-2
    frozen = solver.rows.model.frozen
    assert (solver.state.position[frozen] == start[frozen]).all()


def test_a_free_lattice_keeps_momentum_and_spin():
    solver = lattice((3, 3, 3), temperature=1e-5 * UNIT)
    start = solver.totals()
    run(solver, 0.2)
    end = solver.totals()
    momentum_scale = MASS * np.abs(solver.state.velocity).sum()
    assert np.abs(end.momentum - start.momentum).max() < 1e-13 * momentum_scale
    assert np.abs(end.angular_momentum - start.angular_momentum).max() < 1e-12 * momentum_scale * A


def test_collisions_keep_momentum_and_energy_to_rounding():
    """Half a million collisions in steps so short that nothing else happens."""
    solver = lattice((3, 3, 3), temperature=1e-5 * UNIT, collision_rate=1e9)
    start, kinetic = solver.totals(), solver.totals().kinetic
    velocity_before = solver.state.velocity.copy()
    for _ in range(4):
        solver.step(1e-6)
    assert (
        np.abs(solver.state.velocity - velocity_before).max() > 0.1 * np.abs(velocity_before).max()
    )
    assert solver.totals().kinetic == pytest.approx(
        kinetic, rel=1e-6
    )  # the bonds change it slightly in 4 us
    momentum_scale = MASS * np.abs(solver.state.velocity).sum()
    assert np.abs(solver.totals().momentum - start.momentum).max() < 1e-12 * momentum_scale


def test_a_bath_brings_all_points_to_its_temperature():
    """Equipartition, within four standard errors by blocks, which are below 3 %."""
    temperature = 1e-5 * UNIT
    bath = Bath(lowest=(0.0, 0.0, 0.0), highest=(0.0, A, A), temperature=temperature, rate=100.0)
    solver = lattice(
        (3, 1, 1), baths=(bath,), collision_rate=200.0, courant=0.1, substeps=100,
        averages=Averages(begin=2.0, block=2.0),
    )  # fmt: skip
    run(solver, 60.0)
    outputs = solver.give({"energies.temperature", "energies.temperature_error", "energies.audit"})
    error = outputs["energies.temperature_error"][0]
    assert 0.0 < error < 0.03 * temperature
    assert outputs["energies.temperature"][0] == pytest.approx(temperature, abs=4.0 * error)
    assert abs(outputs["energies.audit"][0]) < 2e-2
    assert solver.give({"baths.temperature"})["baths.temperature"][0] == pytest.approx(
        temperature, rel=0.1
    )


def test_heat_flows_through_the_wall_that_a_partner_holds():
    cold = Bath(lowest=(3 * A, 0.0, 0.0), highest=(3 * A, A, A), temperature=0.0, rate=200.0)
    wall = Bath(
        lowest=(0.0, 0.0, 0.0), highest=(0.0, A, A), temperature=0.0, rate=200.0, coupled=True
    )
    solver = lattice((3, 1, 1), baths=(cold, wall), collision_rate=300.0, substeps=20)
    assert solver.describe()["wall_heat.position"] == pytest.approx(
        np.array([[0.0, y, z] for y in (0.0, A) for z in (0.0, A)])
    )
    solver.take({"wall_temperature.temperature": np.full(4, 1e-5 * UNIT)})
    joules = 0.0
    for _ in range(400):
        solver.step(solver.stable_dt())
        joules += (
            solver.stable_dt() * solver.give({"wall_heat.heat_flow"})["wall_heat.heat_flow"].sum()
        )
    into_bar, from_bath = solver.budget.integrals()[[2, 1]]
    assert joules == pytest.approx(-into_bar, rel=1e-12)
    assert into_bar > 0.0 > from_bath
    assert (
        solver.totals().internal + solver.totals().kinetic - solver.budget.initial
        == pytest.approx(into_bar + from_bath, abs=5e-3 * into_bar)
    )


def test_a_seed_makes_the_same_bits_and_another_one_others():
    def end(seed):
        bath = Bath(lowest=(0.0, 0.0, 0.0), highest=(0.0, A, A), temperature=UNIT * 1e-5, rate=9.0)
        solver = lattice((3, 1, 1), baths=(bath,), collision_rate=100.0, seed=seed)
        for _ in range(50):
            solver.step(solver.stable_dt())
        return solver.state.position

    assert (end(3) == end(3)).all()
    assert (end(3) != end(4)).any()


@pytest.mark.parametrize("amplitude", [0.15, 0.2])
def test_a_strong_drive_breaks_the_lattice_and_this_is_told(amplitude):
    solver = bar(amplitude=amplitude, damping=0.1)
    assert "breaks most lattices up" in solver.notes()[0]
    with pytest.raises(StepError, match=r"left all others|are intact|must move by less"):
        run(solver, 15.0)


def test_a_hot_bath_evaporates_the_lattice_and_this_is_told():
    hot = Bath(lowest=(0.0, 0.0, 0.0), highest=(0.0, A, A), temperature=1e-2 * UNIT, rate=100.0)
    with pytest.raises(StepError, match=r"point|bonds"):
        run(lattice((3, 1, 1), baths=(hot,)), 5.0)
    solver = lattice((3, 1, 1), baths=(hot,), if_point_lost="report")
    run(solver, 1.0)
    assert any(
        "left all others behind" in warning or "bonds" in warning
        for warning in solver.warnings().values()
    )
    assert solver.give({"energies.intact"})["energies.intact"][0] < 0.95


def test_a_step_beyond_the_limit_is_told_as_such():
    solver = lattice((3, 1, 1), temperature=1e-5 * UNIT)
    with pytest.raises(StepError, match="smaller courant"):
        for _ in range(200):
            solver.step(2.2 / solver.built.frequency)


def test_aluminium_itself_is_stepped():
    """A bar of 16 points of 10 mm spacing with E a = 7e8 N/m: 0.1 to 1 MHz; energy is kept."""
    stiffness, mass = 7e10 * A, 8.1e-3 / 16  # N/m, kg
    unit_force = SevenRootForce(amplitude=1.0)
    unit_lattice = lattice((3, 1, 1), seven_roots=unit_force)
    unit_law = unit_lattice.built.law
    force = SevenRootForce(amplitude=stiffness / slope(unit_law, A))
    solver = ParticleLattice(
        ParticleLatticeParams(
            lattice=Lattice(cells=(3, 1, 1), spacing=A, mass=mass, temperature=300.0),
            seven_roots=force,
            boltzmann=1e-6,  # 300 K are 0.5 mJ of a point
            substeps=100,
        )
    )
    assert 1e4 < solver.built.frequency / (2.0 * math.pi) < 1e6
    for _ in range(50):
        solver.step(solver.stable_dt())
    assert abs(solver.give({"energies.audit"})["energies.audit"][0]) < 1e-3


@pytest.mark.parametrize(
    ("settings", "reason"),
    [
        ({"collision_rate": 1.0, "integrator": "yoshida"}, "need the integrator"),
        ({"force_table": None, "seven_roots": None}, "one pair force"),
        (
            {
                "cells": (6, 6, 6),
                "periodic": ("x",),
                "damping": Damping(coefficient=1.0, range="all"),
            },
            "damping of all pairs needs open sides",
        ),
    ],
)
def test_what_does_not_go_together_is_refused(settings, reason):
    with pytest.raises(ValueError, match=reason):
        lattice(**settings)


@pytest.mark.parametrize("kind", ["cut-off", "all"])
def test_strong_damping_limits_the_step(kind):
    strong = Damping(coefficient=4.0 * MASS * 2.0 * math.pi * TOP, range=kind)
    solver = lattice((3, 3, 3), damping=strong, temperature=1e-3 * UNIT)
    vibrating = 0.03 * LIMIT["velocity_verlet"] / solver.built.frequency
    assert solver.stable_dt() < 0.3 * vibrating
    first = solver.totals().kinetic
    for _ in range(100):
        solver.step(solver.stable_dt())
    # Without rotation all motion is damped; the spin stays.
    assert solver.totals().kinetic < 0.3 * first
    with pytest.raises(StepError):
        for _ in range(100):
            solver.step(vibrating)


def test_a_drive_above_all_frequencies_of_the_lattice_limits_the_step():
    slow, fast = bar(frequency=TOP), bar(frequency=10.0 * TOP)
    assert fast.stable_dt() == pytest.approx(0.1 * slow.stable_dt(), rel=1e-12)


def test_a_drive_of_a_frozen_point_is_refused():
    with pytest.raises(SceneError, match=r"found \[0.0, 0.01, 0.01\] m, which mode relative moves"):
        bar_with_frozen_drive("relative")
    bar_with_frozen_drive("partner")  # which leaves it where it is


def bar_with_frozen_drive(mode):
    drive = Drive(point=(0.0, A, A), partner="-y", frequency=50.0, amplitude=0.05 * A, mode=mode)
    return lattice(frozen=((0.0, A, A),), drive=drive)


def test_boxes_without_points_are_refused():
    empty = Bath(lowest=(1.0, 1.0, 1.0), highest=(2.0, 2.0, 2.0), temperature=1.0, rate=1.0)
    with pytest.raises(SceneError, match="holds none"):
        lattice(baths=(empty,))


def test_block_means_have_the_error_of_independent_blocks():
    random = np.random.default_rng(7)
    rates = 3.0 + random.normal(size=4000)
    means = BlockMeans(1, 1.0, 0.5)
    integral = np.zeros(1)
    for k, rate in enumerate(rates):
        means.add(0.01 * k, integral)
        integral = integral + 0.01 * rate
    assert means.means(39.99, integral - 0.01 * rates[-1])[0] == pytest.approx(
        rates[100:3999].mean(), rel=1e-9
    )
    exact = rates.std() / math.sqrt(3900)
    assert means.errors()[0] == pytest.approx(exact, rel=0.3)
