"""Stiff, fast, crowded and lost bodies: the run stays stable or ends with an error."""

import math
import time

import numpy as np
import pytest
from dem_scenes import FLOOR, NOTHING, about, box, build, energy, material, run, sphere

from quintet.components.dem_bodies.contact.materials import DURATION
from quintet.components.dem_bodies.laws import DAMPING
from quintet.components.dem_bodies.state import DEEPEST, DEEPEST_PAIR
from quintet.interfaces.component import outputs_of
from quintet.interfaces.errors import StepError

STIFF = [3.0e9, 6.5e10, 2.1e11]  # Pa: plastic, glass, steel
RADIUS = 0.05  # m


def dropped_ball(young, speed, restitution, **settings):
    """A ball that is about to touch the floor, without weight."""
    body = sphere([0.0, 0.0, RADIUS + 1e-6], 2 * RADIUS, velocity=[0.0, 0.0, -speed])
    materials = {"a": material(youngs_modulus=young, restitution=restitution)}
    return build([body], materials, gravity=NOTHING, planes=[FLOOR], impact_speed=speed, **settings)


def hertz_depth(ball, young, speed, share=1.0):
    """Deepest overlap [m] of an elastic impact (Johnson, Contact Mechanics (1985), 11.23).

    `share` is 1 on the floor; m* and R* are half as large where two such balls meet.
    """
    mass, radius = share * ball.mass[0], share * RADIUS
    modulus = young / (2.0 * (1.0 - 0.3**2))
    return (15.0 * mass * speed**2 / (16.0 * modulus * math.sqrt(radius))) ** 0.4


@pytest.mark.parametrize("young", STIFF)
@pytest.mark.parametrize("speed", [1.0, 20.0])
def test_overlap_is_hertzs_up_to_steel_and_20_metres_per_second(young, speed):
    ball = dropped_ball(young, speed, 1.0)
    depth, deepest = hertz_depth(ball, young, speed), [0.0]
    start, energies = energy(ball), []

    def watch(_):
        deepest.append(ball.state.report[DEEPEST] * RADIUS)
        energies.append(energy(ball))

    run(ball, 4.0 * depth / speed, watch)
    assert max(deepest) == pytest.approx(depth, rel=2e-3)
    assert max(energies) < start * (1.0 + 1e-3)  # a temporary error of the time step
    assert energies[-1] == pytest.approx(start, rel=2e-4)


@pytest.mark.parametrize("young", STIFF)
@pytest.mark.parametrize("speed", [1.0, 20.0])
def test_energy_never_grows_where_contacts_damp(young, speed):
    ball = dropped_ball(young, speed, 0.6)
    energies = [energy(ball)]
    run(
        ball, 5.0 * hertz_depth(ball, young, speed) / speed, lambda _: energies.append(energy(ball))
    )
    assert ball.state.report[DEEPEST_PAIR] == -1  # apart again
    assert np.diff(energies).max() <= 0.0
    assert energies[-1] == pytest.approx(0.36 * energies[0], rel=5e-3)


@pytest.mark.parametrize("young", STIFF)
def test_the_step_is_the_stated_share_of_the_quickest_impact(young):
    """The quickest impact is that of two balls, even if the scene has only one."""
    ball = dropped_ball(young, 20.0, 1.0)
    duration = DURATION * hertz_depth(ball, young, 20.0, 0.5) / 20.0
    steps = []
    run(ball, 1.2 * duration, lambda _: steps.append(ball.stable_dt()))
    assert min(steps) == pytest.approx(duration / 40, rel=1e-2)


@pytest.mark.parametrize("orientation", [[1.0, 0.0, 0.0, 0.0], about([1, -1, 0], 0.9553166)])
def test_a_steel_cube_dropped_at_20_metres_per_second_only_loses_energy(orientation):
    """On its face, and on its corner."""
    height = 0.0751 if orientation[0] == 1.0 else 0.1301
    body = box([0.0, 0.0, height], orientation=orientation, velocity=[0.0, 0.0, -20.0])
    materials = {"a": material(youngs_modulus=2.1e11, restitution=0.6)}
    cube = build([body], materials, gravity=NOTHING, planes=[FLOOR], impact_speed=20.0)
    energies = [energy(cube)]
    run(cube, 2e-3, lambda _: energies.append(energy(cube)))
    assert outputs_of(cube)["motion.velocity"][0, 2] == pytest.approx(12.0, rel=5e-2)
    assert np.diff(energies).max() <= 0.0


