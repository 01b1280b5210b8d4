"""The recording gives back the recorded values, bit for bit."""

import os
import signal
import subprocess
import sys

import numpy as np
import pytest

from quintet.coupler.files.recording import Instant, Recorder, Recording
from quintet.interfaces.errors import PortError, SceneError
from quintet.interfaces.ports import LOAD, MOTION, SURFACE_LOAD

FIELDS = [f"motion.{field.name}" for field in MOTION.fields]


def _row(k, n=3):
    random = np.random.default_rng(k)
    row = {f"motion.{f.name}": random.normal(size=(n, *f.shape)) for f in MOTION.fields}
    return row | {f"load.{f.name}": random.normal(size=(n, *f.shape)) for f in LOAD.fields}


def _record(path, rows, n=3):
    with Recorder(path, "run 7", "window = 0.1  # s, µ") as recorder:
        recorder.component("cubes", (MOTION, LOAD), {"motion.mass": np.arange(n) + 0.5})
        recorder.component("water", (SURFACE_LOAD,), {})
        for k in range(rows):
            recorder.add("cubes", Instant(0.1 * k, k), _row(k, n))
            recorder.add(
                "water", Instant(0.1 * k, k), {"surface_load.force": np.full((5, 3), float(k))}
            )


@pytest.mark.parametrize("rows", [0, 1, 63, 64, 65, 200])
def test_recording_gives_back_every_row(tmp_path, rows):
    _record(tmp_path / "recording.h5", rows)
    with Recording(tmp_path) as recording:
        assert np.array_equal(recording.times("cubes"), 0.1 * np.arange(rows))
        for k in range(rows):
            row = recording.row("cubes", k)
            assert all(np.array_equal(row[key], array) for key, array in _row(k).items())
        if rows:
            assert recording.field("water", "surface_load.force").shape == (rows, 5, 3)
            history = recording.history("water", "surface_load.force", 4)
            assert np.array_equal(history[:, 0], np.arange(rows))


def test_recording_gives_back_ports_static_scene_and_order(tmp_path):
    _record(tmp_path / "r.h5", 2)
    with Recording(tmp_path / "r.h5") as recording:
        assert recording.names == ("cubes", "water")
        assert recording.ports("cubes") == (MOTION, LOAD)
        assert recording.ports("water") == (SURFACE_LOAD,)
        assert recording.static("cubes")["motion.mass"].tolist() == [0.5, 1.5, 2.5]
        assert recording.static("water") == {}
        assert recording.run == "run 7" and recording.scene == "window = 0.1  # s, µ"
        assert recording.fields("cubes")[: len(FIELDS)] == tuple(FIELDS)


def test_recording_keeps_the_bits_of_numbers_that_compare_oddly(tmp_path):
    values = np.array([[-0.0, np.nan, -np.inf], [5e-324, np.nextafter(1, 2), -np.nan]])
    with Recorder(tmp_path / "o.h5", "", "") as recorder:
        recorder.component("water", (SURFACE_LOAD,), {})
        recorder.add("water", Instant(0.0, 0), {"surface_load.force": values})
    with Recording(tmp_path / "o.h5") as recording:
        assert recording.row("water", 0)["surface_load.force"].tobytes() == values.tobytes()


def test_recording_holds_rows_larger_than_a_batch_and_items_that_are_none(tmp_path):
    forces = np.random.default_rng(1).normal(size=(400_000, 3))
    with Recorder(tmp_path / "big.h5", "", "") as recorder:
        recorder.component("water", (SURFACE_LOAD,), {})
        recorder.component("dust", (SURFACE_LOAD,), {})
        for k in range(2):
            recorder.add("water", Instant(float(k), k), {"surface_load.force": forces + k})
            recorder.add("dust", Instant(float(k), k), {"surface_load.force": forces[:0]})
    with Recording(tmp_path / "big.h5") as recording:
        assert np.array_equal(recording.row("water", 1)["surface_load.force"], forces + 1)
        assert recording.row("dust", 1)["surface_load.force"].shape == (0, 3)


def test_recording_does_not_keep_the_arrays_it_is_given(tmp_path):
    force = np.ones((2, 3))
    with Recorder(tmp_path / "k.h5", "", "") as recorder:
        recorder.component("water", (SURFACE_LOAD,), {})
        recorder.add("water", Instant(0.0, 0), {"surface_load.force": force})
        force[:] = 7.0
    with Recording(tmp_path / "k.h5") as recording:
        assert (recording.row("water", 0)["surface_load.force"] == 1.0).all()


def test_a_killed_run_leaves_all_flushed_rows(tmp_path):
    script = f"""
import os, signal, numpy as np
from quintet.coupler.files.recording import Instant, Recorder
from quintet.interfaces.ports import SURFACE_LOAD
recorder = Recorder({str(tmp_path / "recording.h5")!r}, "", "")
recorder.component("water", (SURFACE_LOAD,), {{}})
for k in range(70):
    recorder.add("water", Instant(k, k), {{"surface_load.force": np.full((4, 3), k)}})
recorder.flush()
recorder.add("water", Instant(70, 70), {{"surface_load.force": np.zeros((4, 3))}})
os.kill(os.getpid(), signal.SIGKILL)
"""
    result = subprocess.run([sys.executable, "-c", script], env=os.environ, check=False)
    assert result.returncode == -signal.SIGKILL
    with Recording(tmp_path) as recording:
        assert len(recording.times("water")) == 70
        assert (recording.row("water", 69)["surface_load.force"] == 69.0).all()


def test_a_row_that_differs_in_names_or_shape_from_the_first_is_refused(tmp_path):
    with Recorder(tmp_path / "w.h5", "", "") as recorder:
        recorder.component("cubes", (MOTION,), {})
        with pytest.raises(PortError, match=r"Did you mean motion\.velocity"):
            recorder.add("cubes", Instant(0.0, 0), {"motion.velocty": np.zeros((1, 3))})
        with pytest.raises(PortError, match=r"must have shape \(n, \*\(3,\)\)"):
            recorder.add("cubes", Instant(0.0, 0), {"motion.velocity": np.zeros((1, 2))})
        recorder.add("cubes", Instant(0.0, 0), {"motion.velocity": np.zeros((4, 3))})
        with pytest.raises(PortError, match="must keep its shape"):
            recorder.add("cubes", Instant(0.1, 1), {"motion.velocity": np.zeros((1, 3))})
        with pytest.raises(PortError, match="must have the fields of the first"):
            recorder.add("cubes", Instant(0.1, 1), {})
    with Recording(tmp_path / "w.h5") as recording:
        assert len(recording.times("cubes")) == 1


def test_what_a_recording_lacks_is_named_with_the_nearest(tmp_path):
    _record(tmp_path / "recording.h5", 2)
    with Recording(tmp_path) as recording:
        with pytest.raises(SceneError, match="Did you mean cubes"):
            recording.times("cube")
        with pytest.raises(SceneError, match=r"Did you mean motion\.position"):
            recording.field("cubes", "motion.postion")
        with pytest.raises(SceneError, match="2 rows; there is no row 2"):
            recording.row("cubes", 2)
        with pytest.raises(SceneError, match="3 items; there is no item 3"):
            recording.history("cubes", "motion.position", 3)


def test_a_file_that_is_no_recording_is_refused(tmp_path):
    with pytest.raises(SceneError, match="no such file"):
        Recording(tmp_path)
    (tmp_path / "recording.h5").write_text("not HDF5")
    with pytest.raises(SceneError, match="not a whole recording"):
        Recording(tmp_path)
