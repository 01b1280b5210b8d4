"""The ledger's sums, one by one."""

import csv
import json
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


def test_a_difference_that_is_no_number_is_the_worst():
    account = Account("rope")
    account.note("N", [0.0, float("nan"), 0.0], 1.0)
    assert account.momentum_residual == float("inf")


def test_all_that_was_given_is_applied_or_on_its_way():
    ledger = Ledger(_exchange())
    transfer = 1  # number of the transfer that brings the force
    late_transfers = {transfer}
    force = np.array([[1.0, 2.0, 3.0], [-4.0, 0.0, 1.0]])
    sums = {"pushed.force": force.sum(axis=0).tolist()}
    header = {"sent": {**sums, "pushed.force/size": [np.abs(force).sum()]}}
    fields = {"pushed.force": force}
    ledger.book_given("b", header, fields)
    ledger.given_for(transfer, fields)
    ledger.close_window(late_transfers, {})
    assert ledger.worst == 0.0
    ledger.book_given("b", header, fields)
    ledger.given_for(transfer, fields)
    ledger.applied("a", fields, {"received": sums, "applied": sums})
    ledger.close_window(late_transfers, {})
    assert ledger.worst == 0.0
    in_transit = {("a", "pushed.force"): force}
    ledger.close_window((), in_transit)
    assert ledger.worst == 0.0
    ledger.close_window((), {})
    assert ledger.worst == pytest.approx(4.0 / 22.0)


def test_a_hermite_path_is_found_anew_from_its_sums():
    """The serving loop and the ledger compute the same sums of a cubic path."""
    random, window = np.random.default_rng(1), 0.7
    inputs = Inputs([MOVED])
    audit = InputAudit(["moved.position"], {"moved.position": "moved.velocity"})
    motion = MotionAudit(_exchange())
    for number in range(4):
        fields = {f"moved.{key}": random.normal(size=(5, 3)) for key in ("position", "velocity")}
        ends = list(fields) if number else []
        inputs.arrive(fields, ends, window)
        motion.arrive("b", fields, ends, window)
        audit.begin()
        marks = np.linspace(0.0, window, 8)
        for begin, end in pairwise(marks):
            audit.add(inputs.over(begin, end, window), end - begin)
        assert motion.residual("b", audit.audit()) < 1e-14
        wrong_audit = audit.audit()
        wrong_audit["first"] = {key: np.add(v, 1e-6) for key, v in wrong_audit["first"].items()}
        assert motion.residual("b", wrong_audit) > 1e-9


def test_mean_rates_are_those_of_the_displacement_where_it_is_known():
    x, v = "moved.position", "moved.velocity"
    start = {x: np.zeros((1, 3)), v: np.ones((1, 3))}
    end = {x: np.full((1, 3), 4.0), v: np.full((1, 3), 5.0)}
    ledger = Ledger(_exchange())
    for place, mean in ((x, 2.0), ("", 3.0), ("integral", 2.5)):
        rate = ledger._mean_rate("a", start, end, (v, place), 2.0)
        np.testing.assert_array_equal(rate, mean)


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
    works = [ledger.energy.brought(name) for name in ("b", "a")]
    assert works == [(-3.0, 0.0), (3.0, 0.0)], "the other side got what this one gave"


def test_every_note_writes_a_row_for_each_link_and_component(tmp_path):
    ledger = Ledger(_exchange(), tmp_path / "ledger.csv")
    totals = {"mass": 1.0, "momentum": [0.0] * 3, "kinetic": 2.0, "potential": 0.0, "internal": 1.0}
    totals["work"] = 0.0
    for time, kinetic in ((0.0, 2.0), (0.5, 1.0), (1.0, 2.5)):
        ledger.note(time, {"a": {**totals, "kinetic": kinetic}, "b": totals})
    ledger.close()
    with open(tmp_path / "ledger.csv", newline="") as file:
        rows = list(csv.reader(file))
    assert len(rows) == 1 + 3 * 3
    assert {len(row) for row in rows} == {len(rows[0])}
    balance = ledger.summary()["energy_balance"]
    assert (balance["scale"], balance["times"]) == (1.5, 3)
    assert balance["run"]["gained"] == balance["run"]["change"] == 0.5
    assert ledger.summary()["mass_drift"]["a"] == {"kg": 0.0, "relative": 0.0}