def test_an_impact_too_hard_for_hertz_is_refused():
    """A plastic cube at 20 m/s sinks in by half the radius of its corners."""
    materials = {"a": material(youngs_modulus=3e9, restitution=0.6)}
    body = box([0.0, 0.0, 0.0751], velocity=[0.0, 0.0, -20.0])
    cube = build([body], materials, planes=[FLOOR], impact_speed=20.0)
    with pytest.raises(
        StepError, match=r"body 0 with a plane is 0\.5.*Increase youngs_modulus or edge_radius"
    ):
        run(cube, 1e-3)


def swing(young, restitution, step):
    """Growth of the speed of a ball that is nudged on the floor; `step` in 1/ω of its contact.

    Returns the largest speed within 400 steps over that of the nudge, and ζ.
    """
    materials = {"a": material(youngs_modulus=young, restitution=restitution, friction=0.0)}
    ball = build([sphere([0.0, 0.0, RADIUS], 2 * RADIUS)], materials, planes=[FLOOR])
    modulus, ζ = ball.model.material_pairs[0, 0, 0], ball.limit.damping
    weight = 9.81 * ball.mass[0]
    depth = (0.75 * weight / (modulus * math.sqrt(RADIUS))) ** (2.0 / 3.0)
    ω = math.sqrt(2.0 * modulus * math.sqrt(RADIUS * depth) / ball.mass[0])
    ball.state.position[0, 2] = RADIUS - depth
    ball.step(0.0)  # the contact comes to bear the weight
    nudge = 1e-5 * ω * depth
    ball.state.velocity[0, 2] = nudge
    speeds = []
    run(ball, 400 * step / ω, lambda _: speeds.append(abs(ball.state.velocity[0, 2])), step / ω)
    return max(speeds) / nudge, ζ


@pytest.mark.parametrize("young", STIFF)
@pytest.mark.parametrize("restitution", [1.0, 0.5, 0.1])
def test_the_limit_of_the_step_is_where_it_is_predicted(young, restitution):
    """γ dt + (ω dt)²/4 = 1 with γ = 2√(5/6) ζ ω: 2/ω without a damper; stable below, not above."""
    γ = DAMPING * swing(young, restitution, 0.01)[1]  # over ω
    limit = 2.0 * (math.sqrt(γ * γ + 1.0) - γ)  # over 1/ω
    assert swing(young, restitution, 0.97 * limit)[0] < 2.0
    assert swing(young, restitution, 1.03 * limit)[0] > 100.0


def test_many_dampers_on_one_body_are_stable():
    """A slab of 64 strongly damped spheres lies on the floor, which carries its weight."""
    centres = [[0.03 * i, 0.03 * j, 0.0] for i in range(8) for j in range(8)]
    slab = {"shape": "spheres", "centres": centres, "radii": [0.0125] * 64, "material": "a"}
    slab |= {"density": 800.0, "origin": [-0.105, -0.105, 0.0126]}
    materials = {"a": material(youngs_modulus=1e7, restitution=0.05)}
    body = build([slab], materials, planes=[FLOOR], impact_speed=0.5, contact_forces=True)
    run(body, 0.3)
    assert outputs_of(body)["contact.force"][0, 2] == pytest.approx(9.81 * body.mass[0], rel=1e-6)
    assert np.abs(outputs_of(body)["motion.velocity"]).max() < 1e-9


def test_damped_balls_in_a_heap_come_to_rest():
    """Each ball has up to twelve dampers; each damper alone would be stable."""
    walls = [([0.0, 0.0, 0.0], [1.0, 0.0, 0.0]), ([0.0, 0.0, 0.0], [0.0, 1.0, 0.0])]
    walls += [([0.041, 0.0, 0.0], [-1.0, 0.0, 0.0]), ([0.0, 0.041, 0.0], [0.0, -1.0, 0.0])]
    planes = [FLOOR] + [{"point": p, "normal": n, "material": "a"} for p, n in walls]
    copies = {"number": [4, 4, 8], "spacing": [0.0101] * 3, "scatter": 2e-5}
    ball = sphere([0.0055, 0.0055, 0.006], 0.01, copies=copies)
    materials = {"a": material(youngs_modulus=2e6, restitution=0.05, friction=0.3)}
    heap = build([ball], materials, planes=planes, impact_speed=0.5)
    run(heap, 0.4)
    assert np.median(np.linalg.norm(outputs_of(heap)["motion.velocity"], axis=1)) < 1e-5


