"""Schemes: the fields that components see of each other, and how repeated windows converge."""

import numpy as np
import pytest

from quintet.coupler.coupling import plan
from quintet.coupler.coupling.exchange import Exchange
from quintet.coupler.coupling.iteration.acceleration import make as make_acceleration
from quintet.coupler.coupling.iteration.convergence_measure import ConvergenceMeasure, converged
from quintet.coupler.coupling.iteration.settings import IterationSettings
from quintet.coupler.coupling.ledger import Ledger
from quintet.coupler.coupling.links import maker
from quintet.coupler.coupling.plan import CouplingPlan
from quintet.coupler.coupling.schedule import Coupling, Single, Window
from quintet.coupler.coupling.schemes import SCHEMES
from quintet.interfaces.component import Field, Port
from quintet.interfaces.lines.message import Message

KEY = ("first", "in.value")
PLACE = Field("value", (), "m")


def _solve(slope, settings, start=0.0, limit=60):
    """Steps that the relaxed iteration of x = slope x + 1 takes to 1e-10."""
    acceleration, x = make_acceleration(settings, _is_no_impulse), np.array([start])
    acceleration.begin_window(1.0)
    for step in range(limit):
        answer = slope * x + 1.0
        if abs(answer[0] - x[0]) < 1e-10:
            return step
        x = acceleration.next({KEY: x}, {KEY: answer}, {KEY: 1e-10})[KEY]
    return None


def _is_no_impulse(name, key):
    return False


def _agrees(measure, gap, fields):
    """Whether fields converged whose guess differed by a gap."""
    guess = {key: fields[key] - gap[key] for key in fields}
    return converged(measure.compare(guess, fields, 1.0))


@pytest.mark.parametrize("slope", [-3.0, -0.9, 0.5, 0.99])
def test_aitken_solves_one_linear_unknown_in_two_steps(slope):
    assert _solve(slope, IterationSettings()) == 2


def test_constant_relaxation_converges_if_it_is_small_enough():
    assert (
        _solve(-3.0, IterationSettings(relaxation=0.25, acceleration="constant")) == 1
    )  # just right
    assert _solve(-3.0, IterationSettings(relaxation=0.1, acceleration="constant")) > 20
    assert _solve(-3.0, IterationSettings(relaxation=0.6, acceleration="constant")) is None


def test_aitken_survives_a_residual_that_does_not_change():
    aitken = make_acceleration(IterationSettings(), _is_no_impulse)
    aitken.begin_window(1.0)
    for _ in range(3):
        guess = aitken.next({KEY: np.zeros(2)}, {KEY: np.ones(2)}, {KEY: 0.0})
    assert np.isfinite(guess[KEY]).all()


def test_what_is_nothing_but_rounding_need_not_agree():
    force, torque = ("cube", "load.force"), ("cube", "load.torque")
    fields = {force: np.array([0.07]), torque: np.array([2e-18])}
    measure = ConvergenceMeasure(IterationSettings().tolerance, {}, _is_no_impulse)
    assert _agrees(measure, {force: np.array([1e-9]), torque: np.array([1e-18])}, fields)
    assert not _agrees(measure, {force: np.array([1e-6]), torque: np.array([1e-18])}, fields)
    fields[torque] = np.array([2e-4])
    assert not _agrees(measure, {force: np.array([1e-9]), torque: np.array([1e-6])}, fields)


class _Stub:
    """A participant that gives prepared answers in each window; nothing runs."""

    stable = 1.0  # s

    def __init__(self, name, answers):
        self.name, self.answers, self.log = name, answers, []
        self.window, self.kept = 0, 0

    def start(self, dt, fields, ends, totals, steps):
        self.log.append({key: (float(v[0]), key in ends) for key, v in fields.items()})

    def finish(self):
        header = {"sent": {}, "received": {}, "applied": {}}
        header["inputs"] = {"first": {}, "moved": {}, "span": 1.0}
        message = Message(header, {"out.value": np.array([self.answers[self.window]])})
        self.window += 1
        return message

    def order_keep(self, depth):
        self.kept = self.window

    def order_rewind(self, depth):
        self.window = self.kept

    def receive(self):
        pass


