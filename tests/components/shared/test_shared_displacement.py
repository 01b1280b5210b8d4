"""The volume of a surface below a level."""

import numpy as np
import pytest
import trimesh

from quintet.components.shared.geometry.displacement import displaced_volume, level_of_volume


def test_displaced_volume_of_triangles_is_exact():
    cube = np.asarray(trimesh.creation.box((2.0, 3.0, 4.0)).triangles)
    levels = {-3.0: 0.0, -2.0: 0.0, -0.5: 9.0, 1.0: 18.0, 2.0: 24.0, 3.0: 24.0}
    for level, volume in levels.items():
        assert displaced_volume(cube, level) == pytest.approx(volume, rel=1e-12, abs=1e-12)
    cone = trimesh.creation.cone(radius=1.0, height=2.0, sections=24)  # its tip above
    above = cone.volume - displaced_volume(np.asarray(cone.triangles), 1.0)
    assert above == pytest.approx(cone.volume / 8.0, rel=1e-12)


def test_volumes_below_and_above_a_level_make_up_a_turned_box():
    turn = trimesh.transformations.euler_matrix(0.4, 0.7, 0.2)
    box = np.asarray(trimesh.creation.box((1.0, 2.0, 3.0), turn).triangles)
    mirrored = box[:, ::-1] * [1.0, 1.0, -1.0]
    for level in (-1.4, -0.9, 0.0, 0.3, 1.2):
        below, above = displaced_volume(box, level), displaced_volume(mirrored, -level)
        assert 0.0 < below < 6.0
        assert below + above == pytest.approx(6.0, rel=1e-12)


def test_level_of_a_volume():
    cube = np.asarray(trimesh.creation.box((2.0, 3.0, 4.0)).triangles)
    assert level_of_volume(cube, 9.0) == pytest.approx(-0.5, abs=1e-9)
