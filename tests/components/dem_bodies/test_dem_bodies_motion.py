"""Free motion, loads, energy, and the rules of the component interface."""

import subprocess
import sys
from types import SimpleNamespace

import numpy as np
import pytest
from dem_scenes import FLOOR, NOTHING, box, build, energy, material, run, sphere, three_cubes
from scipy.integrate import solve_ivp

from quintet.components.dem_bodies.shapes.sphere_union import measure_union
from quintet.components.dem_bodies.view import extent, planes_view
from quintet.interfaces.component import outputs_of
from quintet.interfaces.errors import StepError

SIZE = (0.1, 0.2, 0.3)
SPIN = [0.3, 8.0, 0.2]  # rad/s, nearly about the middle axis: it tumbles


def free_box():
    body = box(NOTHING, SIZE, velocity=[1.0, 2.0, 3.0], angular_velocity=SPIN)
    return build([body], gravity=NOTHING)


def test_free_box_turns_by_eulers_equations():
    inertia = np.array([0.13, 0.10, 0.05]) / 12.0  # per unit mass
    expected = solve_ivp(
        lambda _, w: np.cross(inertia * w, w) / inertia, (0.0, 2.0), SPIN, rtol=1e-10, atol=1e-12
    ).y[:, -1]
    errors = []
    for dt in (1e-3, 5e-4):
        body = free_box()
        run(body, 2.0, dt=dt)
        axes = body.state.axes[0].reshape(3, 3)
        errors.append(
            np.abs(axes.T @ outputs_of(body)["motion.angular_velocity"][0] - expected).max()
        )
    assert errors[1] < 2e-3
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.1)


def test_free_box_keeps_angular_momentum_and_energy():
    body = free_box()
    start, momentum = body.totals(), body.state.angular_momentum.copy()
    drifts = []
    run(body, 5.0, lambda _: drifts.append(body.totals().kinetic / start.kinetic - 1.0), dt=1e-3)
    assert (body.state.angular_momentum == momentum).all()
    assert np.abs(drifts).max() < 2e-5
    assert abs(np.mean(drifts[-1000:])) < 1e-5
    np.testing.assert_allclose(body.totals().momentum, start.momentum, rtol=1e-14)


def test_load_acts_as_an_impulse():
    body = build([box(NOTHING), sphere([1.0, 0.0, 0.0])], gravity=NOTHING)
    force, torque = np.array([[1.0, 2.0, 3.0], NOTHING]), np.array([[0.1, 0.0, 0.2], NOTHING])
    force.flags.writeable = torque.flags.writeable = False
    body.take({"load.force": force, "load.torque": torque})
    run(body, 0.5, dt=1e-3)
    np.testing.assert_allclose(body.totals().momentum, 0.5 * force[0], rtol=1e-12)
    momentum = body.state.angular_momentum[body.state.row[0]]
    np.testing.assert_allclose(momentum, 0.5 * torque[0], rtol=1e-12, atol=1e-15)
    assert body.accumulated.load_work == pytest.approx(body.totals().kinetic, rel=1e-12)
    body.take({})
    before = body.totals().momentum
    run(body, 0.1, dt=1e-3)
    np.testing.assert_array_equal(body.totals().momentum, before)


def test_energy_balance_closes_and_contacts_only_take():
    materials = {"a": material(youngs_modulus=1e9, friction=0.3, restitution=0.7)}
    body = box([0.0, 0.0, 0.2], velocity=[0.5, 0.0, -1.0], angular_velocity=[2.0, 1.0, 0.0])
    scene = build([body], materials, planes=[FLOOR])
    scene.take({"load.force": np.array([[0.0, 1.0, 0.0]]), "load.torque": np.zeros((1, 3))})
    start, losses = energy(scene), [0.0]
    run(scene, 0.4, lambda _: losses.append(scene.accumulated.dissipated))
    load_work, dissipated = scene.accumulated.load_work, scene.accumulated.dissipated
    assert energy(scene) + dissipated - load_work == pytest.approx(start, rel=1e-9)
    assert np.diff(losses).min() > -1e-9 * start
    assert dissipated > 0.2 * start


