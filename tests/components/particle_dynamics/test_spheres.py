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


def spheres(*given, **keys):
    made = tuple(Sphere(**({"radius": 0.01, "density": 1000.0} | one)) for one in given)
    return ParticleSpheres(ParticleSpheresParams(spheres=made, **keys))


def test_flight_under_constant_loads_is_exact_at_any_step():
    made = spheres({"centre": (0.0, 0.0, 1.0), "velocity": (2.0, 0.0, 3.0)}, gravity=G)
    mass = made.totals().mass
    made.take({"load.force": np.array([[mass, 0.0, 0.0]]), "heat.heat_flow": np.array([5.0])})
    for _ in range(3):
        made.step(0.1)
    found = made.give({"motion.position", "spheres.temperature"})
    exact = np.array([[0.6 + 0.5 * 0.09, 0.0, 1.0 + 0.9 - 0.5 * 9.81 * 0.09]])
    assert found["motion.position"] == pytest.approx(exact, abs=1e-14)
    assert found["spheres.temperature"][0] == pytest.approx(300.0 + 1.5 / (1000.0 * mass))


def test_a_torque_turns_a_sphere_by_its_moment_of_inertia():
    made = spheres({"centre": (0.0, 0.0, 0.0)})
    inertia = 0.4 * made.totals().mass * 0.01**2
    made.take({"load.torque": np.array([[0.0, 0.0, 2.0 * inertia]])})
    for _ in range(10):
        made.step(0.05)
    found = made.give({"motion.orientation", "motion.angular_velocity"})
    assert found["motion.angular_velocity"][0] == pytest.approx([0.0, 0.0, 1.0])
    half = 0.125  # rad, half of t2
    turned = [np.cos(half), 0.0, 0.0, np.sin(half)]
    assert found["motion.orientation"][0] == pytest.approx(turned, abs=1e-12)


def test_a_sphere_rests_until_it_is_launched_within_a_step():
    made = spheres({"centre": (0.0, 0.0, 0.0), "velocity": (1.0, 0.0, 0.0), "launch": 0.25})
    made.take({"load.force": np.array([[1.0, 0.0, 0.0]]) * 0.0})
    made.step(0.2)
    assert made.give({"motion.velocity"})["motion.velocity"][0, 0] == 0.0
    made.step(0.1)
    assert made.give({"motion.position"})["motion.position"][0, 0] == pytest.approx(0.05)
    made.step(0.1)
    assert made.give({"motion.position"})["motion.position"][0, 0] == pytest.approx(0.15)


@pytest.mark.parametrize("restitution", [0.0, 0.5, 1.0])
def test_impacts_keep_momentum_and_lose_what_restitution_says(restitution):
    made = spheres(
        {"centre": (0.0, 0.0, 0.0), "velocity": (1.0, 0.2, 0.0)},
        {"centre": (0.03, 0.0, 0.0), "velocity": (-1.0, 0.0, 0.0), "density": 3000.0},
        restitution=restitution,
    )
    start = made.totals()
    for _ in range(200):
        made.step(1e-4)
    end = made.totals()
    assert end.momentum == pytest.approx(start.momentum, abs=1e-15)
    assert end.angular_momentum == pytest.approx(start.angular_momentum, abs=1e-15)
    assert end.kinetic + end.internal == pytest.approx(start.kinetic, rel=1e-12)
    velocity = made.give({"motion.velocity"})["motion.velocity"]
    line = np.diff(made.give({"motion.position"})["motion.position"], axis=0)[0]
    apart = np.diff(velocity, axis=0)[0] @ line / np.linalg.norm(line)
    assert apart == pytest.approx(2.0 * restitution, abs=0.1)


def test_a_sphere_bounces_from_a_wall():
    made = spheres(
        {"centre": (0.0, 0.0, 0.1), "velocity": (0.5, 0.0, -1.0)},
        walls=(Wall(normal=(0.0, 0.0, 2.0)),),
        restitution=0.6,
    )
    for _ in range(1000):
        made.step(2e-4)
    assert made.give({"motion.velocity"})["motion.velocity"][0] == pytest.approx([0.5, 0.0, 0.6])


