"""Bodies of two dimensions, 1 m deep: mass, impacts, friction and rolling, against exact laws."""

import math
from dataclasses import replace

import numpy as np
import pytest
from dem_scenes import (
    FLOOR,
    NOTHING,
    about,
    build,
    disc,
    energy,
    material,
    mistakes,
    params,
    polygon,
    rectangle,
    run,
    sphere,
)

from quintet.components.dem_bodies import MANIFEST
from quintet.components.dem_bodies.shapes.solid import measure
from quintet.components.dem_bodies.state import DEEPEST_PAIR
from quintet.interfaces.component import outputs_of
from quintet.interfaces.ports import PLANAR_MOTION

G = 9.81
HOOK = [[0.0, 0.0], [0.0, 0.4], [0.2, 0.4], [0.2, 0.2], [0.4, 0.2], [0.4, 0.0]]  # an L
WEDGE = [[0.0, 0.0], [0.0, 0.2], [0.3, 0.0]]  # clockwise: the order is reversed


def planar(bodies, materials=None, **settings):
    return build(bodies, materials, dimensions=2, **settings)


def slope(angle):
    return [G * math.sin(angle), 0.0, -G * math.cos(angle)]


def motion(bodies, name):
    return outputs_of(bodies)[f"motion.{name}"]


def ring(count, radius):
    angle = 2.0 * math.pi * np.arange(count) / count
    return (radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)).tolist()


@pytest.mark.parametrize(
    ("body", "area", "moment"),
    [
        (disc(NOTHING), math.pi * 0.01, 0.5 * 0.01),
        (rectangle(NOTHING, 0.3, 0.2), 0.06, (0.3**2 + 0.2**2) / 12.0),
        (polygon(NOTHING, WEDGE), 0.03, (0.3**2 + 0.2**2) / 18.0),
        (polygon(NOTHING, ring(6, 0.1)), 0.015 * math.sqrt(3.0), 0.01 * 5.0 / 12.0),
        # Moments of three squares about their centres, plus those of the centres.
        (polygon(NOTHING, HOOK), 0.12, 0.2**2 / 6.0 + 0.2**2 * 4.0 / 9.0),
    ],
    ids=["disc", "rectangle", "triangle", "hexagon", "L"],
)
def test_mass_is_area_times_density_and_inertia_that_of_the_prism_about_its_axis(
    body, area, moment
):
    description = params([body], dimensions=2).bodies[0]
    solid = measure(description)
    assert solid.mass == pytest.approx(description.density * area, rel=1e-12)
    assert solid.inertia[1, 1] == pytest.approx(solid.mass * moment, rel=1e-12)


def test_bodies_describe_their_shapes_in_the_plane():
    scene = params([disc([0.0, 0.0, 1.0]), polygon(NOTHING, WEDGE)], dimensions=2)
    assert [replace(port, lacks=()) for port in MANIFEST.ports(scene)[1]] == [PLANAR_MOTION]
    bodies = planar([disc([0.0, 0.0, 1.0]), polygon(NOTHING, WEDGE)])
    description = bodies.describe()
    assert description["motion.dimensions"].tolist() == [2.0]
    request = {"spacing": 0.02, "depth": 1.0, "inset": 0.01, "mirror": 0.0, "dimensions": 2.0}
    samples = bodies.sample({f"motion.{key}": np.array([value]) for key, value in request.items()})
    area = np.bincount(samples["motion.body"].astype(int), samples["motion.volume"])
    np.testing.assert_allclose(area, [math.pi * 0.01, 0.03], rtol=1e-9)
    view = bodies.view()
    assert len(view["points"]) == 4 and view["cells"].tolist() == [[1, 2, 3]]
    assert view["radius"] == pytest.approx([0.1, 0.0, 0.0, 0.0])


