"""Two recordings part where their first bit differs."""

from dataclasses import replace

import numpy as np
import pytest

from quintet.coupler.cli import main
from quintet.coupler.files.recording import Instant, Recorder
from quintet.coupler.report.diff import compare, only_in_one, sentence
from quintet.interfaces.ports import MOTION, SURFACE_LOAD

ROWS = 150


def _record(
    path, change=None, rows=ROWS, names=("cubes", "water"), n=4, mass=1.0, port=MOTION, ticks=()
):
    """Record two components; `change` edits the fields at a row, `ticks` its time."""
    with Recorder(path, str(path), "", 0.01) as recorder:
        for name in names:
            static = {"motion.mass": np.full(n, mass)} if name == "cubes" else {}
            recorder.component(name, (port if name == "cubes" else SURFACE_LOAD,), static)
        for k in range(rows):
            random = np.random.default_rng(k)
            fields = {
                "cubes": {f"motion.{f.name}": random.random((n, *f.shape)) for f in port.fields},
                "water": {"surface_load.force": np.random.default_rng(~k & 0xFFFF).random((6, 3))},
            }
            if change is not None:
                change(k, fields)
            for name in names:
                recorder.add(name, Instant(0.01 * k, dict(ticks).get(k, k)), fields[name])
    return path


@pytest.fixture
def original(tmp_path):
    return _record(tmp_path / "a.h5")


def test_equal_recordings_do_not_differ(tmp_path, original):
    assert compare(original, _record(tmp_path / "b.h5")) is None
    assert "the same" in sentence(None)


def test_the_first_different_bit_is_found_over_all_components(tmp_path, original):
    def change(k, fields):
        if k >= 100:
            fields["cubes"]["motion.position"][:] = 0.0
        if k == 97:  # one bit, in the last component, in the same block of rows
            force = fields["water"]["surface_load.force"]
            force[5, 1] = np.nextafter(force[5, 1], 2.0)

    difference = compare(original, _record(tmp_path / "b.h5", change))
    assert difference is not None and difference.kind == "value"
    assert (difference.component, difference.field) == ("water", "surface_load.force")
    assert (difference.window, difference.item, difference.index) == (97, 5, (1,))
    assert difference.b == np.nextafter(difference.a, 2.0)
    assert "window 97 (t = 0.97 s): water.surface_load.force, item 5[1]" in sentence(difference)


def test_zero_and_minus_zero_differ_but_nan_is_itself(tmp_path):
    def write_zero(zero):
        def change(k, fields):
            fields["water"]["surface_load.force"][0] = (np.nan, np.inf, zero)

        return change

    a = _record(tmp_path / "a.h5", write_zero(0.0))
    assert compare(a, _record(tmp_path / "same.h5", write_zero(0.0))) is None
    difference = compare(a, _record(tmp_path / "b.h5", write_zero(-0.0)))
    assert difference is not None
    assert (difference.window, difference.item, difference.index) == (0, 0, (2,))
    assert "0.0" in sentence(difference) and "-0.0" in sentence(difference)


@pytest.mark.parametrize(
    ("settings", "kind", "word"),
    [
        ({"names": ("cubes",)}, "names", "only the first has water.surface_load.force"),
        ({"n": 5}, "static", "cubes.motion.mass"),
        ({"mass": 2.0}, "static", "item 0: 1.0"),
        ({"rows": 149}, "windows", "150 rows against 149 rows"),
        ({"port": replace(MOTION, fields=MOTION.fields[:2])}, "names", "motion.angular_velocity"),
        ({"port": replace(MOTION, items="partner")}, "ports", "partner"),
    ],
)
def test_what_is_laid_out_differently_is_named(tmp_path, original, settings, kind, word):
    difference = compare(original, _record(tmp_path / "b.h5", **settings))
    assert difference is not None and difference.kind == kind
    assert word in sentence(difference)


def test_different_numbers_of_items_are_named(tmp_path):
    a, b = tmp_path / "a.h5", tmp_path / "b.h5"
    for path, n in ((a, 3), (b, 4)):
        with Recorder(path, "", "") as recorder:
            recorder.component("water", (SURFACE_LOAD,), {})
            recorder.add("water", Instant(0.0, 0), {"surface_load.force": np.zeros((n, 3))})
    difference = compare(a, b)
    assert difference is not None and difference.kind == "items"
    assert "(3, 3) against shape (4, 3)" in sentence(difference)


def test_windows_at_different_times_differ(tmp_path, original):
    b = _record(tmp_path / "b.h5", ticks={7: 50})
    difference = compare(original, b)
    assert difference is not None and (difference.kind, difference.window) == ("time", 7)
    assert "at 0.07 s against 0.5 s" in sentence(difference)


def test_fields_that_both_have_are_compared_though_each_has_others(tmp_path, capsys):
    """A different value is found; fields and components of only one recording are named too."""

    def change(k, fields):
        if k == 7:
            fields["cubes"]["motion.position"][2, 1] = 5.0

    short_port = replace(MOTION, fields=MOTION.fields[:2])
    a = _record(tmp_path / "a.h5", port=short_port)
    equal, changed = (
        _record(tmp_path / name, edit, names=("cubes",))
        for name, edit in (("b.h5", None), ("c.h5", change))
    )
    difference = compare(a, changed)
    assert difference is not None and (difference.kind, difference.window) == ("value", 7)
    assert compare(a, equal).kind == "names" and compare(a, equal).shared == 2
    other_fields = [f"cubes.motion.{field.name}" for field in MOTION.fields[2:]]
    assert only_in_one(a, equal) == (["water.surface_load.force"], sorted(other_fields))
    with pytest.raises(SystemExit) as exit_info:
        main(["diff", str(a), str(changed)])
    assert exit_info.value.code == 1
    output = capsys.readouterr().out
    assert "window 7" in output and f"Only {a} has: water.surface_load.force.\n" in output
    assert f"Only {changed} has: {', '.join(sorted(other_fields))}.\n" in output


def test_recordings_without_a_field_in_common_are_not_the_same(tmp_path):
    a, b = (_record(tmp_path / f"{name}.h5", names=(name,)) for name in ("cubes", "water"))
    difference = compare(a, b)
    assert difference is not None and "no field in common" in sentence(difference)
