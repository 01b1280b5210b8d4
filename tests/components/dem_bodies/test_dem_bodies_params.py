"""Scenes that are refused before a run; the checks need no solver."""

import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from dem_scenes import FLOOR, about, box, build, material, mistakes, params, run, sphere

from quintet.components.dem_bodies import MANIFEST
from quintet.components.dem_bodies.component import DemBodies
from quintet.components.dem_bodies.ports import CONTACT
from quintet.interfaces.ports import LOAD, MOTION

LOOSE = {"shape": "spheres", "density": 1.0, "material": "a"}


TWO = {"number": [2, 1, 1], "spacing": [0.01] * 3}


@pytest.mark.parametrize(
    ("bodies", "settings", "sentence"),
    [
        ([box([0, 0, 0], material="b")], {}, "bodies[0].material must be one of the materials a"),
        ([box([0, 0, 0])], {"planes": [FLOOR | {"material": "b"}]}, "planes[0].material"),
        ([box([0, 0, 0])], {"pairs": [{"between": ["a", "b"]}]}, "pairs[0].between"),
        ([box([0, 0, 0])], {"planes": [FLOOR]}, "reaches 0.075 m below"),
        ([box([0, 0, 0])], {"planes": [FLOOR | {"normal": [0, 0, 0]}]}, "must have a direction"),
        ([box([0, 0, 0]), box([0.1, 0, 0])], {}, "bodies[0] and bodies[1] must not overlap"),
        ([box([0, 0, 0]), sphere([0.08, 0, 0])], {}, "they do by 0.005 m"),
        ([sphere([0, 0, 0]), sphere([0.01, 0, 0])], {}, "they do by 0.01 m"),
        ([box([0, 0, 0], orientation=[1.0, 1.0, 0.0, 0.0])], {}, "must be a unit quaternion"),
        ([box([0, 0, 0], radius=1.0)], {}, "a box is described by lowest and highest alone"),
        (
            [sphere([0, 0, 0], edge_radius=0.1)],
            {},
            "a sphere is described by centre and radius alone",
        ),
        ([box([0, 0, 0], edge_radius=0.08)], {}, "edge_radius must be less than half"),
        ([box([0, 0, 0], mass=1.0)], {}, "exactly one of density and mass"),
        ([LOOSE | {"centres": [[0, 0, 0]], "radii": [1.0, 2.0]}], {}, "one radius for each centre"),
        ([LOOSE | {"centres": [[0, 0, 0]]}], {}, "a spheres is described by centres and radii"),
        ([], {}, "bodies"),
        ([box([0, 0, 0])], {"steps_per_contact": 5}, "steps_per_contact"),
        ([box([0, 0, 0], densty=1.0)], {}, "Did you mean density?"),
        ([sphere([0, 0, 0], copies={"number": [2, 1, 1]})], {}, "copies.spacing is needed"),
        ([sphere([0, 0, 0], copies=TWO)], {}, "must not overlap"),
    ],
)
def test_wrong_scenes_are_refused(bodies, settings, sentence):
    assert sentence in " ".join(mistakes(bodies, **settings))


@pytest.mark.parametrize(
    ("bodies", "settings", "sentence"),
    [
        ([], {"speed": 2.0}, "bodies.speed is now impact_speed. Rename it."),
        ([], {"step": 1e-5}, "bodies.step is now fixed_step. Rename it."),
        ([], {"materials": {"a": {"young": 1e7}}}, "materials.a.young is now youngs_modulus."),
        ([], {"pairs": [{"rolling": 0.1}]}, "pairs.0.rolling is now rolling_friction."),
        ([box([0, 0, 0], rounding=0.1)], {}, "bodies.0.rounding is now edge_radius."),
        ([sphere([0, 0, 0], copies=[2, 1, 1])], {}, "bodies.0.copies is now copies.number."),
        ([sphere([0, 0, 0], apart=[1, 1, 1])], {}, "bodies.0.apart is now copies.spacing."),
        ([sphere([0, 0, 0], dim=3)], {}, "bodies.0.dim is now agglomerate.dim."),
        ([sphere([0, 0, 0]) | {"diameter": 0.1}], {}, "bodies.0.diameter is now radius, half"),
        ([box([0, 0, 0]) | {"size": [1, 1, 1]}], {}, "bodies.0.size is now lowest and highest"),
        (
            [box([0, 0, 0]) | {"position": [0, 0, 0]}],
            {},
            "bodies.0.position is now centre",
        ),
    ],
)
def test_old_keys_are_answered_with_the_new_ones(bodies, settings, sentence):
    assert sentence in " ".join(mistakes(bodies, **settings))


