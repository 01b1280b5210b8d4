"""The front gauge: how far the largest group of touching bodies reaches along an axis."""

import numpy as np
import pytest
from dem_scenes import FLOOR, box, build, disc, mistakes, sphere

from quintet.components.dem_bodies.gauges import groups_of

NO_GRAVITY = [0.0, 0.0, 0.0]
DEEP = 0.02 - 2e-9  # m, distance at which spheres of 0.02 m touch, within the rounding of a scene
FIELDS = frozenset({"front_gauge.position", "front_gauge.share"})


def row(*places, z=0.0):
    return [sphere((x, 0.0, z)) for x in places]


def front(bodies, **settings):
    """Position [m] of the front, and the share of the bodies behind it."""
    fields = build(bodies, front_gauge="x", gravity=NO_GRAVITY, **settings).give(FIELDS)
    return float(fields["front_gauge.position"][0]), float(fields["front_gauge.share"][0])


def test_the_front_is_the_surface_of_the_farthest_body_that_touches_the_pile():
    bodies = row(0.0, DEEP, 2 * DEEP, 0.2)  # the last has rolled away
    assert front(bodies) == (pytest.approx(2 * DEEP + 0.01), 0.75)


def test_a_gap_parts_a_smaller_group_from_the_pile():
    bodies = row(0.0, DEEP, 2 * DEEP, 0.5, 0.5 + DEEP)
    assert front(bodies) == (pytest.approx(2 * DEEP + 0.01), 0.6)


def test_a_plane_connects_no_bodies():
    assert front(row(0.0, DEEP, 0.2, z=0.01 - 2e-9), planes=[FLOOR])[1] == pytest.approx(2 / 3)


def test_boxes_reach_as_far_as_their_faces_and_connect_spheres():
    bodies = [*row(2e-9), box((0.085, 0.0, 0.0)), *row(0.3)]
    position, share = front(bodies)
    assert position == pytest.approx(0.16, abs=1e-9) and share == pytest.approx(2 / 3)


def test_without_contacts_the_front_is_that_of_one_body():
    assert front(row(0.0, 0.1, 0.2)) == (pytest.approx(0.01), pytest.approx(1 / 3))


def test_groups_are_those_of_a_chain_in_any_order():
    random = np.random.default_rng(3)
    numbers = random.permutation(1000)
    chain = np.column_stack([numbers[:-1], numbers[1:]])[np.arange(999) != 600]
    groups = groups_of(1000, random.permutation(chain))
    first, second = numbers[:601], numbers[601:]
    assert set(groups[first]) == {first.min()} and set(groups[second]) == {second.min()}


def test_without_a_gauge_there_is_no_port_of_it():
    assert {port.name for port in build(row(0.0)).gives} == {"motion"}


def test_across_the_plane_of_two_dimensions_there_is_no_front():
    messages = mistakes([disc((0.0, 0.0, 0.0))], dimensions=2, front_gauge="y")
    assert (
        "front_gauge must be x or z in two dimensions" in messages[0] and "found y" in messages[0]
    )
