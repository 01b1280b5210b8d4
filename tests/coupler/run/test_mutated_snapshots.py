"""Snapshots that were changed at random are refused; with a right checksum they end in order."""

import json
import shutil

import h5py
import numpy as np
import pytest
from started import Started, write_scene
from test_folder import status

from quintet.coupler.files.disk import is_sound, seal
from quintet.coupler.run import snapshots
from quintet.interfaces.errors import SceneError

ODD = (
    "null", "[]", "{}", "1e999", "-1", '"x"', "[[1]]", '{"a": 1}', "{", "", "true", "9" * 400,
    np.zeros(0), np.zeros((2, 7)), np.full((5, 3), np.nan), np.array(3), np.array([b"x"]),
)  # fmt: skip


@pytest.fixture(scope="module")
def killed(tmp_path_factory):
    """The folder of a run that was killed when it had a snapshot."""
    folder = tmp_path_factory.mktemp("killed")
    path = write_scene(folder, "memory", 0.1, pong="pause = 3e-3")
    run = Started(path, "--set", "output.snapshots=0.02")
    run.wait_until(lambda: snapshots.snapshots(run.folder))
    run.process.kill()
    run.wait()
    for older in snapshots.snapshots(run.folder)[:-1]:
        older.unlink()
    return run.folder


def in_bytes(data, random):
    """Bits, cuts, blocks that never came to the disk, and bytes that do not belong there."""
    place, changed = int(random.integers(len(data))), bytearray(data)
    match random.integers(4):
        case 0:
            changed[place] ^= 1 << random.integers(8)
        case 1:
            del changed[place:]
        case 2:
            changed[place : place + 4096] = bytes(len(changed[place : place + 4096]))
        case 3:
            changed[place:place] = random.bytes(int(random.integers(1, 100)))
    return bytes(changed)


def in_content(path, random):
    """Another value, or none, in a place of the file, whose checksum is then made anew."""
    with h5py.File(path, "r+") as file:
        places = []
        file.visit(places.append)
        name = places[random.integers(len(places))]
        odd, of_json = ODD[random.integers(len(ODD))], "json" in file[name].attrs
        keys = file[name].attrs.get("keys")
        if keys is not None and random.random() < 0.5:
            file[name].attrs["keys"] = json.dumps(json.loads(keys)[::-1][:-1])
        else:
            del file[name]
            if random.random() < 0.7:
                file[name] = odd
                if of_json and random.random() < 0.8:
                    file[name].attrs["json"] = True
    seal(path)


@pytest.mark.parametrize("count", [300, pytest.param(1500, marks=pytest.mark.full)])
def test_a_snapshot_whose_bytes_were_changed_is_not_used(killed, tmp_path, count):
    path = snapshots.latest(killed)
    data, random = path.read_bytes(), np.random.default_rng(31)
    changed = tmp_path / path.name
    for _ in range(count):
        changed.write_bytes(other := in_bytes(data, random))
        if other == data:
            continue
        assert not is_sound(changed)
        with pytest.raises(SceneError, match="is not as it was written: it was cut or changed"):
            snapshots.latest(tmp_path)


@pytest.mark.parametrize("count", [3, pytest.param(500, marks=pytest.mark.full)])
def test_a_snapshot_with_other_content_and_a_right_checksum_ends_in_order(
    killed, tmp_path, capfd, count
):
    """No accident makes such a file: what reads it says so, or the window that uses it fails."""
    random = np.random.default_rng(32)
    for number in range(count):
        again = shutil.copytree(killed, tmp_path / f"again{number}")
        in_content(snapshots.latest(again), random)
        ended = status("run", "--resume", again)
        said = capfd.readouterr()
        assert ended in (0, 1, 2, 3), said.err
        assert ended < 2 or "quintet: " in said.err
        assert ended != 2 or "Traceback" not in said.err, said.err
        shutil.rmtree(again)
