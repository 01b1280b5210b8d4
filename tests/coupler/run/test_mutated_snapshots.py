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
def killed_folder(tmp_path_factory):
    """The folder of a run that was killed when it had a snapshot."""
    folder = tmp_path_factory.mktemp("killed")
    path = write_scene(folder, "memory", 0.1, pong="pause = 3e-3")
    run = Started(path, "--set", "output.snapshots=0.02")
    run.wait_until(lambda: snapshots.snapshots(run.folder))
    run.process.kill()
    run.wait()
    for old_snapshot in snapshots.snapshots(run.folder)[:-1]:
        old_snapshot.unlink()
    return run.folder


def damage_bytes(data, random):
    """Bits, cuts, blocks that never came to the disk, and bytes that do not belong there."""
    place, damaged = int(random.integers(len(data))), bytearray(data)
    match random.integers(4):
        case 0:
            damaged[place] ^= 1 << random.integers(8)
        case 1:
            del damaged[place:]
        case 2:
            damaged[place : place + 4096] = bytes(len(damaged[place : place + 4096]))
        case 3:
            damaged[place:place] = random.bytes(int(random.integers(1, 100)))
    return bytes(damaged)


def change_content(path, random):
    """Replace or delete one value in the file, and renew its checksum."""
    with h5py.File(path, "r+") as file:
        places = []
        file.visit(places.append)
        name = places[random.integers(len(places))]
        odd_value, of_json = ODD[random.integers(len(ODD))], "json" in file[name].attrs
        keys = file[name].attrs.get("keys")
        if keys is not None and random.random() < 0.5:
            file[name].attrs["keys"] = json.dumps(json.loads(keys)[::-1][:-1])
        else:
            del file[name]
            if random.random() < 0.7:
                file[name] = odd_value
                if of_json and random.random() < 0.8:
                    file[name].attrs["json"] = True
    seal(path)


@pytest.mark.parametrize("count", [300, pytest.param(1500, marks=pytest.mark.full)])
def test_a_snapshot_whose_bytes_were_changed_is_not_used(killed_folder, tmp_path, count):
    path = snapshots.latest(killed_folder)
    data, random = path.read_bytes(), np.random.default_rng(31)
    damaged_path = tmp_path / path.name
    for _ in range(count):
        damaged_path.write_bytes(damaged := damage_bytes(data, random))
        if damaged == data:
            continue
        assert not is_sound(damaged_path)
        with pytest.raises(SceneError, match="is incomplete or was changed: its checksum differs"):
            snapshots.latest(tmp_path)


@pytest.mark.parametrize("count", [3, pytest.param(500, marks=pytest.mark.full)])
def test_a_snapshot_with_other_content_and_a_right_checksum_ends_in_order(
    killed_folder, tmp_path, capfd, count
):
    """No accident makes such a file: its reader refuses it, or the window that uses it fails."""
    random = np.random.default_rng(32)
    for number in range(count):
        copy = shutil.copytree(killed_folder, tmp_path / f"again{number}")
        change_content(snapshots.latest(copy), random)
        exit_status = status("run", "--resume", copy)
        screen = capfd.readouterr()
        assert exit_status in (0, 1, 2, 3), screen.err
        assert exit_status < 2 or "quintet: " in screen.err
        assert exit_status != 2 or "Traceback" not in screen.err, screen.err
        shutil.rmtree(copy)
