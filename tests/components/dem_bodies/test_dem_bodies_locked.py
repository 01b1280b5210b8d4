"""Locked degrees of freedom keep their velocity; free ones conserve momentum and energy."""

import re

import numpy as np
import pytest
from dem_scenes import FLOOR, NOTHING, about, box, build, energy, material, mistakes, run, sphere

from quintet.interfaces.component import outputs_of

DIRECTIONS = ["x", "y", "z", "rotation_x", "rotation_y", "rotation_z"]
SLENDER = (0.3, 0.2, 0.1)  # m
TURNED = about([1.0, 2.0, 0.5], 0.7)
LOCKS = [
    ["x"],
    ["y", "rotation_x"],
    ["rotation_z"],
    ["rotation_x", "rotation_z"],
    ["x", "z", "rotation_x", "rotation_y", "rotation_z"],
]


def motion(body):
    """Velocity and angular velocity (6,)."""
    outputs = outputs_of(body)
    return np.append(outputs["motion.velocity"][0], outputs["motion.angular_velocity"][0])


def momenta(body):
    """Momentum and angular momentum about the centre (6,) [kg m/s, kg m²/s]."""
    totals, position = body.totals(), outputs_of(body)["motion.position"][0]
    return np.append(totals.momentum, totals.angular_momentum - np.cross(position, totals.momentum))


@pytest.mark.parametrize("locked", LOCKS)
def test_only_what_is_free_answers_a_load_and_momentum_is_its_impulse(locked):
    free = np.array([direction not in locked for direction in DIRECTIONS])
    body = build(
        [box([0.0, 0.0, 1.0], SLENDER, orientation=TURNED, locked=locked)], gravity=NOTHING
    )
    load = np.array([1.0, -2.0, 3.0, 0.3, 0.2, -0.1])
    body.take({"load.force": load[None, :3], "load.torque": load[None, 3:]})
    times = []
    run(body, 0.3, times.append, dt=1e-3)
    assert (motion(body)[~free] == 0.0).all()
    np.testing.assert_allclose(momenta(body)[free], 0.3 * load[free], rtol=1e-12)
    assert body.accumulated.load_work == pytest.approx(body.totals().kinetic, rel=1e-4)
    body.take({})
    before = momenta(body)
    run(body, 0.1, dt=1e-3)
    np.testing.assert_allclose(momenta(body)[free], before[free], rtol=1e-13)


@pytest.mark.parametrize("locked", LOCKS)
def test_a_free_flight_with_locks_keeps_its_energy(locked):
    free = np.array([direction not in locked for direction in DIRECTIONS])
    velocity, ω = np.split(free * np.array([0.3, 0.2, 0.1, 3.0, 4.0, 5.0]), 2)
    properties = {"velocity": velocity.tolist(), "angular_velocity": ω.tolist(), "locked": locked}
    body = build([box([0.0, 0.0, 1.0], SLENDER, orientation=TURNED, **properties)], gravity=NOTHING)
    start, energies = energy(body), []
    run(body, 1.0, lambda _: energies.append(energy(body)), dt=1e-3)
    np.testing.assert_allclose(energies, start, rtol=2e-5)
    assert (motion(body)[~free] == 0.0).all()


def test_a_door_swings_about_its_locked_axis_as_a_pendulum_does():
    """All translations and two rotations are locked: T = I α about the third alone."""
    locked = ["x", "y", "z", "rotation_x", "rotation_z"]
    door = build([box(NOTHING, SLENDER, orientation=TURNED, locked=locked)])
    turn = outputs_of(door)["motion.orientation"][0]
    w, x, y, z = turn
    matrix = np.array(
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)]
    )  # row y
    size, mass = np.array(SLENDER), door.mass[0]
    moment = float(matrix**2 @ ((size**2).sum() - size**2)) / 12.0 * mass
    door.take({"load.force": np.zeros((1, 3)), "load.torque": np.array([[5.0, 0.02, -3.0]])})
    run(door, 0.5, dt=1e-3)
    np.testing.assert_allclose(
        motion(door), [0.0, 0.0, 0.0, 0.0, 0.5 * 0.02 / moment, 0.0], rtol=1e-12
    )


def test_a_locked_sphere_meets_the_floor_with_the_restitution_of_its_material():
    materials = {"a": material(restitution=0.6, friction=0.0)}
    speeds = []
    for locked in ([], ["x", "rotation_y"]):
        ball = sphere([0.0, 0.0, 0.0501], 0.1, velocity=[0.0, 0.0, -1.0], locked=locked)
        scene = build([ball], materials, gravity=NOTHING, planes=[FLOOR])
        run(scene, 0.01)
        speeds.append(outputs_of(scene)["motion.velocity"][0, 2])
    np.testing.assert_allclose(speeds, 0.6, rtol=5e-3)


def test_a_rail_at_a_slant_bears_as_the_part_that_can_yield():
    """A sphere free along x alone meets a slope of 45°: it rebounds along x with restitution e."""
    materials = {"a": material(restitution=0.6, friction=0.0, youngs_modulus=1e9)}
    slope = FLOOR | {"normal": [-1.0, 0.0, 1.0]}
    ball = sphere([-0.0710, 0.0, 0.0], 0.1, velocity=[1.0, 0.0, 0.0])
    ball["locked"] = ["y", "z", "rotation_x", "rotation_y", "rotation_z"]
    scene = build([ball], materials, gravity=NOTHING, planes=[slope])
    run(scene, 0.01)
    assert outputs_of(scene)["motion.velocity"][0] == pytest.approx([-0.6, 0.0, 0.0], rel=5e-3)