def test_a_damped_stack_of_cubes_stands_still():
    bodies = [box([0.0, 0.0, 0.075 + 0.15 * k]) for k in range(4)]
    materials = {"a": material(youngs_modulus=3e9, restitution=0.05, friction=0.4)}
    stack = build(bodies, materials, planes=[FLOOR], impact_speed=0.1)
    run(stack, 0.3)
    assert np.abs(outputs_of(stack)["motion.velocity"]).max() < 1e-6


def flight(size, **properties):
    """Steps and listings of a box that tumbles above the floor for 0.2 s, and their wall time."""
    motion = {"velocity": [0.3, 0.0, 0.0], "angular_velocity": [1.0, 2.0, 0.5]}
    body = box([0.0, 0.0, 0.6 * np.linalg.norm(size) + 0.2], size, **motion, **properties)
    start = time.perf_counter()
    scene = build([body], planes=[FLOOR])
    listings, steps, renew = [], [], scene.lists.renew
    scene.lists.renew = lambda state: (listings.append(1), renew(state))
    run(scene, 0.2, steps.append)
    return len(steps), len(listings), time.perf_counter() - start


@pytest.mark.parametrize("sharp", [1e-2, 1e-4, 1e-6])
def test_a_sharp_box_flies_in_no_more_steps_than_a_round_one(sharp):
    """Lists follow the size of the box, not the radius of its edges.

    Its corners are 1.045 times as far from its centre, and move so much faster.
    """
    steps, listings, _ = flight((0.1, 0.1, 0.1))
    sharp_flight = flight((0.1, 0.1, 0.1), edge_radius=0.1 * sharp)
    assert sharp_flight[0] <= 1.1 * steps and sharp_flight[1] <= 1.045 * listings


@pytest.mark.parametrize("slenderness", [100, 500, 1000])
def test_a_thin_plate_flies_in_no_more_steps_than_a_thick_one(slenderness):
    """Both have the same mass. The contact search skips empty cells."""
    steps, listings, _ = flight((5.0, 5.0, 0.5))
    thin_flight = flight((5.0, 5.0, 5.0 / slenderness), density=80.0 * slenderness)
    assert thin_flight[0] <= 1.2 * steps and thin_flight[1] <= 1.2 * listings
    assert thin_flight[2] < 5.0


def test_a_plate_of_a_thousandth_of_its_length_comes_to_lie_under_balls():
    plate = box([0.0, 0.0, 0.0006], (1.0, 1.0, 0.001), density=2000.0)
    balls = [sphere([x, y, 0.0112], density=100.0) for x in (-0.4, 0.4) for y in (-0.4, 0.4)]
    materials = {"a": material(youngs_modulus=2e11, restitution=0.2)}
    settings = {"planes": [FLOOR], "contact_forces": True, "impact_speed": 0.05}
    scene = build([plate, *balls], materials, **settings)
    run(scene, 0.1)
    weight = 9.81 * scene.mass.sum()
    assert outputs_of(scene)["contact.force"][-1, 2] == pytest.approx(-weight, rel=1e-3)


def test_a_body_that_leaves_disturbs_nobody():
    """One body leaves all cells at 1e5 m/s; the other body's state is the same to the bit."""
    resting = sphere([0.0, 0.0, 0.06], 0.1)
    outputs = []
    for others in ([], [sphere([9.0, 0.0, 0.5], 0.1, velocity=[1e5, 0.0, 1e5])]):
        scene = build([resting, *others], planes=[FLOOR])
        run(scene, 0.1, dt=1e-4)
        outputs.append({key: array[0].copy() for key, array in outputs_of(scene).items()})
    for key in outputs[0]:
        np.testing.assert_array_equal(outputs[0][key], outputs[1][key], err_msg=key)
    assert outputs_of(scene)["motion.position"][1, 0] == pytest.approx(1e4 + 9.0)


def test_a_body_that_falls_out_of_the_scene_falls_on():
    ball = build([sphere([0.0, 0.0, 0.0], 0.1)])
    run(ball, 2.0)
    assert outputs_of(ball)["motion.position"][0, 2] == pytest.approx(
        -0.5 * 9.81 * 2.0**2, rel=1e-9
    )


def test_bodies_far_faster_than_the_expected_impact_do_not_pass_through_each_other():
    small = (0.02, 0.02, 0.02)
    bodies = [box((0.0, 0.0, 0.0), small, velocity=[1e4, 0.0, 0.0]), box((0.303, 0.0, 0.0), small)]
    solver = build(bodies, gravity=NOTHING)
    with pytest.raises(StepError, match="overlap of a contact must be at most"):
        run(solver, 1e-4)
