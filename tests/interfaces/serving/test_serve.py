"""The serving loop: substeps fill the window, impulses close, a state comes back bit for bit."""

import math

import numpy as np
import pytest

from quintet.interfaces.component import Component, Field, Port
from quintet.interfaces.errors import MessageError, OrderError, PortError, StepError
from quintet.interfaces.lines.memory import MemoryLine
from quintet.interfaces.lines.message import Message
from quintet.interfaces.ports import FORCE, POSITION, VELOCITY
from quintet.interfaces.serving.outputs import Outputs
from quintet.interfaces.serving.serve import Server, answer, divide

MOVED = Port("foot", (POSITION, VELOCITY))
PUSHED = Port("load", (FORCE,))
GIVEN = Port("push", (FORCE,))
WINDOW = 0.013  # s
N = 4


class Spring(Component):
    """Springs on moving feet, under loads; `stable` has the limit of each step."""

    takes = (MOVED, PUSHED)
    gives = (GIVEN, Port("motion", (POSITION,)))

    def __init__(self, stable):
        self.stable = list(stable)
        self.x, self.v, self.force = np.zeros((N, 3)), np.zeros((N, 3)), np.zeros((N, 3))
        self.foot, self.load_ = np.zeros((N, 3)), np.zeros((N, 3))
        self.taken, self.times = [], []

    def stable_dt(self):
        return self.stable[min(len(self.times), len(self.stable) - 1)]

    def take(self, fields):
        self.foot = fields.get("foot.position", self.foot)
        self.load_ = fields.get("load.force", self.load_)
        self.taken.append(fields)

    def step(self, dt):
        self.force = 40.0 * (self.foot - self.x) - 0.3 * self.v
        self.v = self.v + dt * (self.force + self.load_)
        self.x = self.x + dt * self.v
        self.times.append(dt)

    def give(self, wanted):
        return {"push.force": -self.force, "motion.position": self.x.copy()}

    def save(self):
        return {"x": self.x.copy(), "v": self.v.copy(), "steps": np.array([len(self.times)])}

    def load(self, state):
        self.x, self.v = np.array(state["x"]), np.array(state["v"])
        del self.times[int(state["steps"][0]) :]


def bound_server(stable):
    server = Server(Spring(stable), "spring")
    for order in ("describe", "bind"):
        server.handle(Message({"order": order}))
    return server


def fields(window, seed=5):
    random = np.random.default_rng(seed)
    position, velocity = random.normal(size=(2, N, 3))
    position = position + window * WINDOW * velocity
    force = random.normal(size=(N, 3)) * WINDOW
    return {"foot.position": position, "foot.velocity": velocity, "load.force": force}


def advance(server, window, ends=("foot.position", "foot.velocity"), order="advance"):
    header = {"order": order, "window": window, "dt": WINDOW, "ends": list(ends)}
    return server.handle(Message(header, fields(window)))


# Limits for 1, 7 and 50 equal steps; for no whole number of them; and one that changes.
LIMITS = {
    "1": [math.inf],
    "7": [WINDOW / 7],
    "50": [WINDOW / 50],
    "6.3": [WINDOW / 6.3],
    "changing": [WINDOW / 3, WINDOW / 11, WINDOW / 2.7, WINDOW / 9, WINDOW / 5],
}


@pytest.mark.parametrize("limits", LIMITS.values(), ids=LIMITS)
def test_steps_fill_the_window_and_keep_to_the_limit(limits):
    server = bound_server(limits)
    header, _ = advance(server, 0)
    times = server.component.times
    assert header["steps"] == len(times)
    assert math.fsum(times) == pytest.approx(WINDOW, rel=1e-14)
    for dt, limit in zip(times, limits + [limits[-1]] * len(times), strict=False):
        assert dt <= limit * (1 + 1e-9)


@pytest.mark.parametrize(("ratio", "steps"), [("1", 1), ("7", 7), ("50", 50), ("6.3", 7)])
def test_a_window_falls_into_the_fewest_equal_steps(ratio, steps):
    server = bound_server(LIMITS[ratio])
    assert advance(server, 0)[0]["steps"] == steps
    assert np.ptp(server.component.times) < 1e-15


@pytest.mark.parametrize("limits", LIMITS.values(), ids=LIMITS)
def test_impulses_close_to_rounding_at_every_ratio(limits):
    server = bound_server(limits)
    component = server.component
    for window in range(3):
        velocity, steps = component.v, len(component.times)
        header, outputs = advance(server, window)
        gained = component.v - velocity
        load = fields(window)["load.force"]
        # The change of its momentum is the received impulse less the impulse that it gave.
        np.testing.assert_allclose(gained, load - outputs["push.force"], rtol=0, atol=3e-16 * N)
        assert header["steps"] == len(component.times) - steps
        scale = np.abs(load).sum()
        for totals in (header["received"], header["applied"]):
            assert np.abs(totals["load.force"] - load.sum(axis=0)).max() <= 4e-16 * scale
        gap = header["sent"]["push.force"] - outputs["push.force"].sum(axis=0)
        assert np.abs(gap).max() <= 4e-16 * np.abs(outputs["push.force"]).sum()


