"""What a check says of how bodies float in the water of a partner."""

import numpy as np
import pytest
import trimesh
from dem_scenes import params

from quintet.components.dem_bodies.plan import meeting_notes, meets
from quintet.components.shared.geometry.displacement import Heights
from quintet.coupler.cli import main
from quintet.coupler.scene.joins import partner_notes
from quintet.coupler.scene.read import load
from quintet.interfaces.errors import SceneError

WATER = {
    "water_lowest": np.array([[0.0, 0.0, 0.0]]),
    "water_highest": np.array([[2.0, 1.0, 0.5]]),
    "water_density": np.array([1000.0]),
}
CUBE = {"shape": "box", "lowest": [0.9, 0.4, 0.4], "highest": [1.1, 0.6, 0.6], "material": "a"}
ALONE = "without turning or other forces, it"
REMEDY = ". If it is to float at rest, correct its height, mass, scale or orientation."


def notes(water=WATER, **body):
    return meeting_notes(params([CUBE | body]), water)


@pytest.mark.parametrize(
    ("body", "text"),
    [
        ({"mass": 4.0}, f"stands in 4 kg of water: {ALONE} floats where it is"),
        # 0.02 m deeper, but for the 0.0004 m by which 0.8 kg raise a level of 2 m2.
        ({"mass": 4.8}, f"stands in 4 kg of water: {ALONE} floats 0.02 m lower"),
        (
            {"mass": 2.0},
            f"stands in 4 kg of water: {ALONE} floats 0.049 m higher{REMEDY}",
        ),
        ({"mass": 8.5}, f"stands in 4 kg of water: it displaces at most 8 kg and sinks{REMEDY}"),
        (
            {"mass": 4.0, "lowest": [0.9, 0.4, 0.6], "highest": [1.1, 0.6, 0.8]},
            f"begins 0.1 m above the water: {ALONE} floats 0.2 m lower{REMEDY}",
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


def test_a_body_that_cannot_float_in_shallow_water_rests_on_the_bottom():
    # Afloat it would draw 0.9 m of the 0.5 m of water.
    cube = {"lowest": [0.0, 0.0, 0.0], "highest": [1.0, 1.0, 1.0]}
    wide = WATER | {"water_highest": np.array([[4.0, 4.0, 0.5]])}
    assert notes(wide, mass=900.0, **cube) == (
        "bodies[0] weighs 900 kg and stands in 500 kg of water: without turning or other forces, "
        f"it rests on the bottom{REMEDY}",
    )
    # In a tank of 2 m2 the level rises by 0.3 m.
    (note,) = notes(mass=600.0, lowest=[0.0, 0.0, 0.5], highest=[1.0, 1.0, 1.5])
    assert note.endswith(f"it floats 0.3 m lower{REMEDY}")


def test_the_level_follows_all_bodies():
    tub = WATER | {"water_highest": np.array([[0.8, 0.5, 0.5]])}
    low = [{"lowest": [x, 0.1, 0.4], "highest": [x + 0.2, 0.3, 0.6]} for x in (0.0, 0.3, 0.6)]
    heavy, light = {"mass": 4.8}, {"mass": 3.2}
    # 0.8 kg more and less than what they stand in: the level stays, and each moves by 0.02 m.
    pair = params([CUBE | low[0] | heavy, CUBE | low[1] | light])
    assert meeting_notes(pair, tub) == (
        "bodies[0] weighs 4.8 kg and stands in 4 kg of water: without turning or other forces, it "
        "floats 0.02 m lower",
        "bodies[1] weighs 3.2 kg and stands in 4 kg of water: without turning or other forces, it "
        "floats 0.02 m higher",
    )
    # Each of three raises the level by 0.002 m.
    three = params([CUBE | body | heavy for body in low])
    assert meeting_notes(three, tub) == (
        "each of bodies[0, 1, 2] weighs 4.8 kg and stands in 4 kg of water: without turning or "
        "other forces, it floats 0.014 m lower",
    )


def test_copies_get_one_sentence_and_balls_beside_a_body_leave_its_rest_open():
    copies = {"number": [3, 1, 1], "spacing": [0.3, 0.3, 0.3]}
    (note,) = notes(mass=4.0, copies=copies)
    assert note.startswith("each of bodies[0, 1, 2] weighs 4 kg and stands in 4 kg of water: ")
    ball = {"shape": "sphere", "centre": [0.3, 0.5, 0.5], "radius": 0.1, "mass": 2.0}
    both = params([CUBE | {"mass": 4.8}, ball | {"material": "a"}])
    assert meeting_notes(both, WATER) == ("bodies[0] weighs 4.8 kg and stands in 4 kg of water",)


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
    note = f"note of block: bodies[0] weighs 2 kg and stands in 4 kg of water: {ALONE} "
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


def test_a_body_that_two_links_join_to_its_water_gets_one_note():
    scene = load("floating_hull", preset="quick")
    once, twice = (
        partner_notes(scene.components, links) for links in (scene.links, 2 * scene.links)
    )
    assert once == twice and len(once["hull"]) == 1