def test_a_mass_balance_that_a_component_keeps_is_told_and_saved(tmp_path):
    ledger, restored = (Ledger(_exchange(), tmp_path / f"{name}.csv") for name in ("one", "other"))
    sums = {"mass": 3.0, "momentum": [0.0] * 3, "kinetic": 0.0, "potential": 0.0, "internal": 0.0}
    sums |= {"work": 0.0, "mass_balance": {"at the start": 2.0, "entered": 1.5}}
    ledger.note(0.0, {"a": sums, "b": {**sums, "mass_balance": {}}})
    restored.load(ledger.save())
    for book in (ledger, restored):
        balances = book.summary()["mass_balance"]
        assert balances.keys() == {"a"}
        assert balances["a"]["kg"] == {"at the start": 2.0, "entered": 1.5}
        assert (balances["a"]["now"], balances["a"]["residual"]) == (3.0, pytest.approx(0.5 / 3.5))
        book.close()


def _totals(kinetic, potential=0.0, work=0.0, mass=0.0, **terms):
    energies = {"kinetic": kinetic, "potential": potential, "internal": 0.0}
    return {"a": {**energies, "work": work, "mass": mass, **terms}}


def _restored(balance):
    """The balance, and its copy from a snapshot."""
    restored = EnergyBalance()
    restored.load(json.loads(json.dumps(balance.save())))
    return balance, restored


def _close(part):
    """Whether the parts of a balance add up to the change."""
    inflow = part["outside"] + part["links"] + part["heat"]
    outflow = part["lost"] - (part["unexplained"] or 0.0)
    assert part["change"] == pytest.approx(inflow - outflow, abs=1e-12)


def test_what_is_done_from_outside_is_no_rise_of_energy():
    balance = EnergyBalance()
    for kinetic, work in ((0.0, 0.0), (2.0, 2.0), (4.0, 3.9), (1.0, 0.9)):
        balance.note(_totals(kinetic, work=work, dissipated=0.0))
    summary = balance.summary()
    part = summary["components"]["a"]
    assert (summary["scale"], part["gained"]) == (4.0, pytest.approx(0.1))
    assert (part["outside"], part["unexplained"]) == pytest.approx((0.9, 0.1))
    _close(part)


@pytest.mark.parametrize(
    ("energies", "gained"),
    [
        # A falling body turns its potential energy into motion; only the error rises.
        ([(0.0, 5.0), (3.0, 2.0), (4.9, 0.10005)], 5e-5),
        ([(0.0, 5.0), (3.0, 1.0), (0.0, 0.5)], 0.0),
        # At rest except for rounding, no energy is converted to which a rise could be compared.
        ([(0.0, 26.5), (0.0, 26.500000004)], None),
        ([(0.0, 0.0), (0.0, 0.0)], None),
    ],
)
def test_a_rise_of_energy_is_told_where_more_than_rounding_was_turned_over(energies, gained):
    balance = EnergyBalance()
    for kinetic, potential in energies:
        balance.note(_totals(kinetic, potential))
    for energy_balance in _restored(balance):
        summary = energy_balance.summary()
        if gained is None:
            assert summary is None
        else:
            assert summary["run"]["gained"] == pytest.approx(gained, rel=1e-6)


def test_what_is_missing_at_the_end_is_lost_where_a_component_reports_no_dissipation():
    balance = EnergyBalance()
    for kinetic in (10.0, 10.3, 5.0, 9.4):
        balance.note(_totals(kinetic))
    for energy_balance in _restored(balance):
        part = energy_balance.summary()["components"]["a"]
        assert (part["lost"], part["gained"]) == pytest.approx((0.6, 0.3))
        assert part["unexplained"] is None, "all of it may be dissipated"
        _close(part)
        energy_balance.note(_totals(10.2))
        part = energy_balance.summary()["components"]["a"]
        assert (part["lost"], part["unexplained"]) == pytest.approx((0.0, 0.2))


