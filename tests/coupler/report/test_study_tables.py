"""The table of a study has one quantity in each line."""

from quintet.coupler.report.study_tables import costs_and_errors

COSTS = dict.fromkeys(("cpu", "wall", "exchange", "mapping", "overhead", "memory", "energy"))


def _row(label, kind, size, unit):
    of_one = {"errors": {"x": 0.25}, "relative": {"x": 0.5}, "units": {"x": unit}}
    judged = {"status": "done", "met": True, "items": 1, "components": {}}
    return {"label": label, "kind": kind, "size": size, **of_one, **judged, **COSTS}


def _columns(*rows):
    return [list(column.cells) for column in costs_and_errors(rows).columns]


def test_sizes_of_different_kinds_have_a_line_each():
    names, coarse, fine = _columns(
        _row("a", "spacing", 0.02, "m"), _row("b", "coupling", 0.001, "m")
    )
    assert "size" not in names
    place = names.index("size of the spacing")
    assert (coarse[place], fine[place]) == ("0.02", "-")
    place = names.index("size of the coupling")
    assert (coarse[place], fine[place]) == ("-", "0.001")


def test_sizes_of_one_kind_are_one_line():
    rows = _row("a", "spacing", 0.02, "m"), _row("b", "spacing", 0.01, "m")
    names, coarse, fine = _columns(*rows)
    place = names.index("size")
    assert (coarse[place], fine[place]) == ("0.02", "0.01")


def test_errors_in_different_units_have_a_line_each():
    names, coarse, fine = _columns(_row("a", "spacing", 0.02, "m"), _row("b", "spacing", 0.01, "s"))
    for name, cells in (("error of x [m]", ("0.25", "-")), ("error of x [s]", ("-", "0.25"))):
        place = names.index(name)
        assert (coarse[place], fine[place]) == cells
