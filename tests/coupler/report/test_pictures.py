"""Pictures show what the files hold, and cost nothing to a run that wants none."""

import subprocess
import sys
import time

import numpy as np
import pytest

from quintet.coupler.files.recording import Instant, Recorder, Recording
from quintet.coupler.files.vtkhdf import VtkHdf
from quintet.coupler.measures.expectation import Expectation, evaluate
from quintet.coupler.report.pictures import comparison, side_views
from quintet.interfaces.errors import SceneError
from quintet.interfaces.ports import MOTION

BOX = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]) * 0.2
FACES = np.array([[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4]])


def _cloud(path, n, shift=(0.0, 0.0, 0.0), speed=1.0):
    random = np.random.default_rng(2)
    file = VtkHdf(path)
    for k in range(3):
        points = random.random((n, 3)) + np.multiply(shift, k)
        file.append(0.1 * k, {"points": points, "velocity": np.full((n, 3), speed * k)})
    file.close()


def _box(path):
    file = VtkHdf(path)
    for k in range(3):
        file.append(0.1 * k, {"points": BOX + np.array([1.5, 0.0, 0.1 * k]), "cells": FACES})
    file.close()


def _image(path):
    from matplotlib.image import imread

    return imread(path)[..., :3]


def test_a_run_without_pictures_imports_no_drawing():
    script = "import sys, quintet.coupler.report.pictures; sys.exit('matplotlib' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", script], check=False).returncode == 0


def test_snapshots_show_particles_and_bodies_in_each_panel(tmp_path):
    _cloud(tmp_path / "water.vtkhdf", 500)
    _box(tmp_path / "cube.vtkhdf")
    out = side_views(tmp_path, tmp_path / "pictures" / "all.png", [0.0, 0.11, 5.0])
    image = _image(out)
    red, green, blue = np.moveaxis(image, 2, 0)
    solid = (red < 0.85) & (red - green > 0.06) & (red - blue > 0.1)
    rows = np.flatnonzero(solid.any(axis=1))
    assert solid.sum() > 1000  # the box, in its own colour
    assert np.diff(rows).max() > 50  # in panels of two rows
    assert (image.max(axis=2) - image.min(axis=2) > 0.2).sum() > 2000


@pytest.mark.parametrize("only", ["cloud", "box", "point"])
def test_snapshots_need_neither_particles_nor_bodies(tmp_path, only):
    if only == "box":
        _box(tmp_path / "a.vtkhdf")
    else:
        _cloud(tmp_path / "a.vtkhdf", 40 if only == "cloud" else 1, speed=0.0)
    assert side_views(tmp_path, tmp_path / "a.png", [0.1]).stat().st_size > 1000


def test_snapshots_of_many_particles_are_quick(tmp_path):
    _cloud(tmp_path / "water.vtkhdf", 200_000)
    begin = time.perf_counter()
    side_views(tmp_path, tmp_path / "a.png", [0.2])
    assert time.perf_counter() - begin < 8.0


def test_a_picture_of_nothing_is_refused(tmp_path):
    with pytest.raises(SceneError, match=r"needs a \.vtkhdf file with steps"):
        side_views(tmp_path, tmp_path / "a.png", [0.0])


def test_comparison_draws_a_panel_for_each_reference_curve(tmp_path):
    with Recorder(tmp_path / "recording.h5", "", "") as recorder:
        recorder.component("cubes", (MOTION,), {})
        for k in range(50):
            row = {"motion.position": np.array([[0.02 * k, 0.0, 0.0]])}
            recorder.add("cubes", Instant(0.02 * k, k), row)
    (tmp_path / "ref.csv").write_text("t,x\n0,0\n0.5,0.52\n0.9,0.9\n")
    common = dict(component="cubes", field="motion.position", axis=0, unit="m", source="s")
    ones = [
        Expectation(name="x [rms]", measure="rms", csv="ref.csv", within=0.1, **common),
        Expectation(name="x_$1", measure="crossing", csv="ref.csv", level=0.3, within=1, **common),
        Expectation(name="top", measure="max", value=1.0, within=0.1, **common),
    ]
    with Recording(tmp_path) as recording:
        outcomes = [evaluate(one, recording, tmp_path) for one in ones]
        out = comparison(tmp_path, ones, outcomes, recording, tmp_path / "c.png")
        assert comparison(tmp_path, ones[2:], outcomes, recording, tmp_path / "d.png") is None
    assert out is not None and not (tmp_path / "d.png").exists()
    image = _image(out)
    blue = (image[..., 2] > 0.6) & (image[..., 0] < 0.3)
    half = image.shape[1] // 2
    assert blue[:, :half].sum() > 200 and blue[:, half:].sum() > 200
