from typing import ClassVar

from quintet.interfaces.params import Count, NotNegative, Positive, parameters, read


@parameters
class Viscosity:
    RENAMED: ClassVar = {"alpha": "artificial"}
    artificial: NotNegative = 0.1
    kinematic: NotNegative = 0.0


@parameters
class Body:
    RENAMED: ClassVar = {"apart": "spacing"}
    spacing: Positive
    copies: Count = 1


@parameters
class Fluid:
    RENAMED: ClassVar = {
        "viscosity": "viscosity.artificial",  # now a table of that name
        "laminar": "viscosity.kinematic",
        "young": "youngs_modulus",
    }
    youngs_modulus: Positive
    viscosity: Viscosity = Viscosity()
    bodies: tuple[Body, ...] = ()


def test_an_old_key_is_answered_with_the_new_one():
    params, wrong = read(Fluid, {"youngs_modulus": 1.0, "laminar": 1e-6}, "components.water")
    assert params is None
    assert wrong == ["components.water.laminar is now viscosity.kinematic. Rename it."]


def test_an_old_key_that_is_a_table_now_is_answered_too():
    _, wrong = read(Fluid, {"youngs_modulus": 1.0, "viscosity": 0.2}, "components.water")
    assert wrong == ["components.water.viscosity is now viscosity.artificial. Rename it."]


def test_old_keys_inside_tables_and_lists_are_answered():
    table = {"youngs_modulus": 1.0, "viscosity": {"alpha": 0.1}, "bodies": [{"apart": 1.0}]}
    _, wrong = read(Fluid, table, "water")
    assert wrong == [
        "water.viscosity.alpha is now artificial. Rename it.",
        "water.bodies.0.apart is now spacing. Rename it.",
    ]


def test_a_needed_key_given_under_its_old_name_is_not_missing():
    _, wrong = read(Fluid, {"young": 1.0}, "water")
    assert wrong == ["water.young is now youngs_modulus. Rename it."]


def test_new_keys_are_taken_and_their_mistakes_told_as_ever():
    params, wrong = read(Fluid, {"youngs_modulus": 1.0, "viscosity": {"artificial": 0.3}}, "water")
    assert not wrong and params.viscosity.artificial == 0.3 and params.viscosity.kinematic == 0.0
    _, wrong = read(Fluid, {"youngs_modulus": 1.0, "viscosity": {"artifical": -1.0}}, "water")
    assert wrong == ["water.viscosity.artifical is not known. Did you mean artificial?"]
    _, wrong = read(Fluid, {"viscosity": {"artificial": -1.0}}, "water")
    assert wrong == [
        "water.youngs_modulus is needed. Add youngs_modulus to it.",
        "water.viscosity.artificial should be greater than or equal to 0; found -1.0. Correct it.",
    ]