def test_contact_forces_are_what_changes_momentum():
    """To rounding, for each body and for all planes together, at any step length."""
    bodies = [box([0.0, 0.0, 0.0751]), box([0.03, 0.0, 0.2252], angular_velocity=[0.0, 2.0, 0.0])]
    scene = build(bodies, planes=[FLOOR], contact_forces=True)
    force, torque, time = np.zeros((3, 3)), np.zeros((3, 3)), 0.0
    start, momentum = outputs_of(scene), scene.state.angular_momentum.copy()
    while time < 0.2:
        dt = scene.stable_dt()
        scene.step(dt)
        outputs, time = outputs_of(scene), time + dt
        force, torque = (
            force + dt * outputs["contact.force"],
            torque + dt * outputs["contact.torque"],
        )
    impulse = scene.mass[:, None] * (outputs["motion.velocity"] - start["motion.velocity"])
    impulse[:, 2] += 9.81 * time * scene.mass
    np.testing.assert_allclose(force[:2], impulse, atol=1e-12 * np.abs(impulse).max())
    np.testing.assert_allclose(
        torque[:2], (scene.state.angular_momentum - momentum)[:2], atol=1e-12
    )
    np.testing.assert_allclose(force.sum(axis=0), 0.0, atol=1e-12 * np.abs(force).max())
    assert force[0, 2] > 0.0 > force[2, 2]


def elastic_error(steps):
    """Largest energy error of a slender box that bounces without loss."""
    materials = {"a": material(youngs_modulus=1e10, friction=0.0, restitution=1.0)}
    body = box([0.0, 0.0, 0.3], SIZE, velocity=[0.0, 0.0, -1.0], angular_velocity=[2.0, 1.0, 0.0])
    scene = build([body], materials, planes=[FLOOR], steps_per_contact=steps, longest_step=1e-4)
    start, errors = energy(scene), [0.0]
    run(scene, 0.3, lambda _: errors.append(abs(energy(scene) / start - 1.0)))
    assert scene.state.velocity[0, 2] > -3.0  # it bounced; free, it would fall at 3.9 m/s
    return max(errors)


def test_elastic_bounces_keep_energy_to_second_order():
    coarse, fine = elastic_error(40), elastic_error(160)
    assert coarse < 1e-3
    assert fine < 0.12 * coarse


def test_two_half_steps_are_one_to_second_order():
    """For one damped contact without slip: local error dt³."""
    materials = {"a": material(youngs_modulus=1e6, friction=5.0, restitution=0.4)}
    differences = []
    for dt in (2e-4, 1e-4):
        ends = []
        for pieces in (1, 2):
            body = sphere([0.0, 0.0, 0.05], 0.1, velocity=[0.3, 0.0, -0.5])
            ball = build([body], materials, planes=[FLOOR])
            run(ball, 2e-3, dt=5e-5)
            for _ in range(pieces):
                ball.step(dt / pieces)
            outputs = outputs_of(ball)
            ends.append(np.append(outputs["motion.velocity"][0], outputs["motion.position"][0]))
        differences.append(np.abs(ends[0] - ends[1]).max())
    assert differences[0] / differences[1] > 6.0


def test_union_of_spheres_counts_overlaps_once():
    radius, distance = 1.0, 1.2
    volume, centre, inertia = measure_union(
        (((0.0, 0.0, 0.0), (distance, 0.0, 0.0)), (radius, radius))
    )
    h = radius - 0.5 * distance  # two caps of this height belong to both spheres
    exact = 8.0 / 3.0 * np.pi - 2.0 * np.pi * h**2 * (3.0 * radius - h) / 3.0
    assert volume == pytest.approx(exact, rel=5e-3)
    np.testing.assert_allclose(centre, [0.5 * distance, 0.0, 0.0], atol=1e-9)
    x = np.linspace(-radius, 0.5 * distance, 20001)
    area = np.pi * (radius**2 - x**2)
    about_x = 2.0 * np.trapezoid(area**2 / (2.0 * np.pi), x)
    assert inertia[0, 0] == pytest.approx(about_x, rel=1e-2)
    about_y = 2.0 * np.trapezoid(area**2 / (4.0 * np.pi) + area * (x - 0.5 * distance) ** 2, x)
    assert inertia[1, 1] == pytest.approx(about_y, rel=1e-2)