@pytest.mark.parametrize("limits", LIMITS.values(), ids=LIMITS)
def test_what_moves_a_component_moves_by_the_whole_displacement(limits):
    server = bound_server(limits)
    advance(server, 0)
    server.component.taken.clear()
    server.component.times.clear()
    advance(server, 1)
    component = server.component
    steps = zip(component.taken, component.times, strict=True)
    moved = sum(inputs["foot.velocity"] * dt for inputs, dt in steps)
    displacement = fields(1)["foot.position"] - fields(0)["foot.position"]
    np.testing.assert_allclose(moved, displacement, rtol=0, atol=1e-15 * len(component.times))


def test_inputs_that_do_not_change_are_taken_once():
    server = bound_server(LIMITS["50"])
    message = Message({"order": "advance", "window": 0, "dt": WINDOW, "ends": []})
    message.fields["load.force"] = np.ones((N, 3))
    server.handle(message)
    assert len(server.component.taken) == 1


@pytest.mark.parametrize("stable", [math.nan, -1.0, 0.0, -math.inf])
def test_a_step_that_is_not_positive_is_refused(stable):
    with pytest.raises(StepError, match=f"stable_dt must be positive; it is {stable}"):
        divide(1.0, stable)
    with pytest.raises(StepError, match="must be positive"):
        advance(bound_server([stable]), 0)


def test_a_step_that_never_ends_the_window_is_refused():
    with pytest.raises(StepError, match=r"stable_dt must be above 1\.0e-09 s, .* it is 1e-30"):
        divide(1.0, 1e-30)


def test_no_limit_is_one_step():
    assert divide(1e9, math.inf) == 1
    assert divide(0.3, 0.1) == 3  # although 0.3 / 0.1 is a little more than 3


@pytest.mark.parametrize("limits", LIMITS.values(), ids=LIMITS)
def test_a_window_repeated_after_a_rewind_gives_the_same_bits(limits):
    server = bound_server(limits)
    advance(server, 0)
    server.handle(Message({"order": "keep"}))
    _, first = advance(server, 1)
    state = server.state()
    for _ in range(2):
        server.handle(Message({"order": "rewind"}))
        _, repeated = advance(server, 1)
        assert all(repeated[key].tobytes() == first[key].tobytes() for key in first)
        assert all(server.state()[key].tobytes() == state[key].tobytes() for key in state)


def test_a_saved_state_goes_on_with_the_same_bits_in_another_server():
    server, resumed = bound_server(LIMITS["changing"]), bound_server(LIMITS["changing"])
    for window in range(2):
        advance(server, window)
    _, state = server.handle(Message({"order": "save"}))
    resumed.component.times = list(server.component.times)
    resumed.handle(Message({"order": "load", "window": 2}, dict(state)))
    outputs, resumed_outputs = advance(server, 2)[1], advance(resumed, 2)[1]
    assert all(outputs[key].tobytes() == resumed_outputs[key].tobytes() for key in outputs)


def test_orders_out_of_turn_and_windows_that_are_no_numbers_are_refused():
    server = Server(Spring([1.0]), "spring")
    with pytest.raises(OrderError, match="when new, an order must be one of describe, finish"):
        advance(server, 0)
    server = bound_server([1.0])
    with pytest.raises(OrderError, match="window 0 is next; window 4 was ordered"):
        advance(server, 4)
    with pytest.raises(OrderError, match="window must be a whole number from 0; found 'one'"):
        server.handle(Message({"order": "advance", "window": "one"}))


def test_numbers_that_are_not_finite_are_refused_on_arrival():
    server = bound_server([1.0])
    message = Message({"order": "advance", "window": 0, "dt": WINDOW, "ends": []}, fields(0))
    message.fields["load.force"][2] = np.nan
    with pytest.raises(MessageError, match=r"window 0, received: .* load\.force .* item 2"):
        server.handle(message)


@pytest.mark.parametrize(
    ("outputs", "words"),
    [
        ({"push.force": np.zeros((N, 2))}, r"output push\.force must have shape \(n, \*\(3,\)\)"),
        ({"push.force": np.zeros((N, 3))}, r"motion\.position is missing"),
        ({"push.torque": np.zeros((N, 3))}, r"output push\.torque must have shape"),
    ],
)
def test_outputs_that_do_not_fit_their_ports_are_refused(outputs, words):
    server = bound_server([1.0])
    server.component.give = lambda wanted: outputs
    with pytest.raises(PortError, match=words):
        server.handle(Message({"order": "give"}))


