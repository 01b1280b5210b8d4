"""The volume of a surface below a level."""

import numpy as np
import pytest
import trimesh

from quintet.components.shared.geometry.displacement import Heights


def test_displaced_volume_of_triangles_is_exact():
    cube = np.asarray(trimesh.creation.box((2.0, 3.0, 4.0)).triangles)
    levels = {-3.0: 0.0, -2.0: 0.0, -0.5: 9.0, 1.0: 18.0, 2.0: 24.0, 3.0: 24.0}
    for level, volume in levels.items():
        assert Heights.of(cube).volume_below(level) == pytest.approx(volume, rel=1e-12, abs=1e-12)
    cone = trimesh.creation.cone(radius=1.0, height=2.0, sections=24)  # its tip above
    above = cone.volume - Heights.of(np.asarray(cone.triangles)).volume_below(1.0)
    assert above == pytest.approx(cone.volume / 8.0, rel=1e-12)


def test_volumes_below_and_above_a_level_make_up_a_turned_box():
    turn = trimesh.transformations.euler_matrix(0.4, 0.7, 0.2)
    box = np.asarray(trimesh.creation.box((1.0, 2.0, 3.0), turn).triangles)
    mirrored = box[:, ::-1] * [1.0, 1.0, -1.0]
    for level in (-1.4, -0.9, 0.0, 0.3, 1.2):
        below = Heights.of(box).volume_below(level)
        above = Heights.of(mirrored).volume_below(-level)
        assert 0.0 < below < 6.0
        assert below + above == pytest.approx(6.0, rel=1e-12)


def test_level_of_a_volume():
    cube = Heights.of(np.asarray(trimesh.creation.box((2.0, 3.0, 4.0)).triangles))
    assert cube.level_of(9.0) == pytest.approx(-0.5, abs=1e-9)
    assert cube.level_of(0.0) == -2.0 and cube.level_of(25.0) == 2.0


def test_few_levels_are_tried_for_that_of_a_volume(monkeypatch):
    tried = []
    volume_below = Heights.volume_below
    monkeypatch.setattr(
        Heights, "volume_below", lambda *args: tried.append(args) or volume_below(*args)
    )
    cone = Heights.of(np.asarray(trimesh.creation.cone(radius=1.0, height=2.0).triangles))
    for share in (1e-6, 0.01, 0.3, 0.9, 0.9999):
        tried.clear()
        above = np.cbrt(1.0 - share)  # of the cone's height
        level = cone.level_of(share * volume_below(cone, 2.0))
        assert level == pytest.approx(2.0 - 2.0 * above, rel=1e-6)
        assert len(tried) <= 20