def _coupling(pairs, scheme, names="abc"):
    port_in, port_out = Port("in", (PLACE,)), Port("out", (PLACE,))
    partner = Port("in", (PLACE,), items="partner")
    ports = {name: ((partner if name == "b" else port_in,), (port_out,)) for name in names}
    links = [
        maker("direct")(n, {"name": str(n), "pairs": [[f"{a}.out", f"{b}.in"]]}, ports)
        for n, (a, b) in enumerate(pairs)
    ]
    exchange = Exchange(links, ports)
    exchange.bind({name: {} for name in names})
    stubs = {name: _Stub(name, [1.0 + n, 11.0 + n]) for n, name in enumerate(names)}
    members = {name: Single(stub) for name, stub in stubs.items()}
    plan = CouplingPlan("", dict.fromkeys(names), scheme)
    coupling = Coupling(plan, members, exchange, Ledger(exchange))
    coupling.outputs = {name: {"out.value": np.zeros(1)} for name in names}
    coupling.previous, coupling.sent = dict(coupling.outputs), {name: {} for name in names}
    exchange.count_rows(coupling.outputs)
    for name in names:
        numbers = [n for n, transfer in enumerate(exchange.transfers) if transfer.taker == name]
        deliveries = [exchange.deliver(n, coupling.outputs, coupling.outputs) for n in numbers]
        fields = exchange.merge(name, [(delivery, False) for delivery in deliveries]).fields
        coupling.ledger.primed(name, fields)
    return coupling


def _step(coupling, windows=1):
    for number in range(windows):
        SCHEMES[coupling.plan.scheme](coupling, Window(number, 1, 1.0, False))


def _logs(coupling):
    return [coupling.components[name].log for name in coupling.members]


def test_serial_sees_the_end_of_those_before_and_the_start_of_those_after():
    coupling = _coupling([("a", "b"), ("b", "c"), ("c", "a")], "serial")
    _step(coupling, 2)
    a, b, c = _logs(coupling)
    assert [inputs["in.value"] for inputs in a] == [(0.0, False), (3.0, False)]
    assert [inputs["in.value"] for inputs in b] == [(1.0, True), (11.0, True)]
    assert [inputs["in.value"] for inputs in c] == [(2.0, True), (12.0, True)]


def test_parallel_sees_the_start_of_all():
    coupling = _coupling([("a", "b"), ("b", "c"), ("c", "a")], "parallel")
    _step(coupling, 2)
    a, b, c = _logs(coupling)
    assert [inputs["in.value"] for inputs in a] == [(0.0, False), (3.0, False)]
    assert [inputs["in.value"] for inputs in b] == [(0.0, False), (1.0, False)]
    assert [inputs["in.value"] for inputs in c] == [(0.0, False), (2.0, False)]


def test_iterated_sees_the_end_of_all():
    coupling = _coupling([("a", "b"), ("b", "c"), ("c", "a")], "iterated")
    _step(coupling)
    last_inputs = [log[-1]["in.value"] for log in _logs(coupling)]
    assert last_inputs == [(3.0, True), (1.0, True), (2.0, True)]
    # The guess was zero, the first step went half the way, and Aitken's factor gave the rest.
    assert coupling.costs.repetitions == 2


def test_serial_refuses_motion_from_before_and_from_after():
    mixed = [("a", "b"), ("c", "b")]
    serial = _coupling(mixed, "serial")
    (mistake,) = plan.mistakes(serial.plan, serial.exchange)
    assert "the inputs of b.in must all come from components that step before it" in mistake
    assert "Change the order, or use scheme parallel" in mistake
    for scheme in ("parallel", "iterated"):
        coupling = _coupling(mixed, scheme)
        assert plan.mistakes(coupling.plan, coupling.exchange) == []
        _step(coupling)


def test_agreement_is_asked_for_relative_to_the_largest_value_so_far():
    measure = ConvergenceMeasure(IterationSettings().tolerance, {}, _is_no_impulse)
    big, tiny = {KEY: np.array([1.0])}, {KEY: np.array([1e-14])}
    assert not _agrees(measure, {KEY: np.array([1e-3])}, big)
    assert _agrees(measure, {KEY: np.array([1e-7])}, big)
    assert _agrees(measure, {KEY: np.array([1e-12])}, tiny)  # rounding of what was 1
    assert _agrees(measure, {KEY: np.zeros(1)}, {KEY: np.zeros(1)})


def test_what_a_trial_that_failed_had_repeated_is_forgotten():
    coupling = _coupling([("a", "b"), ("b", "c"), ("c", "a")], "iterated")
    state, outputs = coupling.save(), dict(coupling.outputs)
    coupling.iterate = {name: {"out.value": np.full(1, 7.0)} for name in "abc"}
    coupling.load(state)
    assert coupling.outputs == outputs
    assert coupling.iterate == {}