def test_what_a_component_reports_as_dissipated_is_not_unexplained():
    balance = EnergyBalance()
    balance.note(_totals(10.0, dissipated=1.0))
    balance.note(_totals(8.0, dissipated=2.5))
    part = balance.summary()["components"]["a"]
    assert (part["lost"], part["unexplained"]) == pytest.approx((1.5, -0.5))
    _close(part)


def test_a_steady_flow_of_heat_closes_and_is_told_against_the_heat_that_flowed():
    """One part stores nothing: its heat flows on to the other part, and from there to a bath."""
    balance = EnergyBalance()
    still = {"kinetic": 0.0, "potential": 0.0, "internal": 0.0, "mass": 0.0, "dissipated": 0.0}
    for heat in (0.0, 50.0, 100.0):
        if heat:
            balance.add_heat("wall", "a", -50.0)
            balance.add_heat("wall", "b", 50.0)
        stored = 7.0 + 0.02 * heat
        lattice = {**still, "internal": stored, "work": -0.98 * heat}
        balance.note({"a": {**still, "work": heat}, "b": lattice})
    summary = balance.summary()
    assert summary["scale"] == 100.0, "and not the 2 J that are stored"
    assert summary["run"]["unexplained"] == pytest.approx(0.0, abs=1e-12)
    assert summary["components"]["b"]["heat"] == 100.0
    for part in (summary["run"], *summary["components"].values()):
        _close(part)


def test_work_that_the_sides_of_a_link_count_differently_is_made_by_the_coupling():
    balance = EnergyBalance()
    rest = {"potential": 0.0, "internal": 0.0, "work": 0.0, "mass": 0.0, "dissipated": 0.0}
    balance.note({"a": {**rest, "kinetic": 10.0}, "b": {**rest, "kinetic": 0.0}})
    balance.add_work("rope", "a", -4.0)
    balance.add_work("rope", "b", 4.5)
    balance.note({"a": {**rest, "kinetic": 6.0}, "b": {**rest, "kinetic": 4.5}})
    for energy_balance in _restored(balance):
        run = energy_balance.summary()["run"]
        assert (run["coupling"], run["unexplained"], run["gained"], run["links"]) == (
            0.5, 0.5, 0.5, 0.0
        )  # fmt: skip
        _close(run)
        parts = energy_balance.summary()["components"]
        assert [part["unexplained"] for part in parts.values()] == [0.0, 0.0]


def test_a_component_that_reports_no_energy_is_left_out_and_its_links_bring_work_to_the_run():
    balance = EnergyBalance()
    rest = {"potential": 0.0, "internal": 0.0, "work": 0.0, "mass": 0.0, "dissipated": 0.0}
    silent = {**rest, "kinetic": 0.0}
    balance.note({"a": {**rest, "kinetic": 10.0}, "motor": silent})
    balance.add_work("rope", "a", 4.0)
    balance.add_work("rope", "motor", -4.0)
    balance.note({"a": {**rest, "kinetic": 14.0}, "motor": silent})
    summary = balance.summary()
    assert list(summary["components"]) == ["a"]
    assert (summary["run"]["links"], summary["run"]["coupling"]) == (4.0, 0.0)
    assert summary["run"]["unexplained"] == 0.0


def test_a_change_of_mass_is_told_over_the_mass_at_the_start():
    balance = EnergyBalance()
    for mass in (200.0, 150.0, 198.0):
        balance.note(_totals(1.0, 0.0, mass=mass))
    restored = EnergyBalance()
    restored.load(balance.save())
    for energy_balance in (balance, restored):
        assert energy_balance.mass_drift() == {"a": {"kg": -2.0, "relative": -0.01}}


def test_a_mass_that_was_none_at_the_start_has_no_relative_change_and_none_is_left_out():
    filled, without = EnergyBalance(), EnergyBalance()
    for mass in (0.0, 3.0):
        filled.note(_totals(1.0, 0.0, mass=mass))
        without.note(_totals(1.0, 0.0))
    assert filled.mass_drift() == {"a": {"kg": 3.0, "relative": None}}
    assert without.mass_drift() == {}
