"""Many spheres: threads, sorting, single contacts, and laws of material pairs."""

import numpy as np
import pytest
from dem_scenes import FLOOR, box, build, energy, material, mistakes, run, sphere

from quintet.components.dem_bodies import MANIFEST
from quintet.components.dem_bodies.bench import lattice
from quintet.components.dem_bodies.component import DemBodies
from quintet.components.dem_bodies.diagnostics import deepest_pair
from quintet.components.dem_bodies.params import DemBodiesParams
from quintet.components.dem_bodies.state import DEEPEST
from quintet.interfaces.component import outputs_of
from quintet.interfaces.params import read


def crowd(seed=0, count=9000, others=(), threads=1, **changes):
    """Spheres on a loose lattice in random order and motion, above a corner."""
    random = np.random.default_rng(seed)
    size = int(np.ceil(count ** (1 / 3)))
    places = np.stack(np.meshgrid(*[np.arange(size)] * 3), axis=-1).reshape(-1, 3)[:count]
    places = random.permutation(places)
    bodies = [
        sphere(x.tolist(), 0.01, velocity=v.tolist())
        for x, v in zip((places + 0.5) * 0.0101, random.normal(size=places.shape), strict=True)
    ]
    normals = np.eye(3).tolist()
    materials = {"a": material(youngs_modulus=5e6, friction=0.5, **changes)}
    planes = [FLOOR | {"normal": n} for n in normals]
    return build(
        [*bodies, *others],
        materials,
        planes=planes,
        impact_speed=2.0,
        contact_forces=True,
        threads=threads,
    )


@pytest.fixture(scope="module")
def mixed_crowd():
    """A crowd after collisions and new listings; its rows are not in the bodies' order."""
    scene = crowd()
    run(scene, 4e-3, dt=2e-5)
    return scene


def assert_same_bits(first, second):
    for name, array in first.save().items():
        np.testing.assert_array_equal(array, second.save()[name], err_msg=name)


def test_threads_change_no_bit(mixed_crowd):
    shared = crowd(threads=2)
    assert shared.stepping.team.size == 2 and mixed_crowd.stepping.team.size == 1
    run(shared, 4e-3, dt=2e-5)
    assert_same_bits(mixed_crowd, shared)


def test_threads_change_no_bit_of_what_resists_rolling_beside_a_box():
    """With a box, blocks of rows wait for it before their velocities are updated."""
    falling_box = box([0.1, 0.1, 0.263], (0.2, 0.2, 0.1), velocity=[0.0, 0.0, -2.0])
    scenes = []
    for threads in (1, 2):
        scenes.append(crowd(threads=threads, others=(falling_box,), rolling_friction=0.2))
        run(scenes[-1], 1.2e-3, dt=2e-5)
    assert [scene.stepping.team.size for scene in scenes] == [1, 2]
    lists = scenes[0].lists
    assert len(lists.bodies.key) > 10 and np.abs(lists.balls.rolling_moment).max() > 0.0
    assert_same_bits(*scenes)


def test_energy_and_contacts_of_many_are_as_summed_one_by_one(mixed_crowd):
    contacts, m = mixed_crowd.contact_points(), mixed_crowd.count
    i, j = contacts["bodies"].T
    assert len(i) > 1000 and (j == m).sum() > 10  # also on planes
    forces = np.zeros((m + 1, 3))
    np.add.at(forces, i, contacts["force"])
    np.add.at(forces, j, -contacts["force"])
    scale = np.abs(forces).max()
    assert (mixed_crowd.state.body[:m] != np.arange(m)).mean() > 0.9
    np.testing.assert_allclose(
        forces[mixed_crowd.state.body], mixed_crowd.state.contact_load[:, :3], atol=1e-12 * scale
    )
    x = outputs_of(mixed_crowd)["motion.position"]
    distance = np.linalg.norm(x[i[j < m]] - x[j[j < m]], axis=1)
    np.testing.assert_allclose(contacts["depth"][j < m], 0.01 - distance, atol=1e-12)


