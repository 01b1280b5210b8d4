"""The ledger's sums, one by one."""

import csv
from itertools import pairwise

import numpy as np
import pytest

from quintet.coupler.coupling.energy_balance import EnergyBalance
from quintet.coupler.coupling.exchange import Exchange
from quintet.coupler.coupling.ledger import Account, Ledger
from quintet.coupler.coupling.links import maker
from quintet.coupler.coupling.motion_audit import MotionAudit
from quintet.interfaces.component import Port
from quintet.interfaces.ports import FORCE, POSITION, VELOCITY
from quintet.interfaces.serving.inputs import Inputs
from quintet.interfaces.serving.outputs import InputAudit

MOVED = Port("moved", (POSITION, VELOCITY))
PUSHED = Port("pushed", (FORCE,))
PORTS = {"a": ((PUSHED,), (MOVED,)), "b": ((MOVED,), (PUSHED,))}


def _exchange():
    pairs = [["a.moved", "b.moved"], ["b.pushed", "a.pushed"]]
    return Exchange([maker("direct")(0, {"name": "rope", "pairs": pairs}, PORTS)], PORTS)


def test_a_difference_is_booked_under_its_unit_and_the_worst_one_stays():
    account = Account("rope")
    account.note("N", np.array([0.0, -2e-3, 1e-3]), 10.0)
    account.note("N", np.array([1e-5]), 10.0)
    account.note("W", np.array([1.0]), 4.0)
    account.note("N m", np.zeros(3), 0.0)
    assert (account.momentum_residual, account.heat_residual) == (2e-4, 0.25)
    assert (account.angular_residual, account.kinematic_residual) == (0.0, 0.0)
    account.note("N", np.ones(3), 0.0)  # something from nothing
    assert account.momentum_residual == np.inf


def test_all_that_was_given_is_applied_or_on_its_way():
    ledger = Ledger(_exchange())
    back = 1  # number of the transfer that brings the force
    late = {back}
    force = np.array([[1.0, 2.0, 3.0], [-4.0, 0.0, 1.0]])
    sums = {"pushed.force": force.sum(axis=0).tolist()}
    header = {"sent": {**sums, "pushed.force/size": [np.abs(force).sum()]}}
    fields = {"pushed.force": force}
    ledger.book_given("b", header, fields)
    ledger.given_for(back, fields)
    ledger.close_window(late, {})
    assert ledger.worst == 0.0
    ledger.book_given("b", header, fields)
    ledger.given_for(back, fields)
    ledger.applied("a", fields, {"received": sums, "applied": sums})
    ledger.close_window(late, {})
    assert ledger.worst == 0.0
    in_transit = {("a", "pushed.force"): force}
    ledger.close_window((), in_transit)
    assert ledger.worst == 0.0
    ledger.close_window((), {})
    assert ledger.worst == pytest.approx(4.0 / 22.0)


def test_a_hermite_path_is_found_anew_from_its_sums():
    """What the serving loop hands out of a cubic path is what the ledger works out for itself."""
    random, window = np.random.default_rng(1), 0.7
    inputs = Inputs([MOVED])
    handed = InputAudit(["moved.position"], {"moved.position": "moved.velocity"})
    motion = MotionAudit(_exchange())
    for number in range(4):
        fields = {f"moved.{key}": random.normal(size=(5, 3)) for key in ("position", "velocity")}
        ends = list(fields) if number else []
        inputs.arrive(fields, ends, window)
        motion.arrive("b", fields, ends, window)
        handed.begin()
        marks = np.linspace(0.0, window, 8)
        for begin, end in pairwise(marks):
            handed.add(inputs.over(begin, end, window), end - begin)
        assert motion.residual("b", handed.audit()) < 1e-14
        wrong = handed.audit()
        wrong["first"] = {key: np.add(v, 1e-6) for key, v in wrong["first"].items()}
        assert motion.residual("b", wrong) > 1e-9


def test_mean_rates_are_those_of_the_displacement_where_it_is_known():
    x, v = "moved.position", "moved.velocity"
    before = {x: np.zeros((1, 3)), v: np.ones((1, 3))}
    after = {x: np.full((1, 3), 4.0), v: np.full((1, 3), 5.0)}
    ledger = Ledger(_exchange())
    for place, mean in ((x, 2.0), ("", 3.0), ("integral", 2.5)):
        found = ledger._mean_rate("a", before, after, (v, place), 2.0)
        np.testing.assert_array_equal(found, mean)


