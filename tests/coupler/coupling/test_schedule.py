"""Schemes: who sees what of whom, and how a repeated window comes to agreement."""

import numpy as np
import pytest

from quintet.coupler.coupling.exchange import Exchange
from quintet.coupler.coupling.ledger import Ledger
from quintet.coupler.coupling.links import KINDS
from quintet.coupler.coupling.schedule import SCHEMES, Aitken, Coupling, Iteration
from quintet.interfaces.component import Field, Port
from quintet.interfaces.errors import LinkError
from quintet.interfaces.lines.message import Message

KEY = ("first", "in.value")
PLACE = Field("value", (), "m")


def _solve(slope, settings, start=0.0, limit=60):
    """Steps that the relaxed iteration of x = slope x + 1 takes to 1e-10."""
    aitken, x = Aitken(settings), np.array([start])
    for step in range(limit):
        gap = slope * x + 1.0 - x
        if abs(gap[0]) < 1e-10:
            return step
        x = aitken.next({KEY: x}, {KEY: gap})[KEY]
    return None


@pytest.mark.parametrize("slope", [-3.0, -0.9, 0.5, 0.99])
def test_aitken_solves_one_linear_unknown_in_two_steps(slope):
    assert _solve(slope, Iteration()) == 2


def test_constant_relaxation_converges_if_it_is_small_enough():
    assert _solve(-3.0, Iteration(relaxation=0.25, aitken=False)) == 1  # just right
    assert _solve(-3.0, Iteration(relaxation=0.1, aitken=False)) > 20
    assert _solve(-3.0, Iteration(relaxation=0.6, aitken=False)) is None


def test_aitken_survives_a_residual_that_does_not_change():
    aitken = Aitken(Iteration())
    for _ in range(3):
        guess = aitken.next({KEY: np.zeros(2)}, {KEY: np.ones(2)})
    assert np.isfinite(guess[KEY]).all()


def test_what_is_nothing_but_rounding_need_not_agree():
    force, torque = ("cube", "load.force"), ("cube", "load.torque")
    found = {force: np.array([0.07]), torque: np.array([2e-18])}
    exchange = Exchange([], {})
    coupling = Coupling({}, exchange, Ledger(exchange), 1.0, Iteration())
    assert coupling.agree({force: np.array([1e-9]), torque: np.array([1e-18])}, found)
    assert not coupling.agree({force: np.array([1e-6]), torque: np.array([1e-18])}, found)
    found[torque] = np.array([2e-4])
    assert not coupling.agree({force: np.array([1e-9]), torque: np.array([1e-6])}, found)


class _Stub:
    """A part that gives its window's number plus what it was sent; nothing runs."""

    def __init__(self, name, answers):
        self.name, self.answers, self.log = name, answers, []

    def start(self, window, dt, fields, ends, totals):
        self.log.append({key: (float(v[0]), key in ends) for key, v in fields.items()})
        self.window = window

    def finish(self):
        header = {"sent": {}, "received": {}, "applied": {}}
        header["handed"] = {"first": {}, "moved": {}, "span": 1.0}
        return Message(header, {"out.value": np.array([self.answers[self.window]])})

    def tell(self, order):
        pass

    def hear(self):
        pass


def _coupling(pairs, names="abc"):
    port_in, port_out = Port("in", (PLACE,)), Port("out", (PLACE,))
    partner = Port("in", (PLACE,), items="partner")
    ports = {name: ((partner if name == "b" else port_in,), (port_out,)) for name in names}
    links = [
        KINDS["direct"](n, {"name": str(n), "pairs": [[f"{a}.out", f"{b}.in"]]}, ports)
        for n, (a, b) in enumerate(pairs)
    ]
    exchange = Exchange(links, ports)
    parts = {name: _Stub(name, [1.0 + n, 11.0 + n]) for n, name in enumerate(names)}
    coupling = Coupling(parts, exchange, Ledger(exchange), 1.0)
    coupling.outputs = {name: {"out.value": np.zeros(1)} for name in names}
    for name in names:
        coupling.ledger.primed(name, exchange.inputs(name, coupling.outputs, ()).fields)
    return coupling


def test_serial_sees_the_end_of_those_before_and_the_start_of_those_after():
    coupling = _coupling([("a", "b"), ("b", "c"), ("c", "a")])
    for window in range(2):
        SCHEMES["serial"](coupling, window, False)
    a, b, c = (coupling.parts[name].log for name in "abc")
    assert [one["in.value"] for one in a] == [(0.0, False), (3.0, False)]
    assert [one["in.value"] for one in b] == [(1.0, True), (11.0, True)]
    assert [one["in.value"] for one in c] == [(2.0, True), (12.0, True)]


def test_parallel_sees_the_start_of_all():
    coupling = _coupling([("a", "b"), ("b", "c"), ("c", "a")])
    for window in range(2):
        SCHEMES["parallel"](coupling, window, False)
    a, b, c = (coupling.parts[name].log for name in "abc")
    assert [one["in.value"] for one in a] == [(0.0, False), (3.0, False)]
    assert [one["in.value"] for one in b] == [(0.0, False), (1.0, False)]
    assert [one["in.value"] for one in c] == [(0.0, False), (2.0, False)]


def test_iterated_sees_the_end_of_all():
    coupling = _coupling([("a", "b"), ("b", "c"), ("c", "a")])
    SCHEMES["iterated"](coupling, 0, False)
    last = [coupling.parts[name].log[-1]["in.value"] for name in "abc"]
    assert last == [(3.0, True), (1.0, True), (2.0, True)]
    # It guessed nought, went half the way, and found by Aitken's factor what was lacking.
    assert coupling.repetitions == 2


def test_serial_refuses_motion_from_before_and_from_after():
    mixed = [("a", "b"), ("c", "b")]
    with pytest.raises(LinkError, match=r"Change scene.order, or use scheme parallel"):
        SCHEMES["serial"](_coupling(mixed), 0, False)
    SCHEMES["parallel"](_coupling(mixed), 0, False)
    SCHEMES["iterated"](_coupling(mixed), 0, False)


def test_agreement_is_asked_for_relative_to_the_largest_value_so_far():
    coupling = _coupling([("a", "b")])
    big, tiny = {KEY: np.array([1.0])}, {KEY: np.array([1e-14])}
    assert not coupling.agree({KEY: np.array([1e-3])}, big)
    assert coupling.agree({KEY: np.array([1e-7])}, big)
    assert coupling.agree({KEY: np.array([1e-12])}, tiny)  # rounding of what was 1
    assert coupling.agree({KEY: np.zeros(1)}, {KEY: np.zeros(1)})
