"""Steps of lattices: accuracy, stability, drive, baths, collisions, and what is lost."""

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
UNIT = MASS * (A * 2.0 * math.pi * TOP) ** 2  # J; temperatures are in this with k = 1


def lattice(cells=(3, 1, 1), **given):
    keys = {name: given.pop(name) for name in ("periodic", "temperature") if name in given}
    force = {"seven_roots": SevenRootForce(top_frequency=TOP), "boltzmann": 1.0}
    made = Lattice(cells=cells, spacing=A, mass=MASS, **keys)
    return ParticleLattice(ParticleLatticeParams(lattice=made, **(force | given)))


def bar(
    spacings=1,
    amplitude=0.05,
    damping=0.3,
    frequency=50.0,
    mode="relative",
    kind="cut-off",
    **given,
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
        **given,
    )


def run(made, seconds):
    while made.state.energies[TIME] < seconds * (1.0 - 1e-9):
        made.step(made.stable_dt())


def energy(made):
    return sum(made.budget.energies())


def test_a_driven_and_damped_bar_accounts_for_its_energy_over_15_s():
    """Kinetic + potential + dissipated - work within 1e-3 of the work, at the default step."""
    made = bar(substeps=200)
    for second in range(1, 16):
        run(made, second)
        found = made.give({"energies.audit", "energies.work", "energies.intact"})
        assert abs(found["energies.audit"][0]) < 1e-3
    assert found["energies.work"][0] > 10.0 * energy(made) > 0.0
    assert found["energies.intact"][0] == 1.0


def ends_of_a_free_lattice(integrator, step, seconds=0.04):
    made = lattice((3, 1, 1), temperature=2e-4 * UNIT, integrator=integrator)
    for _ in range(round(seconds / step)):
        made.step(step)
    return made.state.position / A, energy(made)


@pytest.mark.parametrize(("integrator", "order"), [("velocity_verlet", 2), ("yoshida", 4)])
def test_the_error_of_each_integrator_falls_by_its_order(integrator, order):
    exact, _ = ends_of_a_free_lattice("yoshida", 5e-5)
    steps = (8e-4, 4e-4, 2e-4)  # s; 0.25, 0.125, 0.06 over the highest frequency
    errors = [np.abs(ends_of_a_free_lattice(integrator, one)[0] - exact).max() for one in steps]
    found = np.log2(np.array(errors[:-1]) / errors[1:])
    assert found[-1] == pytest.approx(order, abs=0.25)


def test_a_driven_pair_and_damping_keep_the_second_order():
    def end(step):
        made = bar(damping=20.0, kind="step")
        for _ in range(round(0.04 / step)):
            made.step(step)
        return np.append(made.state.position.ravel() / A, made.state.energies[WORK] / UNIT)

    exact = end(2.5e-5)
    errors = [np.abs(end(step) - exact).max() for step in (8e-4, 4e-4, 2e-4)]
    found = np.log2(np.array(errors[:-1]) / errors[1:])
    assert found[-1] == pytest.approx(2.0, abs=0.25)


@pytest.mark.parametrize("integrator", ["velocity_verlet", "yoshida"])
def test_the_limit_of_the_step_is_that_of_the_highest_frequency(integrator):
    """Of small motion: stable at 0.95 of it, unstable at 1.05."""
    made = lattice((3, 1, 1), temperature=1e-14 * UNIT, integrator=integrator)
    limit = LIMIT[integrator] / made.built.frequency
    start = float((made.state.velocity**2).sum())
    for _ in range(300):
        made.step(0.95 * limit)
    assert float((made.state.velocity**2).sum()) < 100.0 * start
    made = lattice((3, 1, 1), temperature=1e-14 * UNIT, integrator=integrator)
    with pytest.raises(StepError, match="smaller courant"):
        for _ in range(300):
            made.step(1.05 * limit)


def test_results_depend_on_ratios_only():
    """Twice the frequencies and damping, four times the strength: the same at half the time."""
    one, other = (
        bar(),
        bar(frequency=100.0, damping=0.6, seven_roots=SevenRootForce(top_frequency=2.0 * TOP)),
    )
    for _ in range(400):
        one.step(2e-4)
        other.step(1e-4)
    assert one.state.position == pytest.approx(other.state.position, abs=1e-10 * A)
    hot = [
        made.give({"points.relative_hotness"})["points.relative_hotness"] for made in (one, other)
    ]
    assert hot[0] == pytest.approx(hot[1], abs=1e-9)