def test_work_that_only_one_side_counts_is_no_residual():
    pairs = [["a.moved", "b.moved"]]
    ports = {"a": ((), (MOVED,)), "b": ((MOVED,), (PUSHED,))}
    exchange = Exchange([maker("direct")(0, {"name": "rope", "pairs": pairs}, ports)], ports)
    exchange.works_of[0] = {"b": [("pushed.force", "moved.velocity", "")]}
    ledger = Ledger(exchange)
    fields = {"pushed.force": np.ones((1, 3))}
    ledger.book_given("b", {"sent": {"pushed.force/work": [3.0]}}, fields)
    account = ledger.accounts["rope"]
    assert account.work_given == 3.0
    assert account.energy_residual == 0.0


def test_every_note_writes_a_row_for_each_link_and_component(tmp_path):
    ledger = Ledger(_exchange(), tmp_path / "ledger.csv")
    one = {"mass": 1.0, "momentum": [0.0] * 3, "kinetic": 2.0, "potential": 0.0, "internal": 1.0}
    one["work"] = 0.0
    for time, kinetic in ((0.0, 2.0), (0.5, 1.0), (1.0, 2.5)):
        ledger.note(time, {"a": {**one, "kinetic": kinetic}, "b": one})
    ledger.close()
    with open(tmp_path / "ledger.csv", newline="") as file:
        rows = list(csv.reader(file))
    assert len(rows) == 1 + 3 * 3
    assert {len(row) for row in rows if row[1] in ("a", "b")} == {len(rows[0])}
    assert ledger.summary()["energy_drift"] == pytest.approx(0.5 / 1.5)
    change = ledger.summary()["energy_change"]
    assert change == pytest.approx({"gained": 0.5, "lost": 0.0, "turned_over": 1.5, "times": 3})
    assert ledger.summary()["mass_drift"]["a"] == {"kg": 0.0, "relative": 0.0}


def _totals(kinetic, potential, work=0.0, mass=0.0):
    energies = {"kinetic": kinetic, "potential": potential, "internal": 0.0}
    return {"a": {**energies, "work": work, "mass": mass}}


def test_what_is_done_from_outside_is_no_rise_of_energy():
    balance = EnergyBalance()
    for kinetic, work in ((0.0, 0.0), (2.0, 2.0), (4.0, 3.9), (1.0, 0.9)):
        balance.note(_totals(kinetic, 0.0, work))
    assert balance.drift() == pytest.approx(0.1 / 4.0)


@pytest.mark.parametrize(
    ("energies", "drift"),
    [
        # A body that falls turns its potential energy into motion; what rises is the error alone.
        ([(0.0, 5.0), (3.0, 2.0), (4.9, 0.10005)], 5e-5 / 4.9),
        ([(0.0, 5.0), (3.0, 1.0), (0.0, 0.5)], 0.0),
        # At rest but for rounding, nothing is turned over that a rise could be told against.
        ([(0.0, 26.5), (0.0, 26.500000004)], None),
        ([(0.0, 0.0), (0.0, 0.0)], None),
    ],
)
def test_a_rise_of_energy_is_told_against_the_largest_that_was_turned_over(energies, drift):
    balance = EnergyBalance()
    for kinetic, potential in energies:
        balance.note(_totals(kinetic, potential))
    kept = EnergyBalance()
    kept.load(balance.save())
    for one in (balance, kept):
        assert one.drift() == (None if drift is None else pytest.approx(drift, rel=1e-6))


def test_the_energy_that_is_lost_at_the_end_is_told_beside_the_largest_rise():
    balance = EnergyBalance()
    for kinetic in (10.0, 10.3, 5.0, 9.4):
        balance.note(_totals(kinetic, 0.0))
    kept = EnergyBalance()
    kept.load(balance.save())
    for one in (balance, kept):
        change = {"gained": 0.3, "lost": 0.6, "turned_over": 5.3, "times": 4}
        assert one.change() == pytest.approx(change)
    kept.note(_totals(10.0, 0.0))
    assert kept.change()["lost"] == 0.0, "it is what is missing at the end"


def test_a_change_of_mass_is_told_over_the_mass_at_the_start():
    balance = EnergyBalance()
    for mass in (200.0, 150.0, 198.0):
        balance.note(_totals(1.0, 0.0, mass=mass))
    kept = EnergyBalance()
    kept.load(balance.save())
    for one in (balance, kept):
        assert one.mass_drift() == {"a": {"kg": -2.0, "relative": -0.01}}


def test_a_mass_that_was_none_at_the_start_has_no_relative_change_and_none_is_left_out():
    filled, without = EnergyBalance(), EnergyBalance()
    for mass in (0.0, 3.0):
        filled.note(_totals(1.0, 0.0, mass=mass))
        without.note(_totals(1.0, 0.0))
    assert filled.mass_drift() == {"a": {"kg": 3.0, "relative": None}}
    assert without.mass_drift() == {}
