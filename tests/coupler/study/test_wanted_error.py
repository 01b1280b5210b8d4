"""The setting for a wanted error: the cheapest that delivers it, or an extrapolated one."""

import pytest

from quintet.coupler.scene.study_table import Refinement
from quintet.coupler.study.conclusion import conclude
from quintet.coupler.study.wanted_error import choose, extrapolated_settings

LADDER = (0.4, 0.2, 0.1)


def row(h, value, cpu=None, reference=1.0, scale=1.0, **keys):
    """A run of spacing h, with one expectation."""
    error = abs(value - reference)
    return {
        "label": f"{h} m", "settings": {"spacing": h}, "kind": "spacing", "size": h,
        "sizes": {"spacing": h}, "ladders": ["spacing"], "status": "done", "met": True,
        "errors": {"end": error}, "relative": {"end": error / scale if scale else None},
        "scales": {"end": scale}, "values": {"end": value}, "references": {"end": reference},
        "within": {"end": 1.0}, "units": {"end": "m"}, "required": ["end"],
        "wall": 1.0, "cpu": h**-3 if cpu is None else cpu,
    } | keys  # fmt: skip


def choice_of(wanted_error, rows):
    refinements = [
        Refinement(row["label"], row["settings"], varied={"spacing": row["size"], "name": "x"})
        for row in rows
    ]
    return choose(wanted_error, conclude("study", rows), refinements)


def test_the_cheapest_that_delivers_is_recommended_and_none_that_is_cheaper_delivers():
    rows = [row(h, 1.0 + h**2) for h in LADDER]  # errors of 16, 4 and 1 %
    for wanted_error, label in (
        (0.2, "0.4 m"),
        (0.05, "0.2 m"),
        (0.04 + 1e-12, "0.2 m"),
        (0.02, "0.1 m"),
    ):
        choice = choice_of(wanted_error, rows)
        assert choice["measured"]["label"] == label and "extrapolated" not in choice
        assert choice["measured"]["relative"] <= wanted_error
        cheaper = [run for run in rows if run["cpu"] < choice["measured"]["cpu"]]
        assert all(run["relative"]["end"] > wanted_error for run in cheaper)


def test_the_cheapest_need_not_be_the_coarsest():
    rows = [row(0.4, 1.01, cpu=9.0), row(0.2, 1.02, cpu=3.0), row(0.1, 1.03, cpu=5.0)]
    assert choice_of(0.05, rows)["measured"]["label"] == "0.2 m"


def test_every_required_expectation_must_be_within_the_wanted_error():
    rows = [row(h, 1.0 + h**2) for h in LADDER]
    for run, second in zip(rows, (0.3, 0.03, 0.2), strict=True):
        run["required"].append("second")
        for key, value in {"errors": second, "relative": second, "scales": 1.0,
                           "values": second, "references": 0.0}.items():  # fmt: skip
            run[key]["second"] = value
    assert choice_of(0.05, rows)["measured"]["label"] == "0.2 m"
    rows[1]["relative"]["second"] = None  # it was not reached
    assert "measured" not in choice_of(0.05, rows)


def test_where_none_delivers_the_setting_is_extrapolated_with_its_cost():
    choice = choice_of(0.001, [row(h, 1.0 + h**2) for h in LADDER])
    assert "measured" not in choice
    offer = choice["extrapolated"]
    assert offer["kind"] == "spacing" and offer["from"] == "0.1 m"
    size = offer["size"]
    assert 0.02 < size <= 0.001**0.5 and offer["settings"] == {"spacing": size, "name": "x"}
    assert offer["relative"] == pytest.approx(size**2, rel=1e-3)
    assert offer["cpu"] == pytest.approx(size**-3, rel=1e-3)


def test_two_refinements_of_the_finest_size_are_extrapolated_from_a_coarser_one():
    rows = [row(h, 1.0 + h**2) for h in LADDER]
    rows.append(row(0.1, 1.0 + 0.1**2) | {"label": "0.1 m, in double precision"})
    offer = choice_of(0.001, rows)["extrapolated"]
    assert offer["relative"] <= 0.001 and offer["settings"]["spacing"] == offer["size"]
    reason = choice_of(0.001, rows[2:])["reason"]
    assert reason == "spacing: fewer than two sizes have an error"


def test_what_is_not_done_has_no_error():
    failed = row(0.1, 1.0) | {"status": "failed", "errors": {}, "required": [], "scales": {}}
    assert choice_of(0.05, [failed])["reason"] == "no refinement is done and has an error"


def test_what_no_refinement_of_this_kind_reduces_is_said():
    choice = choice_of(0.02, [row(h, 1.05 + h**2) for h in LADDER])  # settles 5 % off
    assert "extrapolated" not in choice and "measured" not in choice
    assert "end would still be 5" in choice["reason"]


def test_errors_without_a_scale_are_left_out():
    rows = [row(h, h**2, reference=0.0, scale=None) for h in LADDER]
    choice = choice_of(0.05, rows)
    assert choice["left_out"] == ["end"] and choice["judged"] == []
    assert choice["reason"] == "no required expectation has a relative error"


def test_settings_go_on_as_powers_of_the_size():
    coarse = {"spacing": 0.2, "window": 2e-3, "alpha": 0.05, "elements": [4, 2, 1], "a": True}
    fine = {"spacing": 0.1, "window": 1e-3, "alpha": 0.1, "elements": [8, 4, 1], "a": True}
    assert extrapolated_settings(coarse, fine, 1.0) == {
        "spacing": 0.05, "window": 5e-4, "alpha": 0.2, "elements": [16, 8, 1], "a": True,
    }  # fmt: skip
    boxes = [{"highest": [h, 1.0]} for h in (0.2, 0.1)]
    settings = extrapolated_settings({"fluid": [boxes[0]]}, {"fluid": [boxes[1]]}, 2.0)
    assert settings == {"fluid": [{"highest": [0.025, 1.0]}]}


@pytest.mark.parametrize(
    "coarse, fine", [("a", "b"), (0.0, 1.0), (-1.0, 1.0), ([1.0], [1.0, 2.0]), (None, 1.0)]
)
def test_settings_that_have_no_rule_are_not_extrapolated(coarse, fine):
    message = extrapolated_settings({"x": coarse}, {"x": fine}, 1.0)
    assert message == "x cannot be continued from its last two values"
    message = extrapolated_settings({"expect.0.value": 2.0}, {"expect.0.value": 1.0}, 1.0)
    assert message == "expect.0.value cannot be continued from its last two values"
