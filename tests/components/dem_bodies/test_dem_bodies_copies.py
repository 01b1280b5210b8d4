"""Copies stand at their lattice points; overlaps are found without creating the copies."""

from itertools import combinations

import numpy as np
import pytest
from dem_scenes import FLOOR, box, mistakes, params, sphere

from quintet.components.dem_bodies import MANIFEST
from quintet.components.dem_bodies.params import Body
from quintet.components.dem_bodies.shapes import placement
from quintet.components.dem_bodies.shapes.copies import Bodies
from quintet.components.dem_bodies.shapes.description import rigid_body
from quintet.components.shared.search.overlapping import overlapping
from quintet.interfaces.params import read

APART = {"edge_radius": 0.002}


def test_each_copy_is_told_and_found_by_its_number():
    lattice = {"number": [3, 2, 4], "spacing": [0.1, 0.2, 0.3], "scatter": 0.01, "seed": 5}
    scene = params([sphere([1.0, 2.0, 3.0], copies=lattice), sphere([9.0, 0.0, 0.0])])
    positions = np.array([body.position for body in scene.bodies])
    initial = MANIFEST.initial(scene)
    assert (
        len(scene.bodies) == len(positions) == 25
        and (initial["motion.position"] == positions).all()
    )
    assert [scene.bodies[k].position for k in (0, 7, -1)] == [
        tuple(positions[k]) for k in (0, 7, 24)
    ]
    assert MANIFEST.plan(scene).items == 25
    with pytest.raises(IndexError):
        scene.bodies[25]


def test_pairs_of_spheres_of_all_sizes_are_found_once():
    random = np.random.default_rng(2)
    centres, radii = random.uniform(0.0, 1.0, (300, 3)), 10.0 ** random.uniform(-3.0, -0.7, 300)
    gaps = np.linalg.norm(centres[:, None] - centres, axis=2) - radii[:, None] - radii
    expected = {(i, j) for i, j in combinations(range(300), 2) if gaps[i, j] < 0.0}
    batches = [np.sort(np.stack(batch, axis=1)) for batch in overlapping(centres, radii)]
    pairs = [(int(i), int(j)) for i, j in np.concatenate(batches)]
    assert len(pairs) == len(set(pairs)) and set(pairs) == expected and len(expected) > 300


def scattered_scene(random):
    """Two lattices and two single bodies, of spheres and turned boxes, that may overlap."""
    bodies = []
    for number in range(4):
        turn = random.normal(size=4)
        place = random.uniform(0.0, 0.5, 3).tolist()
        if random.random() < 0.5:
            body = sphere(place, diameter=random.uniform(0.02, 0.1))
        else:
            size = random.uniform(0.02, 0.1, 3).tolist()
            body = box(place, size, orientation=(turn / np.linalg.norm(turn)).tolist(), **APART)
        if number < 2:
            body["copies"] = {
                "number": random.integers(1, 4, 3).tolist(),
                "spacing": random.uniform(0.06, 0.2, 3).tolist(),
                "scatter": float(random.choice([0.0, 0.01, 0.03])),
                "seed": number,
            }
        bodies.append(body)
    return bodies


def overlap(bodies):
    """Whether any two bodies overlap, each compared with each."""
    rigid_bodies = [rigid_body("body", read(Body, body, "body")[0]) for body in bodies]
    radii = [placement.bounding_radius(body) for body in Bodies(rigid_bodies)]
    pairs = combinations(zip(Bodies(rigid_bodies), radii, strict=True), 2)
    return any(placement.body_gap(a, b) < -1e-6 * min(r, s) for (a, r), (b, s) in pairs)


def test_what_overlaps_is_refused_and_nothing_else():
    overlaps = []
    for seed in range(60):
        bodies = scattered_scene(np.random.default_rng(seed))
        overlaps.append(overlap(bodies))
        assert bool(mistakes(bodies)) == overlaps[-1], (seed, mistakes(bodies))
    assert 5 < sum(overlaps) < 55


def test_copies_below_a_plane_are_refused_by_their_lowest():
    lattice = {"number": [2, 2, 3], "spacing": [0.1, 0.1, 0.1]}
    slope = FLOOR | {"normal": [0.0, 0.6, 0.8]}
    assert not mistakes([sphere([0.0, 0.0, 0.02], copies=lattice)], planes=[slope])
    (message,) = mistakes([sphere([0.0, -0.2, 0.1], copies=lattice)], planes=[slope])
    assert "bodies[0] must start above planes[0]; it reaches 0.05 m below" in message
    ceiling = FLOOR | {"normal": [0.0, 0.0, -1.0], "point": [0.0, 0.0, 0.25]}
    (message,) = mistakes([sphere([0.0, 0.0, 0.1], copies=lattice)], planes=[ceiling])
    assert "bodies[2] must start above planes[0]; it reaches 0.06 m below" in message


def test_very_many_scattered_copies_must_be_apart_however_they_fall():
    lattice = {"number": [100, 100, 100], "spacing": [0.03, 0.03, 0.03], "scatter": 6e-3}
    (message,) = mistakes([sphere([0.0, 0.0, 1.0], copies=lattice)])
    assert "by 0.006 m some may, by 0.002 m. Lower scatter, or widen spacing." in message
    assert not mistakes([sphere([0.0, 0.0, 1.0], copies=lattice | {"scatter": 4e-3})])
    (message,) = mistakes(
        [sphere([0.0, 0.0, 0.0], copies=lattice | {"number": [2000, 2000, 2000]})]
    )
    assert "bodies, with their copies, must be at most 2147483647; found 8e+09." in message
