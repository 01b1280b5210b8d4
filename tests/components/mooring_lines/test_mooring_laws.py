"""One line between its ends, against closed forms, and its pull as the slope of its energy."""

import math

import numpy as np
import pytest

from quintet.components.mooring_lines.laws import (
    SLACK,
    Cable,
    end_of,
    energy,
    hanging_pull,
    lying_length,
    place_along,
    straight_pull,
)

UNKNOWN = (0.0, 0.0)  # N, where no pull is known to begin with


def random_lines(count, seed=3):
    """Cables from slack to taut, light to heavy, soft to stiff, and places of their fairleads."""
    random = np.random.default_rng(seed)
    for _ in range(count):
        length, weight = 10.0 ** random.uniform(-1, 2), 10.0 ** random.uniform(-2, 3)
        stiffness = weight * length * 10.0 ** random.uniform(0.3, 6)
        has_bed = bool(random.random() < 0.5)
        z = length * random.uniform(0.0 if has_bed else -1.0, 1.0)
        x = random.choice([0.0, 1e-7, random.uniform(0.0, 1.2)], p=[0.05, 0.05, 0.9])
        yield Cable(length, stiffness, weight, has_bed), x * length, z


def test_lines_end_at_their_fairleads():
    slack = 0
    for cable, x, z in random_lines(3000):
        pull = hanging_pull(cable, x, z, *UNKNOWN)
        assert pull.misses < 1e-12, (cable, x, z)
        end_x, end_z = end_of(cable, pull.horizontal, pull.vertical)
        assert end_z == pytest.approx(z, abs=2e-13 * cable.length)
        # The rest of a slack line lies in a heap, or hangs straight down.
        least = SLACK * cable.weight * cable.length
        is_slack = end_x > x + 1e-6 * cable.length
        assert not is_slack or pull.horizontal < 1.1 * least
        slack += is_slack
    assert 100 < slack < 1000


def test_the_pull_is_the_slope_of_the_energy():
    for cable, x, z in random_lines(300, seed=4):
        step = 1e-5 * cable.length
        if x < 0.05 * cable.length or z < 0.05 * cable.length:
            continue
        pull = hanging_pull(cable, x, z, *UNKNOWN)
        energies = []
        for dx, dz in ((step, 0.0), (-step, 0.0), (0.0, step), (0.0, -step)):
            moved = hanging_pull(cable, x + dx, z + dz, *UNKNOWN)
            energies.append(energy(cable, moved.horizontal, moved.vertical, x + dx, z + dz))
        slopes = [
            (energies[0] - energies[1]) / (2 * step),
            (energies[2] - energies[3]) / (2 * step),
        ]
        size = math.hypot(pull.horizontal, pull.vertical)
        rounding = 1e-13 * max(map(abs, energies)) / step
        assert slopes == pytest.approx(pull[:2], abs=1e-3 * size + rounding)


def test_a_line_that_hardly_stretches_is_the_catenary():
    """z = a (cosh(x/a) - 1) and L = a sinh(x/a), with a = H/w, from its lowest point."""
    a, x, weight = 2.5, 3.0, 40.0
    length, z = a * math.sinh(x / a), a * (math.cosh(x / a) - 1.0)
    cable = Cable(length, 1e13, weight, False)
    pull = hanging_pull(cable, x, z, *UNKNOWN)
    assert pull.horizontal == pytest.approx(weight * a, rel=1e-9)
    assert pull.vertical == pytest.approx(weight * length, rel=1e-9)
    middle = a * math.sinh(0.5 * x / a)  # length to half of x
    assert place_along(cable, pull.horizontal, pull.vertical, middle) == pytest.approx(
        (0.5 * x, a * (math.cosh(0.5 * x / a) - 1.0), weight * a * math.cosh(0.5 * x / a)), rel=1e-9
    )
    # The same with two metres more, which lie on the bed.
    longer = Cable(length + 2.0, 1e13, weight, True)
    pull = hanging_pull(longer, x + 2.0, z, *UNKNOWN)
    assert pull.horizontal == pytest.approx(weight * a, rel=1e-9)
    assert lying_length(longer, pull.vertical) == pytest.approx(2.0, rel=1e-9)


def test_a_vertical_line_stretches_by_its_own_weight():
    length, stiffness, weight, pulled = 10.0, 500.0, 3.0, 60.0
    stretch = pulled * length / stiffness - 0.5 * weight * length**2 / stiffness
    pull = hanging_pull(Cable(length, stiffness, weight, False), 0.0, length + stretch, *UNKNOWN)
    assert pull.vertical == pytest.approx(pulled, rel=1e-6)
    assert pull.horizontal == pytest.approx(0.0, abs=1e-6 * pulled)


def test_a_light_line_pulls_like_a_straight_one():
    cable = Cable(4.0, 2e4, 1e-9, False)
    pull = hanging_pull(cable, 3.0, 3.0, *UNKNOWN)
    tension = straight_pull(math.hypot(3.0, 3.0), cable.length, cable.stiffness)
    assert math.hypot(*pull[:2]) == pytest.approx(tension, rel=1e-9)
    assert pull.horizontal == pytest.approx(pull.vertical, rel=1e-6)
    assert straight_pull(3.9, cable.length, cable.stiffness) == 0.0


def test_a_search_from_the_pull_a_moment_ago_finds_the_same():
    for cable, x, z in random_lines(500, seed=5):
        first = hanging_pull(cable, x, z, *UNKNOWN)
        size = math.hypot(*first[:2])
        for share in (0.9, 0.3, 1.6):
            other = hanging_pull(cable, share * x, share * z, *UNKNOWN)
            again = hanging_pull(cable, x, z, other.horizontal, other.vertical)
            assert again.misses < 1e-12, (cable, x, z, share)
            assert again[:2] == pytest.approx(first[:2], abs=1e-6 * size)


def test_a_slack_line_hangs_straight_down():
    """Half of what is longer than the way hangs at each end: V = w (L + z) / 2."""
    for rise in (-6.0, 0.0, 5.0, 9.9):
        pull = hanging_pull(Cable(10.0, 1e9, 50.0, False), 0.0, rise, *UNKNOWN)
        assert pull.misses < 1e-12
        assert pull.vertical == pytest.approx(25.0 * (10.0 + rise), abs=1e-3)


def test_the_energy_of_a_light_taut_line_is_that_of_its_stretch():
    for weight in (1e-6, 1e-9, 1e-12):
        cable = Cable(10.0, 1e6, weight, False)
        pull = hanging_pull(cable, 9.0, 5.0, *UNKNOWN)
        stretch = math.hypot(9.0, 5.0) - 10.0
        stored_energy = energy(cable, *pull[:2], 9.0, 5.0)
        assert stored_energy == pytest.approx(0.5 * 1e6 / 10.0 * stretch**2, rel=1e-6)
