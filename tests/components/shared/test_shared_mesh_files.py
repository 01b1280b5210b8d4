"""Surfaces from files enclose each part of their volume once, or are refused."""

import numpy as np
import pytest
import trimesh

from quintet.components.shared.geometry.mesh_files import read


def save_mesh(tmp_path, *shells):
    file = tmp_path / "shape.stl"
    trimesh.util.concatenate(shells).export(file)
    return str(file)


def cube(edge=1.0, x=0.0, flipped=False):
    box = trimesh.creation.box((edge,) * 3)
    box.apply_translation((x, 0.0, 0.0))
    if flipped:
        box.invert()
    return box


def test_shells_that_overlap_are_refused(tmp_path):
    """A volume that two shells share would count twice in mass and inertia."""
    with pytest.raises(ValueError, match=r"found 33\.\d% of it in several shells that overlap"):
        read(save_mesh(tmp_path, cube(), cube(x=0.5)), 1.0)


def test_crossed_bars_without_corners_in_each_other_are_refused(tmp_path):
    bars = [trimesh.creation.box(np.roll((3.0, 1.0, 1.1), k)) for k in (0, 1)]
    with pytest.raises(ValueError, match="in several shells that overlap"):
        read(save_mesh(tmp_path, *bars), 1.0)


def test_a_shell_that_is_inside_out_beside_another_is_refused(tmp_path):
    with pytest.raises(ValueError, match=r"in shells that are inside out"):
        read(save_mesh(tmp_path, cube(2.0), cube(x=5.0, flipped=True)), 1.0)


def test_a_shell_within_another_that_is_no_cavity_is_refused(tmp_path):
    with pytest.raises(ValueError, match="those of a cavity's into the cavity"):
        read(save_mesh(tmp_path, cube(2.0), cube()), 1.0)


def test_cavities_and_shells_apart_have_their_volume(tmp_path):
    hollow = save_mesh(tmp_path, cube(2.0), cube(flipped=True), cube(x=5.0))
    assert read(hollow, 0.1).volume == pytest.approx(8e-3, rel=1e-9)


def test_a_single_shell_that_is_inside_out_is_turned(tmp_path):
    assert read(save_mesh(tmp_path, cube(flipped=True)), 1.0).volume == pytest.approx(1.0)