def test_clump_of_one_sphere_is_that_sphere_and_moves_alike():
    clump = {"shape": "spheres", "centres": [[0.0, 0.0, 0.0]], "radii": [0.05], "material": "a"}
    clump |= {"density": 2500.0, "origin": [0.0, 0.0, 0.06]}
    results = []
    for body in (clump, sphere([0.0, 0.0, 0.06], 0.1)):
        scene = build([body | {"velocity": [1.0, 0.0, 0.0]}], planes=[FLOOR])
        run(scene, 0.1, dt=1e-5)
        results.append((scene.mass[0], outputs_of(scene)["motion.velocity"][0]))
    assert results[0][0] == pytest.approx(results[1][0], rel=1e-2)
    np.testing.assert_allclose(results[0][1], results[1][1], rtol=2e-2, atol=1e-3)


AGAIN = """
import sys
import numpy as np
sys.path.insert(0, sys.argv[2])
from test_dem_bodies_motion import toppling_cubes
from dem_scenes import run
scene = toppling_cubes()
scene.load(dict(np.load(sys.argv[1])))
run(scene, 0.05)
np.savez(sys.argv[1], **scene.save())
"""


def toppling_cubes():
    """Cubes that are pushed over."""
    scene = three_cubes()
    scene.take({"load.force": np.array([NOTHING, [30.0, 5.0, 0.0], [5.0, 20.0, 0.0]])})
    return scene


def test_loaded_in_a_fresh_process_goes_on_with_the_same_bits(tmp_path):
    scene, file = toppling_cubes(), tmp_path / "state.npz"
    run(scene, 0.2)
    np.savez(file, **scene.save())
    run(scene, 0.05)
    folder = str(__file__).rsplit("/", 1)[0]
    subprocess.run([sys.executable, "-c", AGAIN, str(file), folder], check=True)
    continued = np.load(file)
    for name, array in scene.save().items():
        np.testing.assert_array_equal(array, continued[name], err_msg=name)
    assert np.abs(scene.state.angular_velocity).max() > 0.1


def test_rewinding_gives_the_same_bits():
    scene = toppling_cubes()
    run(scene, 0.01)
    saved = scene.save()
    run(scene, 0.02)
    expected = scene.save()
    scene.load(saved)
    run(scene, 0.02)
    for name, array in scene.save().items():
        np.testing.assert_array_equal(array, expected[name], err_msg=name)


def test_outputs_are_copies_and_views_have_faces():
    scene = three_cubes()
    outputs_of(scene)["motion.position"][:] = 0.0
    assert outputs_of(scene)["motion.position"][0, 0] == 5.275
    view = scene.view()
    assert view["points"].shape == (24, 3) and view["cells"].shape == (18, 4)
    corners = view["points"][view["cells"]]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 1])
    middle = outputs_of(scene)["motion.position"].repeat(6, axis=0)
    assert ((corners.mean(axis=1) - middle) * normals).sum(axis=1).min() > 0.0


def test_planes_are_shown_where_they_hold_bodies():
    sides = [
        {"point": [-0.1, 0.0, 0.0], "normal": [2.0, 0.0, 0.0], "material": "a"},
        {"point": [0.2, 0.0, 0.0], "normal": [-1.0, 0.0, 0.0], "material": "a"},
    ]
    walls = build([sphere([0.0, 0.0, 1.0])], planes=[FLOOR, *sides]).walls()
    floor, left, right = (walls["points"][cell[cell >= 0]] for cell in walls["cells"])
    assert floor[:, 0].min() == pytest.approx(-0.1) and floor[:, 0].max() == pytest.approx(0.2)
    assert np.allclose(left[:, 0], -0.1) and np.allclose(right[:, 0], 0.2)
    assert left[:, 2].min() == pytest.approx(0.0, abs=1e-9) and not np.abs(floor[:, 2]).any()
    assert build([sphere([0.0, 0.0, 1.0])]).walls() == {}


