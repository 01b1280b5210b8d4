"""Unstable couplings are reported with a remedy; stable ones are not."""

import laboratory
import pytest

from quintet.coupler.coupling.judgement.stability_watch import FEWEST, LinkWork, StabilityWatch
from quintet.coupler.coupling.link import Demands
from quintet.coupler.coupling.links.direct import Direct

LINK = {
    "kind": "direct",
    "pairs": [["swing.swing", "burden.carried"], ["burden.lump", "swing.lump"]],
}


def swing(folder, burden, scheme, window=0.01, step=None, **settings):
    """A mass on a spring carries a second one; staggered schemes fail if the second is heavier."""
    components = {
        "swing": {"kind": "toy_points:Swing", "dt": window},
        "burden": {"kind": "toy_points:Burden", "mass": burden, "dt": step or window},
    }
    path = laboratory.scene(
        folder, components, LINK, end=2.0, window=window, scheme=scheme, **settings
    )
    return laboratory.couple(path)


def instabilities(trace):
    """Warnings of unstable links, without those of windows that are too long."""
    return [text for text in trace.warnings if "its coupling is unstable" in text]


@pytest.mark.parametrize("scheme", ["serial", "parallel"])
def test_a_burden_too_heavy_for_staggered_windows_is_told_once_and_iterated_ones_hold_it(
    tmp_path, scheme
):
    trace = swing(tmp_path, 2.0, scheme)
    (text,) = instabilities(trace)
    assert text.startswith("warning of link swing-burden: its coupling is unstable: by t = 0.1")
    assert text.endswith('of the work that went through it; set scheme = "iterated".')
    warnings = trace.coupling.ledger.warnings.summary()
    (time,) = [warning["time"] for warning in warnings if warning["subject"] == "stability"]
    assert 0.01 * (FEWEST - 0.5) < time < 0.3, "no link is judged by a jolt at the start"
    assert instabilities(swing(tmp_path, 2.0, "iterated")) == []


@pytest.mark.parametrize("window", [0.02, 0.01, 0.005])
@pytest.mark.parametrize(
    ("burden", "scheme"), [(0.5, "serial"), (0.5, "parallel"), (2.0, "iterated")]
)
def test_a_burden_that_is_held_is_no_matter(tmp_path, burden, scheme, window):
    assert instabilities(swing(tmp_path, burden, scheme, window)) == []


def test_windows_longer_than_the_step_of_who_pushes_are_to_be_repeated_and_shortened(tmp_path):
    (text,) = instabilities(swing(tmp_path, 2.0, "serial", 0.02, step=0.006))
    assert text.endswith('; set scheme = "iterated", and shorten window from 0.02 s to 0.003 s.')
    assert instabilities(swing(tmp_path, 2.0, "iterated", 0.003, step=0.006)) == []


def test_a_link_that_cannot_be_iterated_is_to_have_shorter_windows(tmp_path, monkeypatch):
    demands = Demands(schemes=("serial", "parallel"), reason="it is a test")
    monkeypatch.setattr(Direct, "demands", lambda link: demands)
    (text,) = instabilities(swing(tmp_path, 2.0, "serial"))
    assert text.endswith("; shorten window from 0.01 s to 0.005 s.")


def test_what_was_seen_outlives_a_snapshot(tmp_path):
    trace = swing(tmp_path, 2.0, "serial")
    watch = trace.judgement.stability
    resumed = StabilityWatch(watch.unstable)
    resumed.load(watch.save())
    assert resumed.save() == watch.save() and resumed.unstable == watch.unstable


def test_no_link_is_judged_by_work_that_is_rounding_beside_the_energies_of_the_run():
    work = LinkWork(
        work_given=0.0, work_taken=7e-17, turnover=1e-16, late=7e-17, late_turnover=1e-16
    )
    assert work.is_unstable(FEWEST, 0.0)
    assert not work.is_unstable(FEWEST, 1e-9 * 20.0)  # J