@pytest.mark.parametrize(
    ("outputs", "words"),
    [
        (None, r"give\(\) must return its fields by name; found NoneType"),
        ({"push.force": None}, r"output push\.force must be an array .* found NoneType"),
        ({"push.force": [[0.0] * 3] * N}, r"output push\.force must be an array .* found list"),
        ({"push.force": np.zeros((N, 3), complex)}, r"push\.force .* found complex128"),
        ({"push.force": np.full((N, 3), None)}, r"push\.force .* found object"),
        ({"push.force": np.zeros((N + 1, 3))}, r"keep its shape \(4, 3\); found \(5, 3\)\. The"),
        ({"push.force": np.zeros((1, 3))}, r"keep its shape \(4, 3\); found \(1, 3\)"),
    ],
)
@pytest.mark.parametrize("stable", [1.0, 0.4 * WINDOW])
def test_a_field_that_changes_its_kind_or_shape_is_named(outputs, words, stable):
    server = bound_server([stable])
    server.handle(Message({"order": "give"}))
    plain = server.component.give
    server.component.give = lambda wanted: outputs if outputs is None else plain(wanted) | outputs
    with pytest.raises(PortError, match=words):
        server.advance(WINDOW)


def test_an_error_goes_back_over_the_line_with_its_traceback(capsys):
    server = Server(Spring([1.0]), "spring")
    line = MemoryLine("r", "spring")
    going = []
    line.handle = lambda message: going.append(answer(server, line.far, message))

    def broken():
        raise ArithmeticError("no such thing")

    server.component.stable_dt = broken
    for order in ("describe", "bind", "prepare"):
        line.send({"order": order}, {})
    assert [line.receive(0.0).order for _ in range(2)] == ["done", "done"]
    failed = line.receive(0.0)
    assert failed.order == "failed" and failed.header["error"] == "ArithmeticError"
    assert "no such thing" in failed.header["text"] and "in broken" in failed.header["traceback"]
    assert going == [True, True, False]
    assert "no such thing" in capsys.readouterr().err  # and into the component's log


def test_a_port_without_items_is_served():
    server = bound_server([WINDOW])
    server.component.give = lambda wanted: {
        "push.force": np.zeros((0, 3)),
        "motion.position": np.zeros((N, 3)),
    }
    header, outputs = advance(server, 0)
    assert header["sent"]["push.force"] == [0.0, 0.0, 0.0]
    assert outputs["push.force"].shape == (0, 3)


def test_field_units_and_centrings_come_from_a_closed_list():
    with pytest.raises(PortError, match=r"field f: a unit must be one of .* found 'kN'"):
        Field("f", (3,), "kN")
    with pytest.raises(PortError, match="field f: an impulse field must be in"):
        Field("f", (3,), "m", "impulse")


def test_fields_of_a_port_have_one_row_for_each_item_from_the_start():
    outputs = Outputs([Port("motion", (POSITION, VELOCITY))])
    outputs.check({"motion.position": np.zeros((N, 3))})
    words = r"motion.velocity must have as many rows as motion.position, 4: .* found shape \(2, 3\)"
    with pytest.raises(PortError, match=words):
        outputs.check({"motion.velocity": np.zeros((2, 3))})


def test_warnings_that_are_no_texts_by_subject_are_refused(monkeypatch):
    server = bound_server([WINDOW])
    server.handle(Message({"order": "prime"}))
    monkeypatch.setattr(server.component, "final_warnings", lambda: None)
    with pytest.raises(PortError, match=r"final_warnings\(\) must return .* found NoneType"):
        server.handle(Message({"order": "conclude"}))


def test_work_and_moment_of_integrals_are_those_of_their_rates():
    """What gives integrals over its steps does the same work as what gives rates."""
    random, dt = np.random.default_rng(3), 0.25
    force, taken = random.normal(size=(N, 3)), random.normal(size=(2, N, 3))
    sums = []
    for is_integral in (False, True):
        outputs = Outputs((GIVEN,), is_integral)
        outputs.works = [("push.force", "foot.velocity", "foot.position")]
        outputs.begin()
        moved = {"foot.velocity": taken[0], "foot.position": taken[1]}
        outputs.add({"push.force": force * dt if is_integral else force}, moved, dt)
        sums.append(outputs.audit())
    for key, numbers in sums[0].items():
        np.testing.assert_allclose(sums[1][key], numbers, rtol=1e-14)
    assert sums[0]["push.force/work"][0] != 0.0