def crowd(restitution, spacing, gravity=(0.0, 0.0, 0.0)):
    """27 spheres at random velocities in a box of walls, `spacing` diameters apart."""
    random, side = np.random.default_rng(0), 3 * 0.02 * spacing
    places = (np.stack(np.meshgrid(*[np.arange(3)] * 3), -1).reshape(-1, 3) + 0.5) * side / 3
    given = [{"centre": tuple(x), "velocity": tuple(random.normal(size=3))} for x in places]
    normals = [tuple(sign * row) for row in np.eye(3) for sign in (1.0, -1.0)]
    walls = tuple(Wall(normal=n, offset=-side if sum(n) < 0.0 else 0.0) for n in normals)
    return spheres(*given, walls=walls, restitution=restitution, gravity=gravity)


def overlaps(made):
    """Largest overlap of two spheres of 0.02 m, over their diameter."""
    position = made.give({"motion.position"})["motion.position"]
    apart = np.linalg.norm(position[:, None] - position[None], axis=2)
    return 1.0 - apart[np.triu_indices(len(position), 1)].min() / 0.02


def advance(made, end):
    """Advance by natural steps; yield after each."""
    time = 0.0
    while time < end:
        dt = min(made.stable_dt(), end - time)
        made.step(dt)
        time += dt
        yield time