@pytest.mark.parametrize("mode", ["relative", "symmetric", "point", "partner"])
def test_the_driven_pair_has_the_distance_that_is_told(mode):
    made = bar(mode=mode)
    driven = made.rows.model.driven
    start = made.built.start
    for _ in range(97):
        made.step(2e-4)
    time = made.state.energies[TIME]
    distance = made.state.position[driven.first, 1] - made.state.position[driven.second, 1]
    told = A * (1.0 + 0.05 * math.sin(2.0 * math.pi * 50.0 * time))
    assert distance == pytest.approx(told, rel=1e-13)
    moved = made.state.position[[driven.first, driven.second], 1]
    moved -= start[[driven.first, driven.second], 1]
    sine = 0.05 * A * math.sin(2.0 * math.pi * 50.0 * time)
    expected = {"symmetric": (0.5, -0.5), "point": (1.0, 0.0), "partner": (0.0, -1.0)}
    if mode in expected:
        assert moved == pytest.approx(sine * np.array(expected[mode]), abs=1e-13 * A)
    else:
        assert moved.sum() != 0.0  # their mean is free
    assert abs(made.give({"energies.audit"})["energies.audit"][0]) < 1e-2
    frozen = made.rows.model.frozen
    assert (made.state.position[frozen] == start[frozen]).all()


def test_a_free_lattice_keeps_momentum_and_spin():
    made = lattice((3, 3, 3), temperature=1e-5 * UNIT)
    start = made.totals()
    run(made, 0.2)
    end = made.totals()
    size = MASS * np.abs(made.state.velocity).sum()
    assert np.abs(end.momentum - start.momentum).max() < 1e-13 * size
    assert np.abs(end.angular_momentum - start.angular_momentum).max() < 1e-12 * size * A


def test_collisions_keep_momentum_and_energy_to_rounding():
    """Half a million of them, with the step so short that nothing else happens."""
    made = lattice((3, 3, 3), temperature=1e-5 * UNIT, collision_rate=1e9)
    start, kinetic = made.totals(), made.totals().kinetic
    before = made.state.velocity.copy()
    for _ in range(4):
        made.step(1e-6)
    assert np.abs(made.state.velocity - before).max() > 0.1 * np.abs(before).max()
    assert made.totals().kinetic == pytest.approx(kinetic, rel=1e-6)  # less what moves in 4 us
    size = MASS * np.abs(made.state.velocity).sum()
    assert np.abs(made.totals().momentum - start.momentum).max() < 1e-12 * size


def test_a_bath_brings_all_points_to_its_temperature():
    """Equipartition, within four standard errors by blocks, which are below 3 %."""
    warm = 1e-5 * UNIT
    bath = Bath(lowest=(0.0, 0.0, 0.0), highest=(0.0, A, A), temperature=warm, rate=100.0)
    made = lattice(
        (3, 1, 1), baths=(bath,), collision_rate=200.0, courant=0.1, substeps=100,
        averages=Averages(begin=2.0, block=2.0),
    )  # fmt: skip
    run(made, 60.0)
    found = made.give({"energies.temperature", "energies.temperature_error", "energies.audit"})
    error = found["energies.temperature_error"][0]
    assert 0.0 < error < 0.03 * warm
    assert found["energies.temperature"][0] == pytest.approx(warm, abs=4.0 * error)
    assert abs(found["energies.audit"][0]) < 2e-2
    assert made.give({"baths.temperature"})["baths.temperature"][0] == pytest.approx(warm, rel=0.1)


