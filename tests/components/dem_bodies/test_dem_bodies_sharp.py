"""Sharp and thin bodies touch, rest and strike as blunt ones do, in as many steps."""

import numpy as np
import pytest
from dem_scenes import (
    FLOOR,
    NOTHING,
    PLASTIC,
    STEEL,
    about,
    box,
    build,
    energy,
    material,
    rectangle,
    run,
    sphere,
)

from quintet.interfaces.component import outputs_of

EDGE = 0.15  # m
SHARP = [1e-2, 1e-4, 1e-6]
UP = [0.0, 0.0, 1.0]


def cubes(sharp, *places, **properties):
    return [box(place, edge_radius=sharp * EDGE, **properties) for place in places]


def settle(bodies, end, watch=None, **settings):
    """Let bodies settle; return their motion and the number of steps."""
    steps = []
    scene = build(bodies, {"a": PLASTIC}, planes=[FLOOR], contact_forces=True, **settings)
    run(scene, end, lambda time: (steps.append(time), watch and watch(scene)))
    return scene, outputs_of(scene), len(steps)


def stack(sharp, turn=0.0, shift=0.0):
    bodies = cubes(sharp, [0.0, 0.0, 0.075], [shift, 0.0, 0.225], [0.0, shift, 0.375])
    bodies[1]["orientation"] = about(UP, turn)
    return bodies


@pytest.mark.parametrize("turn", [0.0, 0.5])
@pytest.mark.parametrize("sharp", SHARP)
def test_sharp_cubes_stand_on_one_another_as_blunt_ones_do(sharp, turn):
    """Also exactly above each other, where a corner is equally near to two faces."""
    blunt, sharper = settle(stack(0.05, turn), 0.1), settle(stack(sharp, turn), 0.1)
    positions, expected = sharper[1]["motion.position"], blunt[1]["motion.position"]
    np.testing.assert_allclose(positions, expected, atol=2e-6)
    assert np.abs(sharper[1]["motion.velocity"]).max() < 1e-3
    assert sharper[2] < 1.15 * blunt[2]
    weight = 9.81 * sharper[0].mass.sum()
    assert sharper[1]["contact.force"][3, 2] == pytest.approx(-weight, rel=2e-2)


@pytest.mark.parametrize("sharp", SHARP)
@pytest.mark.parametrize("overhang", [-0.01, 0.01])
def test_a_sharp_cube_tips_where_its_centre_is_beyond_the_edge(sharp, overhang):
    """It stays in place if its centre is above the lower cube."""
    bodies = cubes(sharp, [0.0, 0.0, 0.075], [0.075 + overhang, 0.0, 0.225])
    bodies[0]["locked"] = ["x", "y", "z", "rotation_x", "rotation_y", "rotation_z"]
    _, outputs, _ = settle(bodies, 0.2)
    angle = 2.0 * np.arcsin(abs(outputs["motion.orientation"][1, 2]))
    assert angle > 0.05 if overhang > 0.0 else angle < 1e-3


@pytest.mark.parametrize("sharp", SHARP)
def test_crossed_sharp_planks_bear_by_their_edges_alone(sharp):
    size = (0.6, 0.1, 0.1)
    lower = box([0.0, 0.0, 0.05], size, edge_radius=0.1 * sharp)
    upper = box([0.0, 0.0, 0.15], size, edge_radius=0.1 * sharp, orientation=about(UP, 1.2))
    scene, outputs, _ = settle([lower, upper], 0.2)
    assert outputs["motion.position"][1, 2] == pytest.approx(0.15, abs=5e-5)
    weight = 9.81 * scene.mass[1]
    assert outputs["contact.force"][1, 2] == pytest.approx(weight, rel=1e-3)
    assert np.abs(outputs["motion.angular_velocity"]).max() < 1e-3