@pytest.mark.parametrize("restitution", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("spacing", [1.05, 1.5])
def test_spheres_overlap_by_less_than_1_percent_at_the_natural_step(restitution, spacing):
    made = crowd(restitution, spacing)
    start = made.totals()
    assert max(overlaps(made) for _ in advance(made, 0.2)) < 0.01
    end = made.totals()
    assert end.kinetic + end.internal == pytest.approx(start.kinetic, rel=1e-12)
    assert made.warnings() == {}


def test_impacts_have_their_own_times_within_a_step():
    made = spheres(
        {"centre": (0.0, 0.0, 0.0), "velocity": (1.0, 0.0, 0.0)},
        *({"centre": (0.0213 + 0.02 * k, 0.0, 0.0)} for k in range(5)),
        {"centre": (0.1250, 0.0, 0.0), "velocity": (0.5, 0.0, 0.0)},
    )
    for _ in range(7):
        made.step(1e-3)
    found = made.give({"motion.position", "motion.velocity"})
    # The first strikes the row after 1.3 ms; it stops, and the last of the row leaves with 1 m/s.
    exact = [0.0013, *(0.0213 + 0.02 * k for k in range(4)), 0.1013 + 0.0057, 0.1285]
    velocities = [0.0] * 5 + [1.0, 0.5]
    if exact[-1] - exact[-2] < 0.02:  # which then strikes the one before it
        late = (0.02 - (exact[-1] - exact[-2])) / 0.5
        exact[-2:] = exact[-2] - 0.5 * late, exact[-1] + 0.5 * late
        velocities[-2:] = 0.5, 1.0
    assert found["motion.position"][:, 0] == pytest.approx(exact, abs=1e-12)
    assert found["motion.velocity"][:, 0] == pytest.approx(velocities, abs=1e-12)


@pytest.mark.parametrize("step", [0.01, 0.1, 0.3])
def test_a_fall_and_a_bounce_are_exact_at_any_step(step):
    made = spheres({"centre": (0.0, 0.0, 1.01)}, walls=(Wall(normal=(0, 0, 1.0)),), gravity=G)
    fall = np.sqrt(2.0 / 9.81)  # s, one metre
    for k in range(round(0.6 / step)):
        made.step(step)
        time = (k + 1) * step
        since = time - fall
        height = 1.0 - 0.5 * 9.81 * time**2
        if since > 0.0:
            height = 9.81 * fall * since - 0.5 * 9.81 * since**2
        assert made.give({"motion.position"})["motion.position"][0, 2] == pytest.approx(
            height + 0.01, abs=1e-12
        )


def test_spheres_that_fall_meet_though_they_are_at_rest_at_the_start():
    made = spheres(
        {"centre": (0.0, 0.0, 0.0), "launch": 10.0}, {"centre": (0.0, 0.0, 0.5)}, gravity=G
    )
    list(advance(made, 1.0))
    assert made.give({"motion.position"})["motion.position"][1, 2] >= 0.02 * 0.99


def test_a_pile_that_hard_spheres_cannot_make_is_warned_of():
    made = crowd(0.5, 1.05, G)
    deepest = max(overlaps(made) for _ in advance(made, 0.3))
    assert deepest > 0.01
    (said,) = made.warnings().values()
    assert "spheres overlapped by up to" in said and "Take dem_bodies" in said
    again = crowd(0.5, 1.05, G)
    again.load(made.save())
    assert again.warnings() == made.warnings()


def test_spheres_that_begin_within_another_are_refused():
    places = [(0.1, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.017)]
    given = [{"centre": one, "launch": 0.1 * k} for k, one in enumerate(places)]
    said = r"centres of 1 and 2 must be 0.018 m apart .* found 0.017 m. Move them apart"
    with pytest.raises(SceneError, match=said):
        spheres(*given)
    spheres(*given, collisions=False)
    spheres(given[1], given[2] | {"centre": (0.0, 0.0, 0.0181)})  # a tenth may overlap
    twice = {"centre": (0.0, 0.0, 0.0), "copies": Copies(number=(2, 1, 1), spacing=(0.01,) * 3)}
    with pytest.raises(SceneError, match=r"0 and 1 must be 0.018 m apart .* found 0.01 m"):
        spheres(twice)


@pytest.mark.parametrize(("height", "found"), [(-0.2, "-0.7 m"), (0.505, "0.005 m")])
def test_spheres_that_begin_behind_a_wall_are_refused(height, found):
    walls = Wall(normal=(1.0, 0.0, 0.0), offset=-1.0), Wall(normal=(0.0, 0.0, 2.0), offset=0.5)
    said = rf"walls.1: the centre of sphere 1 must be 0.009 m in front .* found {found}. Move"
    with pytest.raises(SceneError, match=said):
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
        made = spheres(
            {"centre": (1.0, 0.0, 0.0), "velocity": (0.0, 2.0, 0.0), "tether": 3.0},
            integrator=integrator,
        )
        mass = made.totals().mass
        frequency = np.sqrt(3.0 / mass)
        end, swing = 3.1 * np.pi / frequency, 2.0 / frequency
        made.take({"load.force": np.array([[3.0 * swing, 0.0, 0.0]])})
        for _ in range(steps):
            made.step(end / steps)
        turned = frequency * end
        exact = [1.0 + swing * (1.0 - np.cos(turned)), swing * np.sin(turned), 0.0]
        found = made.give({"motion.position"})["motion.position"][0]
        errors.append(np.abs(found - exact).max() / swing)
    assert errors[-1] < finest
    assert _orders(errors) == pytest.approx(order, abs=0.15)


@pytest.mark.parametrize("integrator", ["velocity_verlet", "yoshida"])
def test_energy_of_a_tethered_sphere_swings_and_does_not_drift(integrator):
    made = spheres(
        {"centre": (0.0, 0.0, 0.0), "velocity": (0.0, 2.0, 0.0), "tether": 3.0},
        integrator=integrator,
        courant=0.3,
    )
    dt = made.stable_dt()
    assert dt == pytest.approx(0.3 * LIMIT[integrator] / np.sqrt(3.0 / made.totals().mass))
    energies = []
    for _ in range(2000):
        made.step(dt)
        total = made.totals()
        energies.append(total.kinetic + total.potential)
    assert np.ptp(energies) < 0.1 * energies[0]
    assert np.ptp(energies[1000:]) == pytest.approx(np.ptp(energies[:1000]), rel=1e-2)


def test_a_sphere_whose_axis_turns_is_followed_to_fourth_order():
    """A torque across the spin, against ten thousand short turns about the spin of the middle."""
    spin, turning, end = np.array([0.0, 0.0, 3.0]), np.array([2.0, 1.0, 0.0]), 1.0
    exact = np.array([[1.0, 0.0, 0.0, 0.0]])
    h = 1e-4
    for step in range(10_000):
        angle = h * (spin + turning * (step + 0.5) * h)
        exact = rotation.product(rotation.exponential(angle[None]), exact)
    errors = []
    for steps in (4, 8, 16):
        made = spheres({"centre": (0.0, 0.0, 0.0), "angular_velocity": tuple(spin)})
        inertia = 0.4 * made.totals().mass * 0.01**2
        made.take({"load.torque": inertia * turning[None]})
        for _ in range(steps):
            made.step(end / steps)
        errors.append(np.abs(made.give({"motion.orientation"})["motion.orientation"] - exact).max())
    assert _orders(errors) == pytest.approx(4.0, abs=0.2)


def test_cells_find_the_pairs_that_a_look_at_all_finds():
    random = np.random.default_rng(3)
    position = random.uniform(0.0, 1.0, (300, 3))
    position[5] = [1e9, -3e8, 0.0]  # beyond the numbered cells
    position[6] = [1e9, -3e8, 0.01]
    radius = random.uniform(0.01, 0.06, 300)
    near = NearPairs(radius)
    begin, other = near.at(position)
    found = {(i, int(j)) for i in range(300) for j in other[begin[i] : begin[i + 1]]}
    apart = np.linalg.norm(position[:, None] - position, axis=-1)
    overlap = np.argwhere(np.triu(apart < radius[:, None] + radius, 1))
    assert len(overlap) > 50
    assert {tuple(one) for one in overlap.tolist()} <= found
    assert all(np.all(np.diff(other[begin[i] : begin[i + 1]]) > 0) for i in range(300))
    along = np.array([1.0, 0.0, 0.0])
    near.at(position + 0.49 * near.skin * along)
    assert np.array_equal(near.listed, position)  # not yet outworn
    near.at(position + 0.51 * near.skin * along)
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

    one, other = gas(), gas()
    for step in range(60):
        one.step(1e-3)
        other.step(1e-3)
        if step % 7 == 0:
            kept, other = other.save(), gas()
            other.load(kept)
    assert one.totals().internal > 0.0
    for key, array in one.save().items():
        assert np.array_equal(array, other.save()[key]), key


def test_copies_are_launched_one_after_another():
    made = spheres(
        {
            "centre": (0.0, 0.0, 0.0),
            "velocity": (0.0, 0.0, 1.0),
            "copies": Copies(number=(3, 1, 1), spacing=(0.1, 0.1, 0.1), interval=0.5),
        }
    )
    for _ in range(6):
        made.step(0.2)
    position = made.give({"motion.position"})["motion.position"]
    assert position[:, 0] == pytest.approx([0.0, 0.1, 0.2])
    assert position[:, 2] == pytest.approx([1.2, 0.7, 0.2])


def test_a_parcel_moves_as_one_of_its_spheres():
    keys = {"centre": (0.0, 0.0, 0.0), "angular_velocity": (0.0, 1.0, 0.0)}
    one = spheres(keys)
    many = spheres(keys | {"parcel": 1e4}, collisions=False)
    load = {
        "load.force": np.array([[1.0, 2.0, 0.0]]),
        "load.torque": np.array([[0.0, 0.0, 1e-4]]),
        "heat.heat_flow": np.array([3.0]),
    }
    one.take(load)
    many.take({key: 1e4 * array for key, array in load.items()})
    assert many.describe()["spheres.number"] == 1e4
    for made in (one, many):
        made.step(0.01)
    for key, array in one.save().items():
        if key not in ("force", "torque", "heat", "sums"):
            assert many.save()[key] == pytest.approx(array, rel=1e-12, abs=1e-15), key
    assert many.totals().kinetic == pytest.approx(1e4 * one.totals().kinetic)
    with pytest.raises(ValueError, match="collisions = false"):
        spheres(keys | {"parcel": 2.0})


def test_no_sphere_may_cross_another_in_a_step():
    made = spheres(
        {"centre": (0.0, 0.0, 0.0), "velocity": (10.0, 0.0, 0.0)},
        {"centre": (0.0, 1.0, 0.0), "velocity": (9.0, 0.0, 0.0)},
    )
    assert made.stable_dt() == pytest.approx(0.25 * 0.02 / 1.0)
    walled = spheres(
        {"centre": (0.0, 0.0, 1.0), "velocity": (0.0, 0.0, -4.0)},
        walls=(Wall(normal=(0.0, 0.0, 1.0)),),
    )
    assert walled.stable_dt() == pytest.approx(0.25 * 0.02 / 4.0)