def test_touching_is_allowed_at_every_orientation():
    turn = about([0.0, 0.0, 1.0], 0.3)
    bodies = [box([0, 0, 0.075], orientation=turn), box([0, 0, 0.225])]
    bodies += [sphere([0, 0, 0.31]), box([0.15, 0, 0.225])]
    assert params(bodies, planes=[FLOOR]).bodies[3].density == 800.0


def test_copies_stand_on_a_lattice_and_scatter_the_same_way_each_time():
    lattice = {"number": [2, 1, 3], "spacing": [0.1, 0.2, 0.3]}
    ball = sphere([1.0, 2.0, 3.0], copies=lattice)
    plain = np.array([body.position for body in params([ball]).bodies])
    expected = [[1.0 + x, 2.0, 3.0 + z] for x in (0.0, 0.1) for z in (0.0, 0.3, 0.6)]
    np.testing.assert_allclose(plain, expected)
    lattices = [lattice | {"scatter": 0.01, "seed": seed} for seed in (1, 1, 2)]
    loose = [list(params([ball | {"copies": copies}]).bodies) for copies in lattices]
    assert loose[0] == loose[1] != loose[2]
    offsets = np.array([body.position for body in loose[0]]) - expected
    assert 0.005 < np.abs(offsets).max() <= 0.01


def ports(scene):
    """Input and output ports, without their notes on ports that the scene leaves out."""
    sides = MANIFEST.ports(scene)
    return tuple(tuple(replace(port, lacks=()) for port in side) for side in sides)


def test_contact_forces_are_a_port_only_if_asked_for():
    scene = params([box([0.0, 0.0, 0.0])], contact_forces=True)
    assert ports(scene) == ((LOAD,), (MOTION, CONTACT))


def test_manifest_needs_no_solver():
    code = "import sys, quintet.components.dem_bodies; assert 'numba' not in sys.modules"
    subprocess.run([sys.executable, "-c", code], check=True)
    scene = params([box([0.0, 0.0, 0.0]), box([0.0, 0.0, 0.2])])
    assert ports(scene) == ((LOAD,), (MOTION,))
    plan = MANIFEST.plan(scene)
    assert plan.items == 2 and 1e-6 < plan.dt < 1e-3


@pytest.mark.parametrize("speed", [1.0, 20.0])
def test_steps_of_a_body_that_nothing_can_touch_are_planned_as_they_are(speed):
    ball = sphere([0.0, 0.0, 0.0], velocity=[speed, 0.0, 0.0])
    scene = params(
        [ball], {"a": material(youngs_modulus=1e9)}, gravity=[0.0, 0.0, 0.0], impact_speed=speed
    )
    lone, steps = DemBodies(scene), []
    run(lone, 0.1, watch=steps.append)
    assert MANIFEST.plan(scene).dt == pytest.approx(0.1 / len(steps), rel=0.5)


def test_forces_of_contacts_are_refused_beside_faces_that_they_would_lack():
    ball = sphere((0.0, 0.0, 0.1))
    assert build([ball], contact_with_faces=True) and build([ball], contact_forces=True)
    assert mistakes([ball], contact_with_faces=True, contact_forces=True) == [
        "bodies: contact_forces must be false with contact_with_faces, as port contact has no "
        "forces of faces; found both true. Leave out contact_forces."
    ]