@pytest.mark.parametrize("e", [0.2, 0.6, 1.0])
@pytest.mark.parametrize("target", ["plane", "disc", "polygon"])
def test_restitution_of_a_disc_is_realised(e, target):
    materials = {"a": material(youngs_modulus=1e10, restitution=e, friction=0.0)}
    bodies = [disc([0.0, 0.0, 0.1001], velocity=[0.0, 0.0, -1.0])]
    if target == "disc":
        bodies.append(disc([0.0, 0.0, -0.1], velocity=[0.0, 0.0, 1.0]))
    elif target == "polygon":  # of the disc's mass, hit in the middle of an edge
        edge = math.sqrt(math.pi) * 0.1
        low = [0.0, 0.0, -0.5 * edge]
        bodies.append(rectangle(low, edge, edge, density=1000.0, velocity=[0.0, 0.0, 1.0]))
    planes = [FLOOR] if target == "plane" else []
    solver = planar(bodies, materials, gravity=NOTHING, planes=planes, impact_speed=2.0)
    run(solver, 0.02)
    assert solver.state.report[DEEPEST_PAIR] == -1  # apart again
    assert motion(solver, "velocity")[0, 2] == pytest.approx(e, rel=5e-3)
    if target != "plane":
        assert motion(solver, "velocity")[1, 2] == pytest.approx(-e, rel=5e-3)


def test_an_oblique_impact_without_friction_keeps_what_is_tangential():
    materials = {"a": material(youngs_modulus=1e10, restitution=0.5, friction=0.0)}
    bodies = [disc([0.0, 0.0, 0.0], velocity=[1.0, 0.0, 0.0]), disc([0.16, 0.0, 0.1205])]
    pair = planar(bodies, materials, gravity=NOTHING, impact_speed=1.0)
    while pair.state.report[DEEPEST_PAIR] < 0.0:
        pair.step(pair.stable_dt())
    x = motion(pair, "position")
    n = (x[0] - x[1]) / np.linalg.norm(x[0] - x[1])
    run(pair, 0.01)
    v = motion(pair, "velocity")
    velocity_change = 0.75 * n[0] * n  # (1 + e)/2 of the normal velocity passes over
    np.testing.assert_allclose(v, [[1.0, 0.0, 0.0] - velocity_change, velocity_change], atol=3e-3)


def test_a_polygon_that_strikes_with_a_corner_rebounds_as_a_rigid_body():
    e, materials = 0.6, {"a": material(youngs_modulus=1e10, restitution=0.6, friction=0.0)}
    body = rectangle(
        [0.0, 0.0, 0.2], 0.3, 0.1, orientation=about([0.0, 1.0, 0.0], 0.5), velocity=[0, 0, -1.0]
    )
    solver = planar([body], materials, gravity=NOTHING, planes=[FLOOR], impact_speed=1.0)
    lowest = int(np.argmin(solver.state.centre[:, 2]))
    while solver.state.report[DEEPEST_PAIR] < 0.0:
        solver.step(solver.stable_dt())
    arm = solver.state.centre[lowest] - solver.state.position[0]
    run(solver, 0.005)
    solid = measure(solver.params.bodies[0])
    lever_arm = -arm[0]  # (r × n)_y
    impulse = (1.0 + e) / (1.0 / solid.mass + lever_arm**2 / solid.inertia[1, 1])
    assert motion(solver, "velocity")[0, 2] == pytest.approx(impulse / solid.mass - 1.0, abs=0.01)
    spin = impulse * lever_arm / solid.inertia[1, 1]
    assert motion(solver, "angular_velocity")[0, 1] == pytest.approx(spin, rel=0.01)


def test_a_disc_rolls_down_a_slope_with_two_thirds_of_its_pull():
    angle = math.radians(20.0)
    materials = {"a": material(youngs_modulus=1e9, friction=0.5)}
    wheel = planar([disc([0.0, 0.0, 0.1])], materials, gravity=slope(angle), planes=[FLOOR])
    run(wheel, 0.2)
    start = motion(wheel, "velocity")[0, 0]
    run(wheel, 0.5)
    acceleration = (motion(wheel, "velocity")[0, 0] - start) / 0.5
    assert acceleration == pytest.approx(2.0 / 3.0 * G * math.sin(angle), rel=2e-3)
    slip = motion(wheel, "velocity")[0, 0] - 0.1 * motion(wheel, "angular_velocity")[0, 1]
    assert abs(slip) < 2e-3


