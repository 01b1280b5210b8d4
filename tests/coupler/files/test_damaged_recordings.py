"""Every reader of a recording notices a change or cut, or reads the recording as it was."""

import io
import os
import shutil
from contextlib import redirect_stderr

import h5py
import numpy as np
import pytest

from quintet.components.stand_ins.params import ReplayParams
from quintet.components.stand_ins.recorded import recorded_plan, recorded_start
from quintet.components.stand_ins.replay import Replay
from quintet.coupler.files.recording import Instant, Recorder, Recording
from quintet.coupler.report.diff import compare
from quintet.interfaces.errors import SceneError
from quintet.interfaces.ports import MOTION, SURFACE_LOAD
from quintet.interfaces.recordings import CHECK, ROW_CHECKS

ROWS, MORE = 70, 5


def fields(name, k):
    random = np.random.default_rng(k)
    if name == "cubes":
        return {f"motion.{f.name}": random.normal(size=(3, *f.shape)) for f in MOTION.fields}
    return {"surface_load.force": random.normal(size=(9, 3))}


def add(recorder, first, last):
    for k in range(first, last):
        for name in ("cubes", "water"):
            recorder.add(name, Instant(0.01 * k, k, 0.02), fields(name, k))


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    path = tmp_path_factory.mktemp("whole") / "recording.h5"
    with Recorder(path, "run 7", "end = 1.0", 0.01) as recorder:
        recorder.component("cubes", (MOTION,), {"motion.mass": np.arange(3.0)})
        recorder.component("water", (SURFACE_LOAD,), {})
        add(recorder, 0, ROWS)
    return path


def differs(path, whole):
    """As ``quintet diff``."""
    return compare(whole, path) is not None


def loads_differently(path, whole):
    """As expectations and Python read it."""
    with Recording(whole) as original, Recording(path) as damaged:
        assert (original.run, original.scene, original.names) == (
            damaged.run,
            damaged.scene,
            damaged.names,
        )
        for name in original.names:
            for key in original.fields(name):
                assert (original.history(name, key, 2) == damaged.history(name, key, 2)).all()
                assert original.field(name, key).tobytes() == damaged.field(name, key).tobytes()
            assert (original.times(name) == damaged.times(name)).all()
    return False


def replays_differently(path, whole):
    """As a scene that replays a component is read and run."""
    for name in ("cubes", "water"):
        files = (whole, path)
        params = [ReplayParams(recording=str(file), component=name) for file in files]
        plans, starts = (list(map(of, params)) for of in (recorded_plan, recorded_start))
        assert (plans[0].times == plans[1].times).all()
        assert (
            plans[0].items == plans[1].items and plans[0].bytes_per_item == plans[1].bytes_per_item
        )
        assert all((starts[0][key] == starts[1][key]).all() for key in starts[0])
        original, damaged = map(Replay, params)
        assert original.gives == damaged.gives and (original.stable == damaged.stable).all()
        assert (
            original.rows.keys() == damaged.rows.keys()
            and original.static.keys() == damaged.static.keys()
        )
        assert all(
            original.rows[key].tobytes() == damaged.rows[key].tobytes() for key in original.rows
        )
    return False


def resumes_differently(path, whole):
    """As a run that was interrupted before its last rows goes on."""
    recorder = Recorder.resume(path, ROWS - MORE)
    with recorder:
        add(recorder, ROWS - MORE, ROWS)
    return differs(path, whole)


READERS = [differs, loads_differently, replays_differently, resumes_differently]


def is_noticed(read, path, whole):
    """Whether the reader reports the damage in a sentence; if not, it must read as before."""
    try:
        with redirect_stderr(io.StringIO()):
            is_different = read(path, whole)
    except SceneError as error:
        assert str(path) in str(error) and len(error.mistakes) == 1
        return True
    assert not is_different
    return False


def try_bits(read, whole, path, count, seed=0):
    """Flip bits of a recording one by one; return how many were noticed."""
    data, random, noticed = whole.read_bytes(), np.random.default_rng(seed), 0
    for bit in random.integers(8 * len(data), size=count):
        damaged = bytearray(data)
        damaged[bit // 8] ^= 1 << int(bit % 8)
        path.write_bytes(damaged)
        noticed += is_noticed(read, path, whole)
    return noticed


@pytest.mark.parametrize(
    "count",
    [
        pytest.param(120, marks=pytest.mark.slow),
        pytest.param(2500, marks=pytest.mark.full),
    ],
)
@pytest.mark.parametrize("read", READERS)
def test_every_flipped_bit_is_noticed_or_harmless(whole, tmp_path, read, count):
    assert try_bits(read, whole, tmp_path / "r.h5", count, count) >= 0.1 * count


@pytest.mark.parametrize("read", READERS)
def test_a_recording_that_was_cut_or_torn_is_noticed(whole, tmp_path, read):
    data, path = whole.read_bytes(), tmp_path / "r.h5"
    for length in (0, 1, 100, len(data) // 2, len(data) - 1):
        path.write_bytes(data[:length])
        assert is_noticed(read, path, whole)
    for place in (len(data) // 3, 2 * len(data) // 3):  # a block that never came to the disk
        path.write_bytes(data[:place] + bytes(4096) + data[place + 4096 :])
        is_noticed(read, path, whole)


def test_the_window_that_was_changed_is_named(whole, tmp_path):
    path = shutil.copy(whole, tmp_path / "r.h5")
    with h5py.File(path, "r+") as file:
        file["components/water/fields/surface_load.force"][7, 0, 0] += 1e-9
    with Recording(path) as recording:
        assert recording.row("water", 6) and recording.row("water", 8)
        with pytest.raises(SceneError, match=r"window 7 of water\.surface_load\.force is not as"):
            recording.field("water", "surface_load.force")
        assert len(recording.field("cubes", "motion.position")) == ROWS


def test_rows_in_each_others_places_are_noticed(whole, tmp_path):
    path = shutil.copy(whole, tmp_path / "r.h5")
    with h5py.File(path, "r+") as file:
        data = file["components/water/fields/surface_load.force"]
        data[3], data[4] = data[4], data[3]
    with Recording(path) as recording, pytest.raises(SceneError, match="window 3 of"):
        recording.field("water", "surface_load.force")


def test_a_recording_of_before_is_read_with_a_note_and_sealed_when_a_run_goes_on(
    whole, tmp_path, capsys
):
    path = shutil.copy(whole, tmp_path / "r.h5")
    with h5py.File(path, "r+") as file:
        del file.attrs[CHECK]
        for group in file["components"].values():
            del group.attrs[CHECK], group[ROW_CHECKS]
    assert not differs(path, whole) and not replays_differently(path, whole)
    assert capsys.readouterr().err.count(f"recording {path} has no checksums") == 1
    assert not resumes_differently(path, whole)
    with h5py.File(path, "r+") as file:
        file["components/water/fields/surface_load.force"][7, 0, 0] += 1e-9
    assert is_noticed(differs, path, whole)
    assert os.path.getsize(path) < 2 * os.path.getsize(whole)