@pytest.mark.parametrize("sharp", SHARP)
@pytest.mark.parametrize(
    "orientation", [about(UP, 0.0), about([1, -1, 0], 0.9553166), about([1, 0, 0], 0.6)]
)
def test_a_sharp_cube_that_strikes_floor_and_cube_only_loses_energy(sharp, orientation):
    """On its face, its corner and its edge."""
    bodies = cubes(sharp, [0.0, 0.0, 0.0751], [0.03, 0.02, 0.2802])
    bodies[1] |= {"orientation": orientation, "velocity": [0.0, 0.0, -1.0]}
    energies = []
    settle(bodies, 0.25, lambda scene: energies.append(energy(scene)))
    assert np.diff(energies).max() < 1e-6 * energies[0]
    assert energies[-1] < 0.95 * energies[0]


@pytest.mark.parametrize("sharp", SHARP)
def test_a_ball_lies_on_a_sharp_cube(sharp):
    bodies = [*cubes(sharp, [0.0, 0.0, 0.075]), sphere([0.02, 0.0, 0.2001], 0.1)]
    scene, outputs, _ = settle(bodies, 0.3)
    weight = 9.81 * scene.mass[1]
    assert outputs["contact.force"][1, 2] == pytest.approx(weight, rel=2e-2)
    assert outputs["motion.position"][1, 2] == pytest.approx(0.2, abs=1e-4)


@pytest.mark.parametrize("slenderness", [10, 100, 1000])
def test_plates_fall_on_the_floor_and_on_one_another(slenderness):
    """5 m across; the thinnest is 5 mm."""
    thick = 5.0 / slenderness
    plates = [
        box([0.0, 0.0, z * thick + gap], (5.0, 5.0, thick)) for z, gap in ((0.5, 1e-3), (1.5, 2e-3))
    ]
    steps = []
    scene = build(plates, {"a": STEEL | {"restitution": 0.3}}, planes=[FLOOR], contact_forces=True)
    run(scene, 0.2, steps.append)
    outputs = outputs_of(scene)
    np.testing.assert_allclose(outputs["motion.position"][:, 2] / thick, [0.5, 1.5], atol=0.02)
    weight = 9.81 * scene.mass.sum()
    assert outputs["contact.force"][2, 2] == pytest.approx(-weight, rel=0.05)
    assert len(steps) < 20_000


@pytest.mark.parametrize("sharp", SHARP)
def test_sharp_rectangles_stand_in_two_dimensions(sharp):
    positions = []
    for rounding in (0.05, sharp):
        bodies = [rectangle([0.0, 0.0, z], edge_radius=rounding * EDGE) for z in (0.075, 0.225)]
        positions.append(settle(bodies, 0.1, dimensions=2)[1]["motion.position"])
    np.testing.assert_allclose(positions[1], positions[0], atol=2e-6)


def test_a_sharp_rectangle_that_falls_on_its_corner_only_loses_energy():
    bodies = [rectangle([0.0, 0.0, 0.075]), rectangle([0.02, 0.0, 0.28])]
    for body in bodies:
        body["edge_radius"] = 1e-6 * EDGE
    bodies[1]["orientation"] = about([0, 1, 0], 0.5)
    energies = []
    settle(bodies, 0.2, lambda scene: energies.append(energy(scene)), dimensions=2)
    assert np.diff(energies).max() < 1e-6 * energies[0]


def test_momentum_is_kept_where_sharp_boxes_meet():
    motion = {"orientation": about([1, 2, 3], 0.8), "angular_velocity": [3.0, -2.0, 1.0]}
    bodies = cubes(1e-6, [0.0, 0.0, 0.0], [0.25, 0.05, 0.03])
    bodies[1] |= motion | {"velocity": [-2.0, 0.0, 0.0]}
    materials = {"a": material(youngs_modulus=1e9, friction=0.4)}
    scene = build(bodies, materials, gravity=NOTHING)
    before = scene.totals()
    run(scene, 0.1)
    after = scene.totals()
    assert np.abs(outputs_of(scene)["motion.velocity"][0]).max() > 0.1
    np.testing.assert_allclose(after.momentum, before.momentum, atol=1e-12)
    np.testing.assert_allclose(after.angular_momentum, before.angular_momentum, atol=1e-12)