def test_a_disc_slides_and_turns_on_a_slope_that_is_too_steep_to_roll():
    angle, μ = math.radians(60.0), 0.3  # beyond tan = 3 μ
    materials = {"a": material(youngs_modulus=1e9, friction=μ)}
    wheel = planar([disc([0.0, 0.0, 0.1])], materials, gravity=slope(angle), planes=[FLOOR])
    run(wheel, 0.1)
    before = motion(wheel, "velocity")[0, 0], motion(wheel, "angular_velocity")[0, 1]
    run(wheel, 0.3)
    after = motion(wheel, "velocity")[0, 0], motion(wheel, "angular_velocity")[0, 1]
    a, α = ((new - old) / 0.3 for new, old in zip(after, before, strict=True))
    assert a == pytest.approx(G * (math.sin(angle) - μ * math.cos(angle)), rel=5e-3)
    assert α == pytest.approx(2.0 * μ * G * math.cos(angle) / 0.1, rel=5e-3)


@pytest.mark.parametrize(("v0", "spin", "end"), [(1.0, 0.0, 2.0 / 3.0), (0.0, 10.0, 1.0 / 3.0)])
def test_a_disc_that_slides_or_spins_comes_to_roll(v0, spin, end):
    μ, materials = 0.3, {"a": material(youngs_modulus=1e9, friction=0.3)}
    body = disc([0.0, 0.0, 0.1], velocity=[v0, 0.0, 0.0], angular_velocity=[0.0, spin, 0.0])
    wheel = planar([body], materials, planes=[FLOOR], impact_speed=0.2)
    rolling_time = abs(end - v0) / (μ * G)
    run(wheel, 0.5 * rolling_time)
    half = v0 + 0.5 * (end - v0)
    assert motion(wheel, "velocity")[0, 0] == pytest.approx(half, abs=3e-3)
    run(wheel, 0.5 * rolling_time + 0.1)
    assert motion(wheel, "velocity")[0, 0] == pytest.approx(end, abs=3e-3)
    assert 0.1 * motion(wheel, "angular_velocity")[0, 1] == pytest.approx(end, abs=3e-3)


def test_rolling_friction_slows_a_disc_by_two_thirds_of_it():
    μ_r, speed = 0.1, 0.5
    materials = {"a": material(youngs_modulus=1e9, friction=0.8, rolling_friction=μ_r)}
    body = disc([0.0, 0.0, 0.1], velocity=[speed, 0.0, 0.0])
    body |= {"angular_velocity": [0.0, speed / 0.1, 0.0]}
    wheel = planar([body], materials, planes=[FLOOR], impact_speed=0.2)
    run(wheel, 0.3)
    start = motion(wheel, "velocity")[0, 0]
    run(wheel, 0.2)
    deceleration = (start - motion(wheel, "velocity")[0, 0]) / 0.2
    assert deceleration == pytest.approx(2.0 / 3.0 * μ_r * G, rel=0.01)


def test_a_block_rests_on_a_slope_without_creep():
    μ = 0.45
    materials, angle = {"a": material(youngs_modulus=1e8, friction=μ)}, 0.9 * math.atan(μ)
    settings = {"gravity": slope(angle), "planes": [FLOOR], "impact_speed": 0.5}
    block = planar([rectangle([0.0, 0.0, 0.05], 0.2, 0.1)], materials, **settings)
    run(block, 0.5)
    start = motion(block, "position")[0]
    run(block, 2.0)
    assert np.abs(motion(block, "position")[0] - start).max() < 1e-6


def test_a_block_slides_on_a_steep_slope():
    μ, angle = 0.3, math.radians(30.0)
    materials = {"a": material(youngs_modulus=1e8, friction=μ)}
    settings = {"gravity": slope(angle), "planes": [FLOOR], "impact_speed": 0.5}
    block = planar([rectangle([0.0, 0.0, 0.05], 0.2, 0.1)], materials, **settings)
    run(block, 0.1)
    start = motion(block, "velocity")[0, 0]
    run(block, 0.4)
    acceleration = (motion(block, "velocity")[0, 0] - start) / 0.4
    assert acceleration == pytest.approx(G * (math.sin(angle) - μ * math.cos(angle)), rel=5e-3)


