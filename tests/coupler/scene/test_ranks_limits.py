"""What a component cannot share out among its ranks is refused before anything runs."""

import pytest

from quintet.coupler.scene.read import load
from quintet.interfaces.errors import SceneError

FACES = {
    "bars_in_contact": ("left", "a structure"),
    "rod_on_plate": ("rod", "a solid"),
    "sphere_on_plate": ("sphere", "bodies"),
}
SCENES = [(scene, *words) for scene, words in FACES.items()]


@pytest.mark.parametrize(("scene", "name", "what"), SCENES)
def test_contact_with_faces_is_refused_on_several_ranks(scene, name, what):
    sentence = (
        f"components.{name}: contact_with_faces must be false of {what} on 2 ranks; it is true. "
        "Take one rank and several threads."
    )
    with pytest.raises(SceneError) as refusal:
        load(scene, transport="zenoh", settings=[f"components.{name}.ranks=2"])
    assert sentence in str(refusal.value)


def test_an_open_channel_is_refused_on_several_ranks():
    sentence = r"components\.water: boundary\.inflow must be empty of a fluid on 2 ranks; found 1"
    with pytest.raises(SceneError, match=sentence):
        load("open_channel", transport="zenoh", settings=["components.water.ranks=2"])


def test_the_other_side_of_a_contact_may_have_several_ranks():
    settings = ["components.plate.ranks=2"]
    assert (
        load("sphere_on_plate", transport="zenoh", settings=settings).components["plate"].ranks == 2
    )


def test_bodies_without_free_spheres_are_refused_on_several_ranks():
    sentence = r"components\.cubes: ranks must be 1 where no body is a single sphere"
    with pytest.raises(SceneError, match=sentence):
        load("dam_break_cubes", transport="zenoh", settings=["components.cubes.ranks=2"])
