"""What a check says of how bodies float in the water of a partner."""

import numpy as np
import pytest
import trimesh
from dem_scenes import params

from quintet.components.dem_bodies.plan import meeting_notes, meets
from quintet.components.shared.geometry.displacement import Heights
from quintet.coupler.cli import main
from quintet.coupler.scene.read import load
from quintet.interfaces.errors import SceneError

WATER = {
    "water_lowest": np.array([[0.0, 0.0, 0.0]]),
    "water_highest": np.array([[2.0, 1.0, 0.5]]),
    "water_density": np.array([1000.0]),
}
CUBE = {"shape": "box", "lowest": [0.9, 0.4, 0.4], "highest": [1.1, 0.6, 0.6], "material": "a"}
REMEDY = ". Correct its height, mass, scale or orientation if that is not meant."


def notes(water=WATER, **body):
    return meeting_notes(params([CUBE | body]), water)


@pytest.mark.parametrize(
    ("body", "text"),
    [
        ({"mass": 4.0}, "stands in 4 kg of water: without turning, it floats where it is"),
        # 0.02 m deeper, but for the 0.0004 m by which 0.8 kg raise a level of 2 m2.
        ({"mass": 4.8}, "stands in 4 kg of water: without turning, it floats 0.02 m lower"),
        (
            {"mass": 2.0},
            f"stands in 4 kg of water: without turning, it floats 0.049 m higher{REMEDY}",
        ),
        ({"mass": 8.5}, f"stands in 4 kg of water: it displaces at most 8 kg and sinks{REMEDY}"),
        (
            {"mass": 4.0, "lowest": [0.9, 0.4, 0.6], "highest": [1.1, 0.6, 0.8]},
            f"begins 0.1 m above the water: without turning, it floats 0.2 m lower{REMEDY}",
        ),
    ],
)  # fmt: skip
def test_a_body_is_said_to_float_where_archimedes_says(body, text):
    assert notes(**body) == (f"bodies[0] weighs {body['mass']:g} kg and {text}",)


def test_bodies_that_cannot_rise_and_other_waters_get_no_note():
    assert notes(mass=2.0, locked=["z"]) == ()
    assert len(notes(mass=2.0, locked=["z"], released_at=0.5)) == 1
    assert notes({}, mass=2.0) == ()
    size = dict.fromkeys(("lowest", "highest"))
    ball = {"shape": "sphere", "centre": [1.0, 0.5, 0.5], "radius": 0.1, "mass": 2.0}
    assert notes(**size, **ball) == ()


def test_a_spar_that_sticks_out_of_the_water_may_be_longer_than_it():
    (note,) = notes(mass=2.0, lowest=[0.9, 0.4, 0.0], highest=[1.1, 0.6, 3.5])
    assert note.startswith("bodies[0] weighs 2 kg and stands in 20 kg of water: ")


def test_bodies_beside_the_water_get_no_note():
    dry = {"mass": 4.0, "lowest": [2.5, 0.4, 0.0], "highest": [2.7, 0.6, 0.2]}
    assert notes(**dry) == ()
    at_the_wall = {"mass": 8.0, "lowest": [1.8, 0.8, 0.3], "highest": [2.0, 1.0, 0.5]}
    assert len(notes(**at_the_wall)) == 1
    assert notes(**at_the_wall | {"highest": [2.01, 1.0, 0.5]}) == ()


def test_a_body_far_longer_than_the_water_is_refused():
    long = {"lowest": [-50.0, 0.4, 0.4], "highest": [50.0, 0.6, 0.6]}
    with pytest.raises(SceneError) as error:
        meets(params([CUBE | {"mass": 2.0} | long]), WATER)
    assert str(error.value) == (
        "bodies[0] must have edges of at most 45.83 m, 20 times the diagonal of its partner's "
        "water of 2 x 1 x 0.5 m; found 100 x 0.2 x 0.2 m of its box. Correct lowest and highest, "
        "or the water."
    )


def test_check_says_how_a_hull_floats_and_refuses_one_in_millimetres(tmp_path, capsys, monkeypatch):
    trimesh.creation.box((200.0, 200.0, 200.0)).export(tmp_path / "block.stl")
    scene = """
    name = "block"
    end = 0.1
    window = 1e-3
    scheme = "serial"
    order = ["block", "water"]
    [components.block]
    kind = "dem_bodies"
    materials.a = { youngs_modulus = 1e9, poissons_ratio = 0.3, restitution = 0.5, friction = 0.4 }
    [[components.block.bodies]]
    shape = "mesh"
    file = "block.stl"
    scale = 0.001
    origin = [1.0, 0.5, 0.5]
    mass = 2.0
    material = "a"
    agglomerate = { dim = 4, sphere_radius = 0.025 }
    [components.water]
    kind = "sph_fluid"
    spacing = 0.05
    sound_speed = 25.0
    remove_inside_bodies = true
    fluid = [{ shape = "box", lowest = [0.0, 0.0, 0.0], highest = [2.0, 1.0, 0.5] }]
    boundary.walls = { lowest = [0.0, 0.0, 0.0], highest = [2.0, 1.0, 1.0] }
    [[links]]
    kind = "fsi"
    between = ["water", "block"]
    """
    (tmp_path / "scene.toml").write_text(scene)
    path = str(tmp_path / "scene.toml")
    sorted_heights, of = [], Heights.of
    monkeypatch.setattr(Heights, "of", lambda *args: sorted_heights.append(args) or of(*args))
    load(path)
    assert not sorted_heights  # only a check computes how bodies float
    with pytest.raises(SystemExit) as ended:
        main(["check", path])
    assert ended.value.code == 0
    note = "note of block: bodies[0] weighs 2 kg and stands in 4 kg of water: without turning, it "
    assert note in capsys.readouterr().out
    assert len(sorted_heights) == 1
    larger = [
        "--set", "components.block.bodies.0.scale=1.0",
        "--set", "components.block.bodies.0.agglomerate.sphere_radius=25.0",
    ]  # fmt: skip
    with pytest.raises(SystemExit) as ended:
        main(["check", path, *larger])
    assert ended.value.code == 2
    assert "found 200 x 200 x 200 m of block.stl at scale 1. Correct scale, " in (
        capsys.readouterr().err
    )