def test_deepest_of_many_is_the_one_that_is_told(mixed_crowd):
    contacts, report = mixed_crowd.contact_points(), mixed_crowd.state.report
    k = int(np.argmax(contacts["depth"]))
    assert report[DEEPEST] == pytest.approx(contacts["depth"][k] / 0.005, rel=1e-6)
    i, j = deepest_pair(mixed_crowd.state, mixed_crowd.lists.balls, mixed_crowd.lists.bodies)
    assert [i, min(j, mixed_crowd.count)] == contacts["bodies"][k].tolist()


def test_all_that_touch_are_listed(mixed_crowd):
    """Compared with an independent search by a k-d tree."""
    from scipy.spatial import KDTree

    x = outputs_of(mixed_crowd)["motion.position"]
    expected = {tuple(sorted(pair)) for pair in KDTree(x).query_pairs(0.01 * (1.0 - 1e-9))}
    listed = mixed_crowd.contact_points()["bodies"]
    assert {
        tuple(sorted(pair)) for pair in listed[listed[:, 1] < mixed_crowd.count].tolist()
    } == expected
    assert len(expected) > 1000


def test_many_go_on_with_the_same_bits_when_loaded(mixed_crowd):
    saved = mixed_crowd.save()
    run(mixed_crowd, 4e-4, dt=2e-5)
    expected = mixed_crowd.save()
    fresh = crowd(seed=5)
    fresh.load(saved)
    run(fresh, 4e-4, dt=2e-5)
    for name, array in fresh.save().items():
        np.testing.assert_array_equal(array, expected[name], err_msg=name)
    mixed_crowd.load(saved)


def test_listing_anew_changes_no_contact():
    """Listing in every step keeps the contact history, also that of swapped rows."""
    ends = []
    for every_step in (False, True):
        scene = crowd(count=600, rolling_friction=0.1, restitution=0.8)
        start = energy(scene)
        for _ in range(200):
            if every_step:
                scene.state.listed_centre[:] = 1e9
            scene.step(2e-5)
        assert energy(scene) + scene.accumulated.dissipated == pytest.approx(start, rel=1e-6)
        ends.append(outputs_of(scene)["motion.position"])
    np.testing.assert_allclose(ends[0], ends[1], atol=1e-9)


def pushed_pile(speed_y):
    """A box that slides on four spheres; all move along y over a frictionless floor."""
    places = [(-0.11, -0.11), (-0.107, 0.105), (0.104, -0.106), (0.11, 0.107)]
    bodies = [box([0.0, 0.0, 0.26], (0.3, 0.3, 0.1), velocity=[0.2, speed_y, 0.0])]
    bodies += [sphere([x, y, 0.105], 0.21, velocity=[0.0, speed_y, 0.0]) for x, y in places]
    materials = {
        "a": material(youngs_modulus=1e7, friction=0.5),
        "ice": material(youngs_modulus=1e7, friction=0.0),
    }
    floor = FLOOR | {"material": "ice"}
    return build(bodies, materials, planes=[floor], impact_speed=0.5)


def test_rows_that_change_places_keep_their_contacts_with_boxes():
    """The same pile at rest, and moving through the cells that sort the rows."""
    still, moving = pushed_pile(0.0), pushed_pile(2.0)
    orders, dt = set(), 0.5 * still.stable_dt()
    steps = int(0.3 / dt)
    for _ in range(steps):
        still.step(dt)
        moving.step(dt)
        orders.add(tuple(moving.state.body.tolist()))
    assert len(orders) > 1
    positions = outputs_of(moving)["motion.position"] - [0.0, 2.0 * steps * dt, 0.0]
    np.testing.assert_allclose(positions, outputs_of(still)["motion.position"], atol=1e-7)
    assert outputs_of(still)["motion.velocity"][0, 0] < 0.19  # friction slowed the box
    spins = [outputs_of(scene)["motion.angular_velocity"] for scene in (still, moving)]
    np.testing.assert_allclose(*spins, atol=1e-5)


