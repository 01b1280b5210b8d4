"""Walls that move: each view has a step of them, also in a run that goes on."""

import shutil

import numpy as np
import pytest
from started import same, write_scene

from quintet.coupler.files import vtkhdf_reader
from quintet.coupler.report.view_steps import walls
from quintet.coupler.run import snapshots
from quintet.coupler.run.simulate import make_folder, simulate
from quintet.coupler.scene.read import load

PUSHING = """
import numpy as np
from toys import Toy

class Pushing(Toy):
    '''One wall moves by 1 mm in each step, the other stands.'''
    walls_move = True

    def walls(self):
        wall = np.array([[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 1.0, 1.0]])
        moving = wall + [1e-3 * self.steps, 0.0, 0.0]
        return {"points": np.concatenate([wall, moving]), "cells": np.array([[0, 1, 2], [3, 4, 5]])}
"""
SETTINGS = ("output.interval=0.02", "output.totals=0.005", "output.pictures=[0.05]")


@pytest.fixture
def scene(tmp_path, monkeypatch):
    """Write a scene of a toy with a wall that moves."""
    path = write_scene(tmp_path, end=0.1, ping="seen = true\nitems = 4", pong="items = 4")
    path.write_text(path.read_text().replace("toys:Toy", "toy_pushing:Pushing", 1))
    (tmp_path / "toy_pushing.py").write_text(PUSHING)
    monkeypatch.delitem(__import__("sys").modules, "toy_pushing", raising=False)
    return lambda *settings: load(str(path), settings=(*SETTINGS, *settings), transport="memory")


def test_every_view_has_walls_where_they_are(tmp_path, scene):
    run = tmp_path / "run"
    make_folder(scene(), run)
    simulate(scene(), run)
    times = vtkhdf_reader.times(run / "ping.walls.vtkhdf")
    assert np.array_equal(times, vtkhdf_reader.times(run / "ping.vtkhdf"))
    assert {0.0, 0.02, 0.05, 0.1} <= set(np.round(times, 9).tolist())
    for time in (0.0, 0.05, 0.1):
        standing, moving = walls(run, time)
        assert standing.corners[:, 0] == pytest.approx(np.zeros(3))
        assert moving.corners[:, 0] == pytest.approx(np.full(3, time))
    assert not (run / "pong.walls.vtkhdf").exists()


def test_a_run_that_goes_on_has_the_same_walls(tmp_path, scene, monkeypatch):
    monkeypatch.setattr(snapshots, "remove", lambda paths: None)
    first, resumed = tmp_path / "first", tmp_path / "again"
    make_folder(scene("output.snapshots=0.03"), first)
    exit_status = simulate(scene("output.snapshots=0.03"), first)
    shutil.copytree(first, resumed)
    snapshot = snapshots.latest(resumed)
    assert 0 < snapshots.window_of(snapshot) < 100
    assert simulate(scene("output.snapshots=0.03"), resumed, snapshot) == exit_status
    assert same(first, resumed)