def test_a_pile_of_polygons_and_discs_carries_its_weight():
    materials = {"a": material(youngs_modulus=1e9, restitution=0.2, friction=0.6)}
    bodies = [
        rectangle([0.0, 0.0, 0.05], 0.4, 0.1),
        polygon([0.0, 0.0, 0.1 + 0.2 / 3.0], [[-0.15, 0.0], [0.15, 0.0], [0.0, 0.2]]),
        rectangle([0.3, 0.0, 0.1], 0.2, 0.2, orientation=about([0, 1, 0], 0.5 * math.pi)),
        disc([0.3, 0.0, 0.3]),
    ]
    pile = planar(bodies, materials, planes=[FLOOR], impact_speed=0.2, contact_forces=True)
    run(pile, 2.0)
    outputs = outputs_of(pile)
    assert np.abs(outputs["motion.velocity"]).max() < 1e-3
    weight = G * pile.mass.sum()
    np.testing.assert_allclose(outputs["contact.force"][4], [0.0, 0.0, -weight], atol=2e-3 * weight)
    # Stacked bodies stay in place: no corner has sunk into an edge.
    heights = [0.05, 0.1 + 0.2 / 3.0, 0.1, 0.3]
    np.testing.assert_allclose(outputs["motion.position"][:, 2], heights, atol=5e-4)


