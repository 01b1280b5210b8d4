"""Rotations: exact for steady turning, of unit length always, smooth where it is not steady."""

from itertools import pairwise

import numpy as np
import pytest

from quintet.interfaces import rotation
from quintet.interfaces.component import Port
from quintet.interfaces.ports import ANGULAR_VELOCITY, ORIENTATION
from quintet.interfaces.serving.inputs import Inputs

POSE = Port("pose", (ORIENTATION, ANGULAR_VELOCITY))
WINDOW = 0.4  # s
RANDOM = np.random.default_rng(7)
AXES = RANDOM.normal(size=(6, 3))
AXES /= np.linalg.norm(AXES, axis=1)[:, None]
START = rotation.exponential(2.0 * RANDOM.normal(size=(6, 3)))


def angle_between(a, b):
    """Angle [rad] of the rotation between quaternions, whatever their signs."""
    return 2.0 * np.linalg.norm(rotation.product(b, rotation.conjugate(a))[:, 1:], axis=1)


def pose(quaternion, rate):
    return {"pose.orientation": quaternion, "pose.angular_velocity": rate}


def between_ends(first, last, ends=True):
    inputs = Inputs((POSE,))
    inputs.arrive(pose(*first), (), WINDOW)
    if ends:
        inputs.arrive(pose(*last), ("pose.orientation", "pose.angular_velocity"), WINDOW)
    return inputs


@pytest.mark.parametrize("turn", [1e-9, 1e-3, 1.0, 3.0, 5.0, 9.0])  # rad in a window
@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("is_end_known", [True, False])
def test_steady_turning_is_exact_and_of_unit_length_in_mid_window(turn, sign, is_end_known):
    """The end's quaternion may have either sign: both are the same rotation."""
    rate = turn / WINDOW * AXES
    last = sign * rotation.turned(START, rate, WINDOW)
    inputs = between_ends((START, rate), (last, rate), is_end_known)
    orientation = inputs.over(0.0, WINDOW, WINDOW)["pose.orientation"]
    exact = rotation.turned(START, rate, 0.5 * WINDOW)
    assert np.abs(np.linalg.norm(orientation, axis=1) - 1.0).max() < 1e-14
    assert angle_between(orientation, exact).max() < 1e-12
    for begin, end in ((0.0, 0.1), (0.1, 0.25), (0.25, WINDOW)):
        mean_rate = inputs.over(begin, end, WINDOW)["pose.angular_velocity"]
        np.testing.assert_allclose(mean_rate, rate, rtol=1e-9, atol=1e-13)


def precession(time):
    """Orientation and angular velocity (1, .) of a top that spins, and leans as it turns."""
    spin = rotation.exponential(np.array([[0.0, 0.0, 3.0 * time]]))
    lean = rotation.exponential(np.array([[0.7 * time, 0.4 * time**2, 0.0]]))
    return rotation.product(lean, spin)


def rate_of(path, time, step=1e-4):
    ends = path(time - step), path(time + step)
    return rotation.vector_between(*ends, np.zeros((1, 3))) / (2.0 * step)


def test_unsteady_turning_converges():
    errors = []
    for window in (0.4, 0.2, 0.1, 0.05):
        first, last = (
            (precession(time), rate_of(precession, time)) for time in (1.0, 1.0 + window)
        )
        inputs = Inputs((POSE,))
        inputs.arrive(pose(*first), (), window)
        inputs.arrive(pose(*last), ("pose.orientation", "pose.angular_velocity"), window)
        orientation = inputs.over(0.2 * window, 0.4 * window, window)["pose.orientation"]
        errors.append(angle_between(orientation, precession(1.0 + 0.3 * window)).max())
    assert np.log2(np.array(errors[:-1]) / errors[1:]).min() > 3.5


def test_mean_rates_lead_from_step_to_step():
    """Turning by the mean angular velocity of every step ends where the window ends."""
    rates = 4.0 * RANDOM.normal(size=(2, 6, 3))
    last = rotation.turned(START, rates.mean(axis=0), WINDOW)
    inputs = between_ends((START, rates[0]), (last, rates[1]))
    reached, marks = START, np.linspace(0.0, WINDOW, 8)
    marks[-1] = WINDOW
    for begin, end in pairwise(marks):
        mean = inputs.over(begin, end, WINDOW)["pose.angular_velocity"]
        reached = rotation.turned(reached, mean, end - begin)
    assert angle_between(reached, last).max() < 1e-13


def test_a_matrix_turns_as_its_quaternion():
    vector = np.array([[0.0, 0.0, 0.5 * np.pi]])
    turned = rotation.matrix(rotation.exponential(vector))[0] @ [1.0, 0.0, 0.0]
    np.testing.assert_allclose(turned, [0.0, 1.0, 0.0], atol=1e-15)


def test_the_rate_of_a_rotation_vector_is_that_of_the_rotation():
    vector, rate, step = RANDOM.normal(size=(5, 3)), RANDOM.normal(size=(5, 3)), 1e-6
    moved = rotation.turned(rotation.exponential(vector), rate, step)
    quotient = (rotation.logarithm(moved, vector) - vector) / step
    np.testing.assert_allclose(
        rotation.rate_of_vector(vector, rate), quotient, rtol=1e-4, atol=1e-5
    )
