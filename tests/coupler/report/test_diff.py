"""Two recordings part where their first bit differs."""

from dataclasses import replace

import numpy as np
import pytest

from quintet.coupler.files.recording import Instant, Recorder
from quintet.coupler.report.diff import compare, sentence
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
                "water": {"surface_load.force": random.random((6, 3))},
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

    found = compare(original, _record(tmp_path / "b.h5", change))
    assert found is not None and found.kind == "value"
    assert (found.component, found.field) == ("water", "surface_load.force")
    assert (found.window, found.item, found.index) == (97, 5, (1,))
    assert found.b == np.nextafter(found.a, 2.0)
    assert "window 97 (t = 0.97 s): water.surface_load.force, item 5[1]" in sentence(found)


def test_zero_and_minus_zero_differ_but_nan_is_itself(tmp_path):
    def odd(zero):
        def change(k, fields):
            fields["water"]["surface_load.force"][0] = (np.nan, np.inf, zero)

        return change

    a = _record(tmp_path / "a.h5", odd(0.0))
    assert compare(a, _record(tmp_path / "same.h5", odd(0.0))) is None
    found = compare(a, _record(tmp_path / "b.h5", odd(-0.0)))
    assert found is not None
    assert (found.window, found.item, found.index) == (0, 0, (2,))
    assert "0.0" in sentence(found) and "-0.0" in sentence(found)


@pytest.mark.parametrize(
    ("settings", "kind", "word"),
    [
        ({"names": ("cubes",)}, "names", "components cubes, water against components cubes"),
        ({"n": 5}, "static", "cubes.motion.mass"),
        ({"mass": 2.0}, "static", "item 0: 1.0"),
        ({"rows": 149}, "windows", "150 rows against 149 rows"),
        ({"port": replace(MOTION, fields=MOTION.fields[:2])}, "names", "fields"),
        ({"port": replace(MOTION, items="partner")}, "ports", "partner"),
    ],
)
def test_what_is_laid_out_differently_is_named(tmp_path, original, settings, kind, word):
    found = compare(original, _record(tmp_path / "b.h5", **settings))
    assert found is not None and found.kind == kind
    assert word in sentence(found)


def test_different_numbers_of_items_are_named(tmp_path):
    a, b = tmp_path / "a.h5", tmp_path / "b.h5"
    for path, n in ((a, 3), (b, 4)):
        with Recorder(path, "", "") as recorder:
            recorder.component("water", (SURFACE_LOAD,), {})
            recorder.add("water", Instant(0.0, 0), {"surface_load.force": np.zeros((n, 3))})
    found = compare(a, b)
    assert found is not None and found.kind == "items"
    assert "(3, 3) against shape (4, 3)" in sentence(found)


def test_windows_at_different_times_differ(tmp_path, original):
    b = _record(tmp_path / "b.h5", ticks={7: 50})
    found = compare(original, b)
    assert found is not None and (found.kind, found.window) == ("time", 7)
    assert "at 0.07 s against 0.5 s" in sentence(found)
