"""Inputs between the ends of a window follow their law, exactly where it can be exact."""

import itertools

import numpy as np
import pytest

from quintet.interfaces.component import Field, Port
from quintet.interfaces.errors import PortError
from quintet.interfaces.ports import FORCE, POSITION, VELOCITY
from quintet.interfaces.serving.inputs import Inputs

MOVED = Port("p", (POSITION, VELOCITY))
PUSHED = Port("q", (FORCE,))
HEATED = Port("h", (Field("temperature", (), "K"),))
WINDOW = 0.37  # s


def cubic(t):
    """Position and velocity (2, 3) on a cubic path."""
    a, b, c, d = np.random.default_rng(2).normal(size=(4, 2, 3))
    return a + b * t + c * t**2 + d * t**3, b + 2 * c * t + 3 * d * t**2


def between(inputs, count, window=WINDOW):
    """Inputs of each step when the window falls into so many."""
    edges = np.linspace(0.0, window, count + 1)
    edges[-1] = window
    return [(a, b, inputs.over(a, b, window)) for a, b in itertools.pairwise(edges)]


def moved(ends=True):
    inputs = Inputs((MOVED,))
    for t in (0.0, WINDOW) if ends else (0.0,):
        x, v = cubic(t)
        fields = {"p.position": x, "p.velocity": v}
        inputs.arrive(fields, () if t == 0.0 else ("p.position", "p.velocity"), WINDOW)
    return inputs


@pytest.mark.parametrize("count", [1, 2, 7, 50])
def test_a_cubic_path_is_given_exactly(count):
    for begin, end, fields in between(moved(), count):
        middle = cubic(0.5 * (begin + end))[0]
        np.testing.assert_allclose(fields["p.position"], middle, rtol=0, atol=1e-14)


@pytest.mark.parametrize("count", [1, 7, 50])
def test_the_mean_velocities_add_up_to_the_displacement(count):
    inputs = moved()
    total = sum(
        fields["p.velocity"] * (end - begin) for begin, end, fields in between(inputs, count)
    )
    displacement = cubic(WINDOW)[0] - cubic(0.0)[0]
    np.testing.assert_allclose(total, displacement, rtol=0, atol=4e-16 * count + 1e-15)


def test_beyond_the_last_known_end_a_position_goes_on_by_its_velocity():
    x, v = cubic(0.0)
    for begin, end, fields in between(moved(ends=False), 5):
        np.testing.assert_allclose(fields["p.position"], x + 0.5 * (begin + end) * v, atol=1e-15)
        np.testing.assert_allclose(fields["p.velocity"], v, rtol=1e-13)


def test_a_value_without_a_rate_goes_straight_or_stays():
    inputs = Inputs((HEATED,))
    first, last = np.array([300.0, 400.0]), np.array([310.0, 380.0])
    inputs.arrive({"h.temperature": first}, (), WINDOW)
    assert (inputs.over(0.1, 0.2, WINDOW)["h.temperature"] == first).all()
    inputs.arrive({"h.temperature": last}, ("h.temperature",), WINDOW)
    temperature = inputs.over(0.5 * WINDOW, WINDOW, WINDOW)["h.temperature"]
    np.testing.assert_allclose(temperature, first + 0.75 * (last - first), rtol=1e-15)


def test_what_was_an_end_is_the_next_beginning():
    inputs = moved()
    end = inputs.end["p.position"]
    inputs.arrive({}, (), WINDOW)
    assert inputs.start["p.position"] is end and not inputs.end


def test_an_impulse_is_given_as_the_rate_that_has_its_integral():
    inputs = Inputs((PUSHED,))
    assert inputs.constant
    inputs.arrive({"q.force": np.full((2, 3), 3.0)}, (), WINDOW)
    assert inputs.constant
    for begin, end, fields in between(inputs, 7):
        np.testing.assert_allclose(fields["q.force"] * WINDOW, 3.0, rtol=1e-15)
        assert end > begin


def test_what_is_given_may_not_be_written_into():
    inputs = moved()
    for _, _, fields in between(inputs, 3):
        for array in fields.values():
            with pytest.raises(ValueError, match="read-only"):
                array[0] = 0.0


def test_a_field_that_is_not_taken_or_changes_its_rows_is_refused():
    inputs = Inputs((MOVED,))
    with pytest.raises(PortError, match=r"field p\.mass is not taken here; the ports take p\.pos"):
        inputs.arrive({"p.mass": np.zeros(2)}, (), WINDOW)
    with pytest.raises(PortError, match=r"field p\.position must have shape \(2, 3\); found"):
        inputs.arrive({"p.position": np.zeros((2, 2))}, (), WINDOW)
    inputs.arrive({"p.velocity": np.zeros((4, 3))}, (), WINDOW)
    with pytest.raises(PortError, match=r"must have shape \(4, 3\); found \(5, 3\)"):
        inputs.arrive({"p.velocity": np.zeros((5, 3))}, (), WINDOW)


def test_saved_inputs_come_back_bit_for_bit():
    inputs, loaded = moved(), Inputs((MOVED,))
    loaded.load(inputs.save())
    for begin, end, fields in between(inputs, 3):
        loaded_fields = loaded.over(begin, end, WINDOW)
        assert all((loaded_fields[key] == fields[key]).all() for key in fields)
