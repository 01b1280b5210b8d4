from typing import Annotated, ClassVar

from pydantic import Field

from quintet.interfaces.params import Count, NotNegative, Number, Positive, parameters, read


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
class Zone:
    low: Number = 0.0
    high: Number = 1.0

    def __post_init__(self):
        if self.low > self.high:
            raise ValueError("zones must go upwards. Exchange the ends.")
        if self.low < 0.0:
            raise ValueError("zones.low must be positive. Raise it.")
        if self.high > 9.0:
            raise ValueError("it must be short. Lower high.")


@parameters
class Named:
    zone: str | Zone = ""


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
    zones: tuple[Zone, ...] = ()


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


def test_a_rule_of_a_table_in_a_list_names_the_table():
    zones = [{}, {"low": 2.0}, {"low": -1.0}, {"high": 10.0}]
    _, wrong = read(Fluid, {"youngs_modulus": 1.0, "zones": zones}, "components.water")
    assert wrong == [
        "components.water.zones.1 must go upwards. Exchange the ends.",
        "components.water.zones.2.low must be positive. Raise it.",
        "components.water.zones.3: it must be short. Lower high.",
    ]


@parameters
class Filled:
    bodies: Annotated[tuple[Body, ...], Field(min_length=1)]


def test_an_empty_list_is_answered_in_plain_words():
    _, wrong = read(Filled, {"bodies": []}, "pile")
    assert wrong == ["pile.bodies should have at least 1 item; found []. Correct it."]


def test_of_a_table_in_the_place_of_a_text_only_its_mistakes_are_named():
    _, wrong = read(Named, {"zone": {"low": "x"}}, "scene")
    assert [mistake.split(";")[0] for mistake in wrong] == [
        "scene.zone.low should be a valid number"
    ]
    _, wrong = read(Named, {"zone": 5}, "scene")
    assert len(wrong) == 1 and wrong[0].startswith("scene.zone should be a valid string or ")


def test_a_quoted_number_with_a_decimal_comma_is_told_how_to_be_written():
    _, wrong = read(Fluid, {"youngs_modulus": "3,5 MPa"}, "water")
    assert wrong == [
        "water.youngs_modulus should be a valid number; found '3,5 MPa'. Write it without quotes, "
        'or, if its key has a unit, with a decimal point and a unit, as in "2.5 mm".'
    ]