def test_heat_flows_through_the_wall_that_a_partner_holds():
    cold = Bath(lowest=(3 * A, 0.0, 0.0), highest=(3 * A, A, A), temperature=0.0, rate=200.0)
    wall = Bath(
        lowest=(0.0, 0.0, 0.0), highest=(0.0, A, A), temperature=0.0, rate=200.0, coupled=True
    )
    made = lattice((3, 1, 1), baths=(cold, wall), collision_rate=300.0, substeps=20)
    assert made.describe()["wall_heat.position"] == pytest.approx(
        np.array([[0.0, y, z] for y in (0.0, A) for z in (0.0, A)])
    )
    made.take({"wall_temperature.temperature": np.full(4, 1e-5 * UNIT)})
    joules = 0.0
    for _ in range(400):
        made.step(made.stable_dt())
        joules += made.stable_dt() * made.give({"wall_heat.heat_flow"})["wall_heat.heat_flow"].sum()
    into_bar, out = made.budget.integrals()[[2, 1]]
    assert joules == pytest.approx(-into_bar, rel=1e-12)
    assert into_bar > 0.0 > out
    assert made.totals().internal + made.totals().kinetic - made.budget.initial == pytest.approx(
        into_bar + out, abs=5e-3 * into_bar
    )


def test_a_seed_makes_the_same_bits_and_another_one_others():
    def end(seed):
        bath = Bath(lowest=(0.0, 0.0, 0.0), highest=(0.0, A, A), temperature=UNIT * 1e-5, rate=9.0)
        made = lattice((3, 1, 1), baths=(bath,), collision_rate=100.0, seed=seed)
        for _ in range(50):
            made.step(made.stable_dt())
        return made.state.position

    assert (end(3) == end(3)).all()
    assert (end(3) != end(4)).any()


@pytest.mark.parametrize("amplitude", [0.15, 0.2])
def test_a_strong_drive_breaks_the_lattice_and_this_is_told(amplitude):
    made = bar(amplitude=amplitude, damping=0.1)
    assert "breaks most lattices up" in made.notes()[0]
    with pytest.raises(StepError, match=r"left all others|are intact|must move by less"):
        run(made, 15.0)


def test_a_hot_bath_evaporates_the_lattice_and_this_is_told():
    hot = Bath(lowest=(0.0, 0.0, 0.0), highest=(0.0, A, A), temperature=1e-2 * UNIT, rate=100.0)
    with pytest.raises(StepError, match=r"point|bonds"):
        run(lattice((3, 1, 1), baths=(hot,)), 5.0)
    told = lattice((3, 1, 1), baths=(hot,), if_point_lost="report")
    run(told, 1.0)
    assert any(
        "left all others behind" in one or "bonds" in one for one in told.warnings().values()
    )
    assert told.give({"energies.intact"})["energies.intact"][0] < 0.95


def test_a_step_beyond_the_limit_is_told_as_such():
    made = lattice((3, 1, 1), temperature=1e-5 * UNIT)
    with pytest.raises(StepError, match="smaller courant"):
        for _ in range(200):
            made.step(2.2 / made.built.frequency)


def test_aluminium_itself_is_stepped():
    """A bar of 16 points of 10 mm spacing with E a = 7e8 N/m: 0.1 to 1 MHz; energy is kept."""
    stiffness, mass = 7e10 * A, 8.1e-3 / 16  # N/m, kg
    given = SevenRootForce(amplitude=1.0)
    one = lattice((3, 1, 1), seven_roots=given)
    unit = one.built.law
    force = SevenRootForce(amplitude=stiffness / slope(unit, A))
    made = ParticleLattice(
        ParticleLatticeParams(
            lattice=Lattice(cells=(3, 1, 1), spacing=A, mass=mass, temperature=300.0),
            seven_roots=force,
            boltzmann=1e-6,  # 300 K are 0.5 mJ of a point
            substeps=100,
        )
    )
    assert 1e4 < made.built.frequency / (2.0 * math.pi) < 1e6
    for _ in range(50):
        made.step(made.stable_dt())
    assert abs(made.give({"energies.audit"})["energies.audit"][0]) < 1e-3


@pytest.mark.parametrize(
    ("given", "reason"),
    [
        ({"collision_rate": 1.0, "integrator": "yoshida"}, "need the integrator"),
        ({"force_table": None, "seven_roots": None}, "one pair force"),
    ],
)
def test_what_does_not_go_together_is_refused(given, reason):
    with pytest.raises(ValueError, match=reason):
        lattice(**given)


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
