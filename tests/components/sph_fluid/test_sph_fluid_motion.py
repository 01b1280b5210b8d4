"""Motion of the fluid: exact motions, conservation, rest, and the limit of the step."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from fluid_params import fluid_params

from quintet.components.shared.threads import Team
from quintet.components.sph_fluid.component import SphFluid
from quintet.interfaces.component import Fields, outputs_of
from quintet.interfaces.errors import OrderError, QuintetError, StepError

Make = Callable[..., SphFluid]
Join = Callable[..., Fields]


def push_all(fluid: SphFluid, velocity: list[float]) -> None:
    state = {name: np.array(array) for name, array in fluid.save().items()}
    state["velocity_pressure"][:, :3] += velocity
    fluid.load(state)


def stir(fluid: SphFluid, seed: int = 3) -> None:
    """Give the fluid particles random velocities and densities."""
    state = {name: np.array(array) for name, array in fluid.save().items()}
    random, rows = np.random.default_rng(seed), slice(len(state["identity"]))
    state["velocity_pressure"][rows, :3] += random.normal(
        0.0, 0.1, state["velocity_pressure"][rows, :3].shape
    )
    state["position_density"][rows, 3] += random.uniform(
        0.0, 3.0, len(state["position_density"][rows])
    )
    fluid.load(state)


def run(fluid: SphFluid, time: float) -> None:
    """Step for a time [s], in steps that the fluid allows."""
    remaining = time
    while remaining > 0.0:
        pieces = math.ceil(remaining / fluid.stable_dt() - 1e-9)
        fluid.step(remaining / pieces)
        remaining = 0.0 if pieces == 1 else remaining - remaining / pieces


def test_free_fall_is_a_parabola(drop: Make) -> None:
    fluid = drop(negative_pressure=False)
    state = {name: np.array(array) for name, array in fluid.save().items()}
    state["position_density"][:, 3] = 1000.0  # no pressure
    state["velocity_pressure"][:, 3] = 0.0
    state["velocity_pressure"][:, 0] = 0.7
    fluid.load(state)
    before = fluid.view()["points"].copy()
    run(fluid, 0.2)
    fallen = fluid.view()["points"] - before
    assert fallen == pytest.approx(np.tile([0.14, 0.0, -0.5 * 9.81 * 0.04], (216, 1)), abs=1e-9)


def test_uniform_fluid_without_gravity_stays(drop: Make) -> None:
    fluid = drop(gravity=(0.0, 0.0, 0.0))
    before = fluid.view()["points"].copy()
    run(fluid, 0.02)
    assert np.array_equal(fluid.view()["points"], before)
    assert fluid.totals().kinetic == 0.0


def test_pushed_fluid_conserves_momentum(drop: Make) -> None:
    fluid = drop(gravity=(0.0, 0.0, 0.0), xsph=0.5)
    stir(fluid)
    before = fluid.totals()
    run(fluid, 0.02)
    after = fluid.totals()
    size = math.sqrt(2.0 * before.mass * before.kinetic)
    assert after.momentum == pytest.approx(before.momentum, abs=1e-12 * size)
    assert after.kinetic != before.kinetic


def test_motion_is_the_same_in_a_moving_frame(drop: Make) -> None:
    still, moving = drop(gravity=(0.0, 0.0, 0.0)), drop(gravity=(0.0, 0.0, 0.0))
    stir(still)
    stir(moving)
    push_all(moving, [3.0, -2.0, 1.0])
    for _ in range(20):
        still.step(2e-4)
        moving.step(2e-4)
    shift = 20 * 2e-4 * np.array([3.0, -2.0, 1.0])
    assert moving.view()["points"] - shift == pytest.approx(still.view()["points"], abs=1e-11)


def test_surface_takes_what_the_fluid_loses(drop: Make, plate: Join) -> None:
    fluid = drop(gravity=(0.0, 0.0, 0.0))
    stir(fluid)
    fluid.take(plate(fluid))
    impulse, size, before = np.zeros(3), 0.0, fluid.totals().momentum
    for _ in range(30):
        dt = fluid.stable_dt()
        fluid.step(dt)
        force = outputs_of(fluid)["surface_load.force"]
        impulse += dt * force.sum(axis=0)
        size += dt * np.abs(force).sum()
    gained = fluid.totals().momentum - before
    assert gained[2] > 0.0 and size > 0.0
    assert impulse + gained == pytest.approx(np.zeros(3), abs=1e-12 * size)


@pytest.mark.parametrize("share", [1.0, 0.6])
def test_one_step_gives_and_takes_the_same_impulse(drop: Make, plate: Join, share: float) -> None:
    fluid = drop(gravity=(0.0, 0.0, 0.0))
    fluid.take(plate(fluid, share=share))
    fluid.step(1e-4)
    fluid.step(2e-4)
    before = fluid.totals().momentum
    fluid.step(0.7e-4)
    impulse = 0.7e-4 * outputs_of(fluid)["surface_load.force"]
    gained = fluid.totals().momentum - before
    assert impulse.sum(axis=0) == pytest.approx(-gained, abs=1e-12 * np.abs(impulse).sum())


def test_resting_surface_far_away_feels_no_force(drop: Make, plate: Join) -> None:
    fluid = drop()
    fluid.take(plate(fluid, height=-1.0, speed=0.0))
    run(fluid, 0.01)
    assert not outputs_of(fluid)["surface_load.force"].any()


def test_surface_that_comes_from_afar_is_met(drop: Make, plate: Join) -> None:
    fluid = drop(gravity=(0.0, 0.0, 0.0))
    fields = plate(fluid, height=-0.2, speed=2.0)
    for k in range(200):
        rise = 1e-3 * k * fields["surface.velocity"]
        fluid.take(fields | {"surface.position": fields["surface.position"] + rise})
        fluid.step(0.25e-3)
        fluid.take(fields | {"surface.position": fields["surface.position"] + rise})
        if outputs_of(fluid)["surface_load.force"].any():
            break
    assert 75 <= k <= 77  # the kernels of the lowest particles end at -0.05 m


def test_pool_stays_at_rest(pool: Make) -> None:
    fluid = pool()
    start = fluid.totals()
    run(fluid, 0.5)
    end = fluid.totals()
    weight = start.mass * 9.81 * 0.1
    assert end.mass == start.mass == pytest.approx(1000.0 * 0.16 * 0.16 * 0.1)
    assert end.kinetic < 1e-3 * weight
    assert abs(end.potential - start.potential) < 0.08 * weight
    pressure, depth = fluid.view()["pressure"], 0.1 - fluid.view()["points"][:, 2]
    deep = depth > 0.05
    assert pressure[deep].mean() == pytest.approx(9810.0 * depth[deep].mean(), rel=0.25)


def test_falling_water_gains_no_energy(pool: Make) -> None:
    fluid = pool(fluid=(((0.0, 0.0, 0.0), (0.08, 0.16, 0.1)),))
    energies = []
    for _ in range(10):
        run(fluid, 0.02)
        totals = fluid.totals()
        energies.append(totals.kinetic + totals.potential + totals.internal)
    assert max(energies) == energies[0]
    assert energies[-1] < 0.9 * energies[0]
    assert fluid.view()["points"][:, 0].max() > 0.12  # it ran out along the floor


@pytest.mark.parametrize(("courant", "calm"), [(0.4, True), (0.9, False)])
def test_step_limit_is_where_rest_becomes_unstable(pool: Make, courant: float, calm: bool) -> None:
    fluid = pool(courant=courant)
    weight = fluid.totals().mass * 9.81 * 0.1
    try:
        run(fluid, 0.3)
    except QuintetError:
        assert not calm
    assert (fluid.totals().kinetic < 1e-3 * weight) is calm


def test_two_half_windows_come_to_the_same_as_one(pool: Make) -> None:
    whole, halves = pool(), pool()
    run(whole, 0.05)
    run(halves, 0.025)
    run(halves, 0.025)
    assert halves.view()["points"] == pytest.approx(whole.view()["points"], abs=2e-5)


def test_options_change_the_motion_but_not_the_rest(pool: Make) -> None:
    for options in ({"xsph": 0.5}, {"shepard_every": 20}, {"negative_pressure": True}):
        fluid = pool(**options)
        run(fluid, 0.2)
        assert fluid.totals().kinetic < 1e-3 * fluid.totals().mass * 9.81 * 0.1


def test_particles_that_leave_are_counted_and_missed() -> None:
    boxes = (((0.0, 0.0, 0.0), (0.1, 0.1, 0.1)), ((0.3, 0.0, 0.0), (0.4, 0.1, 0.1)))
    walls = ((0.0, 0.0, 0.0), (0.1, 0.1, 0.2))
    params = fluid_params(
        spacing=0.02,
        sound_speed=20.0,
        fluid=boxes,
        boundary__walls=walls,
        boundary__open_faces=("x+", "z+"),
    )
    fluid = SphFluid(params)
    fluid.step(fluid.stable_dt())
    assert fluid.state.lost == 125
    assert fluid.totals().mass == pytest.approx(1.0)
    assert len(fluid.view()["points"]) == 125
    assert fluid.items() == len(fluid.state.position_density)


def test_too_fast_a_particle_is_an_error_that_names_it(drop: Make) -> None:
    fluid = drop()
    state = {name: np.array(array) for name, array in fluid.save().items()}
    state["velocity_pressure"][17, 0] = 900.0
    fluid.load(state)
    with pytest.raises(StepError, match=r"less than a spacing .* particle 17 at .* Lower courant"):
        fluid.step(1e-3)


@pytest.mark.parametrize("boundary", ["dbc", "mdbc", "potential"])
@pytest.mark.parametrize(("speed", "fails"), [(2.0, False), (20.0, True)])
def test_what_strikes_faster_than_half_of_sound_is_an_error(
    drop: Make, plate: Join, boundary: str, speed: float, fails: bool
) -> None:
    fluid = drop(boundary__method=boundary, gravity=(0.0, 0.0, 0.0), sound_speed=18.0)
    fields = {name: np.array(array) for name, array in plate(fluid, speed=speed).items()}
    fields["surface.mirror"] = fields["surface.position"] + [0.0, 0.0, 0.02]

    def strike() -> None:
        distance = 0.0
        while distance < 0.06:
            fluid.take(fields)
            dt = fluid.stable_dt()
            fluid.step(dt)
            distance += speed * dt
            for name in ("position", "mirror"):
                fields[f"surface.{name}"][:, 2] += speed * dt

    if not fails:
        strike()
        return
    sentence = (
        r"slower than half its sound_speed \(9 m/s\).* the fastest of all, .* Raise sound_speed"
    )
    with pytest.raises(StepError, match=sentence):
        strike()


def test_a_number_that_is_not_finite_is_an_error(drop: Make, plate: Join) -> None:
    fluid = drop()
    fields = plate(fluid)
    fluid.take(fields | {"surface.velocity": np.full((49, 3), math.inf)})
    with pytest.raises(StepError, match="must stay finite"):
        fluid.step(1e-4)
        fluid.step(1e-4)


def test_a_surface_must_be_placed_before_a_step(drop: Make, plate: Join) -> None:
    fluid = drop()
    plate(fluid)
    with pytest.raises(OrderError, match="Call take before"):
        fluid.step(1e-4)


@pytest.mark.parametrize("precision", ["float64", "float32"])
def test_bits_do_not_depend_on_the_number_of_threads(pool: Make, precision: str) -> None:
    ends = []
    for threads in (1, 2, 3):
        fluid = pool(xsph=0.5, shepard_every=7, precision=precision)
        fluid.team = Team(threads, fewest=20)
        stir(fluid)
        for _ in range(40):
            fluid.step(fluid.stable_dt())
        ends.append(fluid.save())
    first, *repeats = ends
    assert all(np.array_equal(first[name], repeat[name]) for repeat in repeats for name in first)


def test_lists_are_renewed_before_a_pair_is_missed(pool: Make) -> None:
    fluid = pool()
    stir(fluid)
    reach = fluid.constants.smoothing.support
    for _ in range(30):
        fluid.step(fluid.stable_dt())
        position = fluid.state.position_density.copy()
        if fluid.lists.need_rebuild(fluid.state, fluid.boundary, 0.0):
            continue
        near = fluid.lists.near
        distance = np.linalg.norm(position[:, None, :3] - position[None, :10, :3], axis=2)
        for i in range(10):
            listed = set(near.list[near.begin[i] : near.end[i]].tolist())
            assert set(np.flatnonzero(distance[:, i] < reach).tolist()) <= listed