def test_planes_are_shown_where_bodies_were_and_where_they_have_come_to():
    """A sphere that flew 50 m along a floor is still above it, and so is its start."""
    floor = np.array([[0.0, 0.0, 1.0, 0.0]])
    extents, plane_x = [], []
    for x in (0.0, 50.0):
        position = np.array([[x, 0.0, 1.0], [np.nan] * 3])  # the last row is no body
        extents.append(extent(SimpleNamespace(position=position, motion=np.full((2, 4), 0.5))))
        plane_x.append(planes_view(floor, extents)["points"][:, 0])
    assert plane_x[0].max() < 50.0 < plane_x[1].max()
    assert plane_x[1].min() <= plane_x[0].min() < 0.0


def test_planes_look_the_same_after_a_state_is_loaded():
    """The view of planes depends on the start and the present state, not on earlier views."""
    ball = sphere([0.0, 0.0, 1.0]) | {"velocity": [9.0, 0.0, 5.0]}
    watched, resumed = (build([ball], planes=[FLOOR]) for _ in range(2))
    run(watched, 0.3, lambda _: watched.walls())
    resumed.load(watched.save())
    assert np.array_equal(resumed.walls()["points"], watched.walls()["points"])


def test_steps_are_long_while_nothing_can_touch():
    far = build([sphere([0.0, 0.0, 1.0], 0.1)], planes=[FLOOR])
    near = build([sphere([0.0, 0.0, 0.05], 0.1)], planes=[FLOOR])
    assert far.stable_dt() == far.params.longest_step
    assert near.stable_dt() < 0.2 * far.stable_dt()


@pytest.mark.parametrize("body", [sphere(NOTHING, 0.1), box(NOTHING, SIZE)])
def test_a_lone_spinning_body_takes_the_longest_step(body):
    """At any speed: only rotation about a moving axis needs shorter steps."""
    lone = build([body | {"angular_velocity": [5.0, 20.0, 3.0], "velocity": [9.0, 0.0, 0.0]}])
    steps, start = [], lone.totals()
    run(lone, 0.2, lambda _: steps.append(lone.stable_dt()))
    assert min(steps) == max(steps) == lone.params.longest_step
    assert lone.totals().kinetic == pytest.approx(
        start.kinetic + start.potential - lone.totals().potential, rel=1e-4
    )


def test_a_body_that_spins_far_above_the_floor_takes_the_longest_step_until_it_is_near():
    spin = {"angular_velocity": [0.0, 0.0, 60.0]}
    body = build([box([0.0, 0.0, 1.0], **spin)], planes=[FLOOR])
    steps, gaps = [], []

    def watch(_):
        steps.append(body.stable_dt())
        gaps.append(body.state.position[0, 2] - 0.5 * 0.15 * 3.0**0.5)

    run(body, 0.43, watch)
    near = np.array(gaps) < 0.03
    assert (np.array(steps)[~near] == body.params.longest_step).all()
    assert np.array(steps)[near].min() < 0.5 * body.params.longest_step


def test_a_slender_body_that_spins_fast_keeps_its_energy():
    """The body spins about its intermediate axis, which is unstable."""
    lone = build([box(NOTHING, SIZE, angular_velocity=[0.1, 300.0, 0.1])], gravity=NOTHING)
    energies = []
    run(lone, 1.0, lambda _: energies.append(energy(lone)))
    assert lone.stable_dt() < lone.params.longest_step
    assert np.ptp(energies) < 1e-4 * energies[0]


def test_too_deep_a_contact_ends_the_run():
    soft = {"a": material(youngs_modulus=1e4)}
    ball = build([sphere([0.0, 0.0, 0.06], 0.1, velocity=[0.0, 0.0, -9.0])], soft, planes=[FLOOR])
    with pytest.raises(StepError, match=r"body 0 with a plane is .*Increase youngs_modulus"):
        run(ball, 0.1)


def test_a_load_that_is_not_finite_ends_the_run():
    ball = build([sphere([0.0, 0.0, 0.06], 0.1)])
    ball.take({"load.force": np.array([[np.nan, 0.0, 0.0]])})
    with pytest.raises(StepError, match="must stay finite; body 0"):
        ball.step(1e-3)