def test_contact_forces_of_a_block_at_rest_are_its_weight():
    materials, settings = (
        {"a": material(youngs_modulus=1e7)},
        {"planes": [FLOOR], "contact_forces": True},
    )
    cube = build([box([0.0, 0.0, 0.075])], materials, impact_speed=0.5, **settings)
    run(cube, 1.5)
    contacts, weight = cube.contact_points(), 9.81 * cube.mass[0]
    assert len(contacts["depth"]) == 4 and (contacts["depth"] > 0.0).all()
    np.testing.assert_array_equal(contacts["bodies"], np.tile([0, 1], (4, 1)))
    np.testing.assert_allclose(
        contacts["force"].sum(axis=0), [0.0, 0.0, weight], atol=1e-5 * weight
    )
    np.testing.assert_array_equal(contacts["force"].sum(axis=0), cube.state.contact_load[0, :3])
    np.testing.assert_allclose(contacts["point"][:, 2], -0.5 * contacts["depth"], atol=1e-9)
    np.testing.assert_allclose(cube.state.contact_load[1, :3], -cube.state.contact_load[0, :3])


def test_spheres_and_a_box_stand_on_each_other():
    bodies = [box([0.0, 0.0, 0.26], (0.3, 0.3, 0.1))]
    bodies += [sphere([x, y, 0.105], 0.21) for x in (-0.11, 0.11) for y in (-0.11, 0.11)]
    pile = build(
        bodies, {"a": material(youngs_modulus=1e8, friction=0.5)}, planes=[FLOOR], impact_speed=0.5
    )
    run(pile, 1.0)
    weight = 9.81 * pile.mass.sum()
    assert pile.state.contact_load[-1, 2] == pytest.approx(-weight, rel=1e-3)
    assert outputs_of(pile)["motion.position"][0, 2] == pytest.approx(0.26, abs=1e-3)


def test_restitution_follows_the_pair():
    materials = {
        "a": material(youngs_modulus=1e9, restitution=0.9),
        "b": material(youngs_modulus=1e9, restitution=0.5),
    }
    laws = [{"between": ["b", "a"], "restitution": 0.8}]
    settings = {
        "planes": [FLOOR | {"material": "b"}],
        "gravity": [0.0, 0.0, 0.0],
        "impact_speed": 1.0,
    }
    for pairs, expected in (([], 0.5), (laws, 0.8)):
        body = sphere([0.0, 0.0, 0.0101], velocity=[0.0, 0.0, -1.0])
        ball = build([body], materials, pairs=pairs, **settings)
        run(ball, 1e-3)
        assert outputs_of(ball)["motion.velocity"][0, 2] == pytest.approx(expected, rel=5e-3)


@pytest.mark.parametrize(
    ("pairs", "sentence"),
    [
        ([{"between": ["a", "a"]}], "pairs[0] must set friction, restitution or rolling_friction"),
        (
            [
                {"between": ["a", "b"], "rolling_friction": 0.1},
                {"between": ["b", "a"], "friction": 0.1},
            ],
            "pairs[1] must be of other materials than pairs[0]; found b and a in both",
        ),
        ([{"between": ["a", "a"], "friction": -0.1}], "pairs.0.friction"),
    ],
)
def test_wrong_pairs_are_refused(pairs, sentence):
    materials = {"a": material(), "b": material()}
    messages = mistakes([sphere([0.0, 0.0, 0.0])], materials=materials, pairs=pairs)
    assert sentence in " ".join(messages)


def test_benchmark_touches_its_six_neighbours():
    assert {case.unit for case in MANIFEST.cases()} == {"sphere-steps/s"}
    params, errors = read(DemBodiesParams, lattice(6, 6, 6), "bodies")
    assert not errors
    scene = DemBodies(params)
    for _ in range(20):
        scene.step(scene.stable_dt())
    assert np.count_nonzero(scene.lists.balls.history[3]) == 3 * 6 * 6 * 5 + 3 * 6 * 6
    with pytest.raises(ValueError, match=r"contact_forces must be true.*found false\. Set it"):
        scene.contact_points()
