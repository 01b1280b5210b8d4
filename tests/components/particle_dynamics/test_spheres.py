"""Spheres: exact flight, launches, tethers, impacts with walls and each other."""

import numpy as np
import pytest

from quintet.components.particle_dynamics.integrators import LIMIT
from quintet.components.particle_dynamics.spheres.component import ParticleSpheres
from quintet.components.particle_dynamics.spheres.params import (
    Copies,
    ParticleSpheresParams,
    Sphere,
    Wall,
)
from quintet.components.shared.search.sphere_pairs import NearPairs
from quintet.coupler.scene.kinds import named_kind
from quintet.interfaces import rotation
from quintet.interfaces.errors import SceneError

G = (0.0, 0.0, -9.81)  # m/s2


def spheres(*descriptions, **keys):
    sphere_params = tuple(
        Sphere(**({"radius": 0.01, "density": 1000.0} | description))
        for description in descriptions
    )
    return ParticleSpheres(ParticleSpheresParams(spheres=sphere_params, **keys))


def test_flight_under_constant_loads_is_exact_at_any_step():
    solver = spheres({"centre": (0.0, 0.0, 1.0), "velocity": (2.0, 0.0, 3.0)}, gravity=G)
    mass = solver.totals().mass
    solver.take({"load.force": np.array([[mass, 0.0, 0.0]]), "heat.heat_flow": np.array([5.0])})
    for _ in range(3):
        solver.step(0.1)
    outputs = solver.give({"motion.position", "spheres.temperature"})
    exact = np.array([[0.6 + 0.5 * 0.09, 0.0, 1.0 + 0.9 - 0.5 * 9.81 * 0.09]])
    assert outputs["motion.position"] == pytest.approx(exact, abs=1e-14)
    assert outputs["spheres.temperature"][0] == pytest.approx(300.0 + 1.5 / (1000.0 * mass))


def test_a_torque_turns_a_sphere_by_its_moment_of_inertia():
    solver = spheres({"centre": (0.0, 0.0, 0.0)})
    inertia = 0.4 * solver.totals().mass * 0.01**2
    solver.take({"load.torque": np.array([[0.0, 0.0, 2.0 * inertia]])})
    for _ in range(10):
        solver.step(0.05)
    outputs = solver.give({"motion.orientation", "motion.angular_velocity"})
    assert outputs["motion.angular_velocity"][0] == pytest.approx([0.0, 0.0, 1.0])
    half = 0.125  # rad, half of t2
    orientation = [np.cos(half), 0.0, 0.0, np.sin(half)]
    assert outputs["motion.orientation"][0] == pytest.approx(orientation, abs=1e-12)


def test_a_sphere_rests_until_it_is_launched_within_a_step():
    solver = spheres({"centre": (0.0, 0.0, 0.0), "velocity": (1.0, 0.0, 0.0), "launch": 0.25})
    solver.take({"load.force": np.array([[1.0, 0.0, 0.0]]) * 0.0})
    solver.step(0.2)
    assert solver.give({"motion.velocity"})["motion.velocity"][0, 0] == 0.0
    solver.step(0.1)
    assert solver.give({"motion.position"})["motion.position"][0, 0] == pytest.approx(0.05)
    solver.step(0.1)
    assert solver.give({"motion.position"})["motion.position"][0, 0] == pytest.approx(0.15)


@pytest.mark.parametrize("restitution", [0.0, 0.5, 1.0])
def test_impacts_keep_momentum_and_lose_what_restitution_says(restitution):
    solver = spheres(
        {"centre": (0.0, 0.0, 0.0), "velocity": (1.0, 0.2, 0.0)},
        {"centre": (0.03, 0.0, 0.0), "velocity": (-1.0, 0.0, 0.0), "density": 3000.0},
        restitution=restitution,
    )
    start = solver.totals()
    for _ in range(200):
        solver.step(1e-4)
    end = solver.totals()
    assert end.momentum == pytest.approx(start.momentum, abs=1e-15)
    assert end.angular_momentum == pytest.approx(start.angular_momentum, abs=1e-15)
    assert end.kinetic + end.internal == pytest.approx(start.kinetic, rel=1e-12)
    velocity = solver.give({"motion.velocity"})["motion.velocity"]
    line = np.diff(solver.give({"motion.position"})["motion.position"], axis=0)[0]
    separation_speed = np.diff(velocity, axis=0)[0] @ line / np.linalg.norm(line)
    assert separation_speed == pytest.approx(2.0 * restitution, abs=0.1)