def crowd(seed=2, **changes):
    random = np.random.default_rng(seed)
    bodies = []
    for k in range(36):
        centre = [0.22 * (k % 6), 0.5, 0.22 * (k // 6)]
        v, ω = random.normal(size=2).tolist(), 3.0 * random.normal()
        velocities = {"velocity": [v[0], 0.0, v[1]], "angular_velocity": [0.0, ω, 0.0]}
        if k % 3 == 0:
            bodies.append(disc(centre, 0.12, **velocities))
        else:
            turn = about([0.0, 1.0, 0.0], random.uniform(0.0, 6.0))
            corners = ring(5, 0.08) if k % 3 == 1 else [[0.0, 0.0], [0.12, 0.0], [0.0, 0.16]]
            bodies.append(polygon(centre, corners, orientation=turn, **velocities))
    materials = {"a": material(youngs_modulus=1e11, friction=0.4, **changes)}
    return planar(bodies, materials, gravity=NOTHING, impact_speed=4.0)


@pytest.mark.parametrize("restitution", [0.5, 1.0])
def test_a_crowd_keeps_momentum_to_rounding_and_its_energy_is_accounted_for(restitution):
    bodies = crowd(restitution=restitution)
    start, start_energy = bodies.totals(), energy(bodies)
    run(bodies, 0.3)
    end = bodies.totals()
    assert (
        bodies.accumulated.dissipated > 0.01 * start_energy
    )  # they met; friction dissipates energy also at e = 1
    momentum_scale = (bodies.mass * np.linalg.norm(motion(bodies, "velocity"), axis=1)).sum()
    np.testing.assert_allclose(end.momentum, start.momentum, atol=1e-12 * momentum_scale)
    np.testing.assert_allclose(
        end.angular_momentum, start.angular_momentum, atol=1e-12 * momentum_scale
    )
    assert energy(bodies) + bodies.accumulated.dissipated == pytest.approx(start_energy, rel=2e-3)


def test_nothing_leaves_the_plane_whatever_the_loads():
    bodies = crowd(restitution=0.5)
    random = np.random.default_rng(0)
    for _ in range(200):
        loads = {f"load.{name}": random.normal(size=(36, 3)) for name in ("force", "torque")}
        bodies.take(loads)
        bodies.step(bodies.stable_dt())
    outputs = outputs_of(bodies)
    assert (outputs["motion.position"][:, 1] == 0.5).all()
    assert not outputs["motion.velocity"][:, 1].any()
    assert not outputs["motion.angular_velocity"][:, [0, 2]].any()
    assert not outputs["motion.orientation"][:, [1, 3]].any()


def test_copies_scatter_in_the_plane():
    lattice = {"number": [3, 1, 3], "spacing": [0.3, 1.0, 0.3], "scatter": 0.01}
    bodies = params([disc([0.0, 0.2, 0.0], copies=lattice)], dimensions=2).bodies
    assert len(bodies) == 9 and all(body.position[1] == 0.2 for body in bodies)


def test_touching_is_allowed_and_overlaps_are_found_for_every_pair():
    square = rectangle([0.0, 0.0, 0.0], 0.2, 0.2)
    touching = [disc([0.2, 0.0, 0.0]), rectangle([-0.2, 0.0, 0.0], 0.2, 0.2)]
    assert params([square, *touching], dimensions=2)
    turn = about([0.0, 1.0, 0.0], 0.25 * math.pi)
    for overlapping in (
        disc([0.19, 0.0, 0.0]),
        rectangle([-0.19, 0.0, 0.0], 0.2, 0.2),
        rectangle([0.2, 0.0, 0.0], 0.2, 0.2, orientation=turn),
        rectangle([0.0, 0.0, 0.0], 0.5, 0.05),  # a cross: no corner lies in the other rectangle
        disc([0.0, 0.0, 0.0], 0.01),
    ):
        (message,) = mistakes([square, overlapping], dimensions=2)
        assert "must not overlap at the start" in message, overlapping
    (message,) = mistakes([square], dimensions=2, planes=[FLOOR])
    assert "it reaches 0.1 m below" in message


@pytest.mark.parametrize(
    ("bodies", "settings", "sentence"),
    [
        ([sphere(NOTHING)], {}, "must be disc or polygon where dimensions is 2; found sphere"),
        ([disc(NOTHING)], {"dimensions": 3}, "a shape of three dimensions where dimensions is 3"),
        ([disc(NOTHING)], {"gravity": [0, 1, 0]}, "gravity must stay in the plane of x and z"),
        ([disc(NOTHING, velocity=[0, 1, 0])], {}, "bodies[0].velocity must stay in the plane"),
        ([disc(NOTHING, angular_velocity=[1, 0, 0])], {}, "angular_velocity must stay in the"),
        ([disc(NOTHING, orientation=about([1, 0, 0], 1.0))], {}, "bodies[0].orientation (w, x"),
        ([disc(NOTHING)], {"planes": [FLOOR | {"normal": [0, 1, 1]}]}, "planes[0].normal must"),
        ([disc(NOTHING), disc([1, 1, 0])], {}, "must have the y of all others, 0 m"),
        ([polygon(NOTHING, [[0, 0], [1, 0]])], {}, "once round a polygon"),
        ([polygon(NOTHING, [[0, 0], [1, 0], [2, 0], [0, 1]])], {}, "none of them straight"),
        ([polygon(NOTHING, [[0, 0], [1, 0], [0, 1], [1, 1]])], {}, "does not cross itself"),
        ([polygon(NOTHING, ring(5, 1.0)[::2] + ring(5, 1.0)[1::2])], {}, "does not cross itself"),
        ([polygon([0, 0, 3], HOOK), disc(NOTHING)], {}, "convex polygon where it may touch"),
        ([polygon([0, 0, 3], HOOK)], {"planes": [FLOOR]}, "beside 0 other bodies and 1 planes"),
        ([polygon(NOTHING, WEDGE, edge_radius=0.08)], {}, "leave something of each edge"),
        (
            [disc(NOTHING, edge_radius=0.01)],
            {},
            "found centre, edge_radius, radius",
        ),
        ([disc(NOTHING, corners=WEDGE)], {}, "a disc is described by centre and radius alone"),
    ],
)
def test_mistakes_are_told(bodies, settings, sentence):
    text = " ".join(mistakes(bodies, **({"dimensions": 2} | settings)))
    assert sentence in text, text
