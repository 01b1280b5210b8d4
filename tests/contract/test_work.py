"""Work of forces and of torques: the same on both sides of a link, if both saw the same motion."""

import laboratory
import numpy as np
import pytest

PAIRS = [["balls.motion", "wind.body"], ["wind.drag", "balls.load"]]
END = 0.8  # s


def _run(folder, window, ratio, scheme, mass=2.0, order=("balls", "wind"), twist=0.05, **settings):
    components = {
        "balls": {"kind": "toy_bodies:Balls", "mass": mass, "dt": window},
        "wind": {"kind": "toy_bodies:Wind", "dt": window / ratio, "twist": twist},
    }
    link = {"kind": "direct", "pairs": PAIRS}
    settings |= {"end": END, "window": window, "scheme": scheme, "order": list(order)}
    return laboratory.couple(laboratory.scene(folder, components, link, **settings)).account


@pytest.mark.parametrize("order", [("balls", "wind"), ("wind", "balls")])
@pytest.mark.parametrize("ratio", [1, 7])
@pytest.mark.parametrize("scheme", ["serial", "parallel", "iterated"])
def test_of_bodies_that_hardly_yield_both_sides_count_the_same(tmp_path, scheme, ratio, order):
    account = _run(tmp_path, 0.05, ratio, scheme, 1e18, order)
    late = scheme == "parallel" or (scheme == "serial" and order[0] == "balls")
    assert account.turnover > 1.0
    if not late:  # the last window's impulse is not yet applied
        assert account.energy_residual < 1e-12


def test_forces_and_torques_both_work(tmp_path):
    """Of bodies that do not yield the forces' work is known by hand; the rest is the torques'."""
    v = np.array([[1.0, 0.0, 0.2], [0.0, -0.7, 0.0]])
    by_force = END * 0.8 * ((np.array([2.0, 0.0, 0.5]) - v) * v).sum()
    forces = _run(tmp_path, 0.05, 1, "iterated", 1e18, twist=1e-12)
    assert forces.work_given == pytest.approx(by_force, rel=1e-9)
    combined = _run(tmp_path, 0.05, 1, "iterated", 1e18)
    assert abs(combined.work_taken - by_force) > 0.5


@pytest.mark.parametrize(
    ("scheme", "order", "first"),
    [("serial", 0.9, "balls"), ("serial", 0.9, "wind"), ("parallel", 0.9, "balls")],
)
def test_of_a_free_body_the_difference_falls_at_first_order(tmp_path, scheme, order, first):
    members = (first, "wind" if first == "balls" else "balls")
    gaps = [
        _run(tmp_path, window, 4, scheme, order=members).energy_residual
        for window in (0.1, 0.05, 0.025)
    ]
    assert min(laboratory.orders(gaps)) > order


def test_iterated_the_difference_falls_at_second_order(tmp_path):
    gaps = [
        _run(tmp_path, window, 4, "iterated", iteration={"tolerance": 1e-10}).energy_residual
        for window in (0.1, 0.05, 0.025)
    ]
    assert min(laboratory.orders(gaps)) > 1.8


def test_iterated_with_one_equal_step_both_sides_agree_to_the_tolerance(tmp_path):
    for tolerance in (1e-6, 1e-10):
        account = _run(tmp_path, 0.05, 1, "iterated", iteration={"tolerance": tolerance})
        assert account.energy_residual < 100 * tolerance + 1e-12