def test_a_sphere_bounces_from_a_wall():
    solver = spheres(
        {"centre": (0.0, 0.0, 0.1), "velocity": (0.5, 0.0, -1.0)},
        walls=(Wall(normal=(0.0, 0.0, 2.0)),),
        restitution=0.6,
    )
    for _ in range(1000):
        solver.step(2e-4)
    assert solver.give({"motion.velocity"})["motion.velocity"][0] == pytest.approx([0.5, 0.0, 0.6])


def crowd(restitution, spacing, gravity=(0.0, 0.0, 0.0)):
    """27 spheres at random velocities in a box of walls, `spacing` diameters apart."""
    random, side = np.random.default_rng(0), 3 * 0.02 * spacing
    places = (np.stack(np.meshgrid(*[np.arange(3)] * 3), -1).reshape(-1, 3) + 0.5) * side / 3
    descriptions = [{"centre": tuple(x), "velocity": tuple(random.normal(size=3))} for x in places]
    normals = [tuple(sign * row) for row in np.eye(3) for sign in (1.0, -1.0)]
    walls = tuple(Wall(normal=n, offset=-side if sum(n) < 0.0 else 0.0) for n in normals)
    return spheres(*descriptions, walls=walls, restitution=restitution, gravity=gravity)


def overlaps(solver):
    """Largest overlap of two spheres of 0.02 m, over their diameter."""
    position = solver.give({"motion.position"})["motion.position"]
    distance = np.linalg.norm(position[:, None] - position[None], axis=2)
    return 1.0 - distance[np.triu_indices(len(position), 1)].min() / 0.02


def advance(solver, end):
    """Advance by natural steps; yield the time after each step."""
    time = 0.0
    while time < end:
        dt = min(solver.stable_dt(), end - time)
        solver.step(dt)
        time += dt
        yield time