def test_a_plate_in_any_pose_is_a_finite_wall():
    """Six locks fix the plate; a ball slides down it without friction and falls off its end."""
    tilt = about([0.0, 1.0, 0.0], np.pi / 6.0)
    plate = box(NOTHING, (1.0, 0.5, 0.02), orientation=tilt, locked=DIRECTIONS)
    normal, down = np.array([0.5, 0.0, 0.75**0.5]), np.array([0.75**0.5, 0.0, -0.5])
    materials = {"a": material(friction=0.0, restitution=0.2, youngs_modulus=1e9)}
    ball = sphere((0.06 * normal).tolist(), 0.1)
    scene = build([plate, ball], materials, impact_speed=0.2)
    run(scene, 0.2)
    outputs = outputs_of(scene)
    assert outputs["motion.velocity"][1] @ down == pytest.approx(9.81 * 0.5 * 0.2, rel=1e-3)
    assert abs(outputs["motion.velocity"][1] @ normal) < 1e-2
    run(scene, 0.5)
    position = outputs_of(scene)["motion.position"][1]
    assert position @ down > 0.6 and position @ normal < 0.0
    for key in ("motion.position", "motion.velocity", "motion.angular_velocity"):
        assert (outputs_of(scene)[key][0] == 0.0).all()


def test_a_piston_keeps_the_velocity_it_is_given_and_pushes_what_is_before_it():
    piston = box([-0.15, 0.0, 0.1], velocity=[0.2, 0.0, 0.0], locked=DIRECTIONS)
    cube = box([0.001, 0.0, 0.0751])
    materials = {"a": material(youngs_modulus=1e8, restitution=0.1, friction=0.1)}
    scene = build([piston, cube], materials, planes=[FLOOR], impact_speed=0.3)
    run(scene, 1.0)
    outputs = outputs_of(scene)
    np.testing.assert_array_equal(outputs["motion.velocity"][0], [0.2, 0.0, 0.0])
    assert outputs["motion.position"][0, 0] == pytest.approx(0.05, rel=1e-12)
    assert outputs["motion.velocity"][1, 0] == pytest.approx(0.2, rel=1e-2)


def test_a_drum_turns_evenly_and_takes_along_what_lies_on_it():
    motion = {"angular_velocity": [0.0, 2.0, 0.0], "locked": DIRECTIONS}
    drum = sphere([0.0, 0.0, 0.2], 0.4, **motion)
    ball = sphere([0.0, 0.0, 0.4501], 0.1)
    materials = {"a": material(youngs_modulus=1e8, restitution=0.1, friction=0.5)}
    scene = build([drum, ball], materials, impact_speed=0.3)
    run(scene, 0.05)
    outputs = outputs_of(scene)
    np.testing.assert_array_equal(outputs["motion.angular_velocity"][0], [0.0, 2.0, 0.0])
    half = 0.05 * 2.0 / 2.0
    np.testing.assert_allclose(
        outputs["motion.orientation"][0], [np.cos(half), 0.0, np.sin(half), 0.0], atol=1e-12
    )
    assert outputs["motion.velocity"][1, 0] > 0.05


def test_what_rests_between_locked_bodies_is_borne_by_them():
    """Two locked plates lie on each other; the upper one carries a cube's weight."""
    plates = [box([0.0, 0.0, z], (0.5, 0.5, 0.1), locked=DIRECTIONS) for z in (0.05, 0.15)]
    scene = build([*plates, box([0.0, 0.0, 0.2751])], planes=[FLOOR], contact_forces=True)
    run(scene, 0.5)
    force = outputs_of(scene)["contact.force"][:, 2]
    assert force[2] == pytest.approx(9.81 * scene.mass[2], rel=1e-3)
    assert force[1] == pytest.approx(-9.81 * scene.mass[2], rel=1e-3)


def test_saved_and_loaded_a_locked_body_goes_on_with_the_same_bits():
    body = box([0.0, 0.0, 0.3], SLENDER, orientation=TURNED, locked=["x", "rotation_z"])
    scene = build([body], {"a": material(youngs_modulus=1e9)}, planes=[FLOOR])
    run(scene, 0.2)
    saved = scene.save()
    run(scene, 0.1)
    expected = scene.save()
    scene.load(saved)
    run(scene, 0.1)
    for name, array in scene.save().items():
        np.testing.assert_array_equal(array, expected[name], err_msg=name)


@pytest.mark.parametrize(
    ("properties", "pattern"),
    [
        ({"locked": ["x", "x"]}, r"bodies\[0\].locked must name each direction once; found x, x"),
        ({"locked": ["w"]}, "rotation_x"),
        (
            {"locked": ["rotation_x"], "angular_velocity": [1.0, 0.0, 0.0]},
            r"bodies\[0\].angular_velocity must be 0 about x, which is locked; found 1 rad/s",
        ),
    ],
)
def test_locks_that_contradict_themselves_are_refused(properties, pattern):
    text = " ".join(mistakes([box(NOTHING, **properties)]))
    assert re.search(pattern, text), text
