"""A scene as one of its limits of stability has it."""

import pytest

from quintet.components.shared.scene_limits import keys_of, scene_at_limit
from quintet.interfaces.errors import SceneError

SCENE = """
end = 2.0
[components.water]
kind = "sph_fluid"
threads = 2
spacing = 0.02
fluid = [{ shape = "box", highest = [1.0, 1.0, 1.0] }]
[[stability]]
name = "step"
parameter = "components.water.courant"
[stability.settings]
"components.water.spacing" = 0.1
"components.water.fluid.0.highest" = [2.0, 1.0, 1.0]
"components.water.viscosity.artificial" = 0.0
[[stability]]
name = "window"
parameter = "window"
end = 0.5
against = { parameter = "components.water.density", values = [500.0, 1000.0] }
"""


def test_a_scene_has_the_settings_of_the_limit(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(SCENE)
    scene, limit = scene_at_limit(path)
    assert (limit["name"], limit["end"]) == ("step", 2.0)
    fluid = [{"shape": "box", "highest": [2.0, 1.0, 1.0]}]
    keys = {"spacing": 0.1, "fluid": fluid, "viscosity": {"artificial": 0.0}}
    assert keys_of(scene, "sph_fluid") == keys
    scene, limit = scene_at_limit(path, "window", 1)
    assert limit["end"] == 0.5 and keys_of(scene, "sph_fluid")["density"] == 1000.0


def test_what_is_not_there_is_refused(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(SCENE)
    with pytest.raises(
        SceneError, match=r"a limit of stability named 'jitter' must be there; found"
    ):
        scene_at_limit(path, "jitter")
    with pytest.raises(SceneError, match=r"one must be of the kind fe_plate; found 0. Use another"):
        keys_of(scene_at_limit(path)[0], "fe_plate")