@pytest.mark.parametrize("restitution", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("spacing", [1.05, 1.5])
def test_spheres_overlap_by_less_than_1_percent_at_the_natural_step(restitution, spacing):
    solver = crowd(restitution, spacing)
    start = solver.totals()
    assert max(overlaps(solver) for _ in advance(solver, 0.2)) < 0.01
    end = solver.totals()
    assert end.kinetic + end.internal == pytest.approx(start.kinetic, rel=1e-12)
    assert solver.warnings() == {}


def test_impacts_have_their_own_times_within_a_step():
    solver = spheres(
        {"centre": (0.0, 0.0, 0.0), "velocity": (1.0, 0.0, 0.0)},
        *({"centre": (0.0213 + 0.02 * k, 0.0, 0.0)} for k in range(5)),
        {"centre": (0.1250, 0.0, 0.0), "velocity": (0.5, 0.0, 0.0)},
    )
    for _ in range(7):
        solver.step(1e-3)
    outputs = solver.give({"motion.position", "motion.velocity"})
    # The first strikes the row after 1.3 ms; it stops, and the last of the row leaves with 1 m/s.
    exact = [0.0013, *(0.0213 + 0.02 * k for k in range(4)), 0.1013 + 0.0057, 0.1285]
    velocities = [0.0] * 5 + [1.0, 0.5]
    if exact[-1] - exact[-2] < 0.02:  # it then strikes the sphere ahead of it
        delay = (0.02 - (exact[-1] - exact[-2])) / 0.5
        exact[-2:] = exact[-2] - 0.5 * delay, exact[-1] + 0.5 * delay
        velocities[-2:] = 0.5, 1.0
    assert outputs["motion.position"][:, 0] == pytest.approx(exact, abs=1e-12)
    assert outputs["motion.velocity"][:, 0] == pytest.approx(velocities, abs=1e-12)


@pytest.mark.parametrize("step", [0.01, 0.1, 0.3])
def test_a_fall_and_a_bounce_are_exact_at_any_step(step):
    solver = spheres({"centre": (0.0, 0.0, 1.01)}, walls=(Wall(normal=(0, 0, 1.0)),), gravity=G)
    fall = np.sqrt(2.0 / 9.81)  # s, one metre
    for k in range(round(0.6 / step)):
        solver.step(step)
        time = (k + 1) * step
        since_bounce = time - fall
        height = 1.0 - 0.5 * 9.81 * time**2
        if since_bounce > 0.0:
            height = 9.81 * fall * since_bounce - 0.5 * 9.81 * since_bounce**2
        assert solver.give({"motion.position"})["motion.position"][0, 2] == pytest.approx(
            height + 0.01, abs=1e-12
        )


def test_spheres_that_fall_meet_though_they_are_at_rest_at_the_start():
    solver = spheres(
        {"centre": (0.0, 0.0, 0.0), "launch": 10.0}, {"centre": (0.0, 0.0, 0.5)}, gravity=G
    )
    list(advance(solver, 1.0))
    assert solver.give({"motion.position"})["motion.position"][1, 2] >= 0.02 * 0.99


def test_a_pile_that_hard_spheres_cannot_make_is_warned_of():
    solver = crowd(0.5, 1.05, G)
    deepest = max(overlaps(solver) for _ in advance(solver, 0.3))
    assert deepest > 0.01
    (warning,) = solver.warnings().values()
    assert "spheres overlapped by up to" in warning and "Take dem_bodies" in warning
    restored = crowd(0.5, 1.05, G)
    restored.load(solver.save())
    assert restored.warnings() == solver.warnings()


def test_spheres_that_begin_within_another_are_refused():
    places = [(0.1, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.017)]
    descriptions = [{"centre": centre, "launch": 0.1 * k} for k, centre in enumerate(places)]
    message = r"centres of 1 and 2 must be 0.018 m apart .* found 0.017 m. Move them apart"
    with pytest.raises(SceneError, match=message):
        spheres(*descriptions)
    spheres(*descriptions, collisions=False)
    spheres(
        descriptions[1], descriptions[2] | {"centre": (0.0, 0.0, 0.0181)}
    )  # an overlap of a tenth is allowed
    overlapping_copies = {
        "centre": (0.0, 0.0, 0.0),
        "copies": Copies(number=(2, 1, 1), spacing=(0.01,) * 3),
    }
    with pytest.raises(SceneError, match=r"0 and 1 must be 0.018 m apart .* found 0.01 m"):
        spheres(overlapping_copies)


@pytest.mark.parametrize(("height", "distance"), [(-0.2, "-0.7 m"), (0.505, "0.005 m")])
def test_spheres_that_begin_behind_a_wall_are_refused(height, distance):
    walls = Wall(normal=(1.0, 0.0, 0.0), offset=-1.0), Wall(normal=(0.0, 0.0, 2.0), offset=0.5)
    message = rf"walls.1: the centre of sphere 1 must be 0.009 m in front .* found {distance}. Move"
    with pytest.raises(SceneError, match=message):
        spheres({"centre": (0.0, 0.0, 1.0)}, {"centre": (0.0, 0.0, height)}, walls=walls)


def test_the_former_kind_is_refused_with_the_kinds_in_its_place():
    with pytest.raises(SceneError, match=r"is now particle_lattice or particle_spheres. Rename it"):
        named_kind("particle_dynamics", "kind")


def _orders(errors):
    return np.log2(np.array(errors[:-1]) / np.array(errors[1:]))


@pytest.mark.parametrize(
    ("integrator", "order", "finest"), [("velocity_verlet", 2.0, 2e-3), ("yoshida", 4.0, 2e-5)]
)
def test_a_tethered_sphere_swings_with_the_order_of_its_scheme(integrator, order, finest):
    """x = x0 + (v/ω) sin ωt + (f/k) (1 - cos ωt), over one period and a half."""
    errors = []
    for steps in (40, 80, 160):
        solver = spheres(
            {"centre": (1.0, 0.0, 0.0), "velocity": (0.0, 2.0, 0.0), "tether": 3.0},
            integrator=integrator,
        )
        mass = solver.totals().mass
        frequency = np.sqrt(3.0 / mass)
        end, swing = 3.1 * np.pi / frequency, 2.0 / frequency
        solver.take({"load.force": np.array([[3.0 * swing, 0.0, 0.0]])})
        for _ in range(steps):
            solver.step(end / steps)
        phase = frequency * end
        exact = [1.0 + swing * (1.0 - np.cos(phase)), swing * np.sin(phase), 0.0]
        position = solver.give({"motion.position"})["motion.position"][0]
        errors.append(np.abs(position - exact).max() / swing)
    assert errors[-1] < finest
    assert _orders(errors) == pytest.approx(order, abs=0.15)


@pytest.mark.parametrize("integrator", ["velocity_verlet", "yoshida"])
def test_energy_of_a_tethered_sphere_swings_and_does_not_drift(integrator):
    solver = spheres(
        {"centre": (0.0, 0.0, 0.0), "velocity": (0.0, 2.0, 0.0), "tether": 3.0},
        integrator=integrator,
        courant=0.3,
    )
    dt = solver.stable_dt()
    assert dt == pytest.approx(0.3 * LIMIT[integrator] / np.sqrt(3.0 / solver.totals().mass))
    energies = []
    for _ in range(2000):
        solver.step(dt)
        total = solver.totals()
        energies.append(total.kinetic + total.potential)
    assert np.ptp(energies) < 0.1 * energies[0]
    assert np.ptp(energies[1000:]) == pytest.approx(np.ptp(energies[:1000]), rel=1e-2)


def test_a_sphere_whose_axis_turns_is_followed_to_fourth_order():
    """A torque across the spin, compared with ten thousand short turns at the midpoint's spin."""
    spin, angular_acceleration, end = np.array([0.0, 0.0, 3.0]), np.array([2.0, 1.0, 0.0]), 1.0
    exact = np.array([[1.0, 0.0, 0.0, 0.0]])
    h = 1e-4
    for step in range(10_000):
        angle = h * (spin + angular_acceleration * (step + 0.5) * h)
        exact = rotation.product(rotation.exponential(angle[None]), exact)
    errors = []
    for steps in (4, 8, 16):
        solver = spheres({"centre": (0.0, 0.0, 0.0), "angular_velocity": tuple(spin)})
        inertia = 0.4 * solver.totals().mass * 0.01**2
        solver.take({"load.torque": inertia * angular_acceleration[None]})
        for _ in range(steps):
            solver.step(end / steps)
        errors.append(
            np.abs(solver.give({"motion.orientation"})["motion.orientation"] - exact).max()
        )
    assert _orders(errors) == pytest.approx(4.0, abs=0.2)


def test_cells_find_the_pairs_that_a_look_at_all_finds():
    random = np.random.default_rng(3)
    position = random.uniform(0.0, 1.0, (300, 3))
    position[5] = [1e9, -3e8, 0.0]  # beyond the numbered cells
    position[6] = [1e9, -3e8, 0.01]
    radius = random.uniform(0.01, 0.06, 300)
    near = NearPairs(radius)
    begin, neighbours = near.at(position)
    pairs = {(i, int(j)) for i in range(300) for j in neighbours[begin[i] : begin[i + 1]]}
    distance = np.linalg.norm(position[:, None] - position, axis=-1)
    overlap = np.argwhere(np.triu(distance < radius[:, None] + radius, 1))
    assert len(overlap) > 50
    assert {tuple(pair) for pair in overlap.tolist()} <= pairs
    assert all(np.all(np.diff(neighbours[begin[i] : begin[i + 1]]) > 0) for i in range(300))
    direction = np.array([1.0, 0.0, 0.0])
    near.at(position + 0.49 * near.skin * direction)
    assert np.array_equal(near.listed, position)  # the list is still valid
    near.at(position + 0.51 * near.skin * direction)
    assert not np.array_equal(near.listed, position)


def test_a_list_made_anew_changes_no_bit():
    def gas():
        return spheres(
            {
                "centre": (0.0, 0.0, 0.0),
                "velocity": (1.0, 0.0, 0.0),
                "copies": Copies(number=(3, 3, 3), spacing=(0.05, 0.03, 0.03)),
            },
            {
                "centre": (0.021, 0.004, 0.003),
                "copies": Copies(number=(3, 3, 3), spacing=(0.05, 0.03, 0.03)),
            },
            restitution=0.8,
        )

    solver, reloaded = gas(), gas()
    for step in range(60):
        solver.step(1e-3)
        reloaded.step(1e-3)
        if step % 7 == 0:
            saved, reloaded = reloaded.save(), gas()
            reloaded.load(saved)
    assert solver.totals().internal > 0.0
    for key, array in solver.save().items():
        assert np.array_equal(array, reloaded.save()[key]), key


def test_copies_are_launched_one_after_another():
    solver = spheres(
        {
            "centre": (0.0, 0.0, 0.0),
            "velocity": (0.0, 0.0, 1.0),
            "copies": Copies(number=(3, 1, 1), spacing=(0.1, 0.1, 0.1), interval=0.5),
        }
    )
    for _ in range(6):
        solver.step(0.2)
    position = solver.give({"motion.position"})["motion.position"]
    assert position[:, 0] == pytest.approx([0.0, 0.1, 0.2])
    assert position[:, 2] == pytest.approx([1.2, 0.7, 0.2])


def test_a_parcel_moves_as_one_of_its_spheres():
    keys = {"centre": (0.0, 0.0, 0.0), "angular_velocity": (0.0, 1.0, 0.0)}
    single = spheres(keys)
    parcel = spheres(keys | {"parcel": 1e4}, collisions=False)
    load = {
        "load.force": np.array([[1.0, 2.0, 0.0]]),
        "load.torque": np.array([[0.0, 0.0, 1e-4]]),
        "heat.heat_flow": np.array([3.0]),
    }
    single.take(load)
    parcel.take({key: 1e4 * array for key, array in load.items()})
    assert parcel.describe()["spheres.number"] == 1e4
    for solver in (single, parcel):
        solver.step(0.01)
    for key, array in single.save().items():
        if key not in ("force", "torque", "heat", "sums"):
            assert parcel.save()[key] == pytest.approx(array, rel=1e-12, abs=1e-15), key
    assert parcel.totals().kinetic == pytest.approx(1e4 * single.totals().kinetic)
    with pytest.raises(ValueError, match="collisions = false"):
        spheres(keys | {"parcel": 2.0})


def test_no_sphere_may_cross_another_in_a_step():
    solver = spheres(
        {"centre": (0.0, 0.0, 0.0), "velocity": (10.0, 0.0, 0.0)},
        {"centre": (0.0, 1.0, 0.0), "velocity": (9.0, 0.0, 0.0)},
    )
    assert solver.stable_dt() == pytest.approx(0.25 * 0.02 / 1.0)
    walled = spheres(
        {"centre": (0.0, 0.0, 1.0), "velocity": (0.0, 0.0, -4.0)},
        walls=(Wall(normal=(0.0, 0.0, 1.0)),),
    )
    assert walled.stable_dt() == pytest.approx(0.25 * 0.02 / 4.0)
