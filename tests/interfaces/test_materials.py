"""The library of materials: each constant has a source and can be used; tables are filled."""

import math
import re
from typing import ClassVar

import pytest

from quintet.interfaces.keys import keys
from quintet.interfaces.manifest import find, known_kinds
from quintet.interfaces.materials.filling import MaterialName, fill, fitting, places
from quintet.interfaces.materials.library import (
    CONSTANTS,
    constants,
    leaves,
    library,
    sources_of,
    wrong_materials,
)
from quintet.interfaces.params import Positive, parameters, read

NAMES = sorted(library())
UNDATED = "Pantalé, DynELA"  # samples of a program
PLACES = [
    (kind, path, params)
    for kind in sorted(known_kinds())
    for path, params in places(find(kind).params)
]


@pytest.mark.parametrize("name", NAMES)
def test_every_constant_has_one_dated_source_and_is_known(name):
    material = library()[name]
    paths = [path for path, _ in leaves(constants(material))]
    assert sorted(path for path, _ in sources_of(material)) == sorted(paths)
    assert set(paths) <= set(CONSTANTS)
    for source in material["sources"]:
        assert re.search(r"\((19|20)\d\d\)", source) or source.startswith(UNDATED)
    assert material["title"]


@pytest.mark.parametrize("name", NAMES)
def test_every_constant_of_the_library_is_taken_by_some_kind(name):
    takers = [params for _, _, params in PLACES if name in fitting(params, library())]
    used = {constant for params in takers for constant in params.MATERIAL.values()}
    assert takers
    assert set(constants(library()[name])) - used == set()


@pytest.mark.parametrize(("kind", "path", "params"), PLACES, ids=lambda part: str(part))
def test_every_fitting_material_fills_a_table_that_can_be_read(kind, path, params):
    names = fitting(params, library())
    assert names
    for name in names:
        table, mistakes = fill(params, {"material": name}, kind, library())
        assert mistakes == []
        _, wrong = read(params, table, kind)
        # Constants that the material lacks, as its friction, the scene must add.
        assert [mistake for mistake in wrong if "is needed. Add" not in mistake] == []


def test_units_are_those_of_the_keys_that_take_the_constants():
    units = {}
    for _, _, params in PLACES:
        units |= dict(_units(params))
    constant_units = {path: unit for path, (unit, _) in CONSTANTS.items()}
    assert {path: constant_units[path] for path in units} == units
    assert set(units) == set(CONSTANTS)


def _units(params):
    """Yield the constants that a class takes, with the units of its keys."""
    for path, constant in params.MATERIAL.items():
        table_class = params
        for part in path.split("."):
            (key,) = (key for key in keys(table_class) if key.name == part)
            table_class = key.inner
        if table_class is None:
            yield constant, key.unit
        else:
            yield from ((f"{constant}.{inner.name}", inner.unit) for inner in keys(table_class))


@pytest.mark.parametrize(
    "name", [name for name in NAMES if {"shear_modulus", "mie_gruneisen"} <= set(library()[name])]
)
def test_shear_and_bulk_moduli_of_two_sources_give_a_poissons_ratio_of_a_solid(name):
    material = library()[name]
    bulk = material["density"] * material["mie_gruneisen"]["sound_speed"] ** 2
    shear = material["shear_modulus"]
    ratio = (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear))
    assert 0.25 < ratio < 0.37


def test_water_has_the_density_and_viscosity_of_its_formulas():
    # Tanaka et al. (2001), equation 1; IAPWS R12-08, table 8 and section 3.1, at 20 °C.
    density = 999.974950 * (1 - (20 - 3.983035) ** 2 * (20 + 301.797) / 522528.9 / (20 + 69.34881))
    terms = zip((280.68, 511.45, 61.131, 0.45903), (-1.9, -7.7, -19.6, -40.0), strict=True)
    viscosity = 1e-6 * sum(a * (293.15 / 300.0) ** b for a, b in terms)
    water = library()["water"]
    assert water["density"] == pytest.approx(density, rel=1e-7)
    assert water["kinematic_viscosity"] == pytest.approx(viscosity / density, rel=1e-5)


def test_glycerine_and_sea_water_have_the_numbers_of_their_formulas():
    glycerine, sea = library()["glycerine"], library()["sea-water"]
    density = 1277.0 - 0.654 * 20.0  # Cheng (2008)
    viscosity = 12.1 * math.exp((20.0 - 1233.0) * 20.0 / (9900.0 + 70.0 * 20.0))
    assert glycerine["density"] == pytest.approx(density)
    assert glycerine["kinematic_viscosity"] == pytest.approx(viscosity / density, rel=1e-5)
    pure = 4.2844e-5 + 1.0 / (0.157 * (20.0 + 64.993) ** 2 - 91.296)  # Sharqawy et al. (2010)
    a = 1.541 + 1.998e-2 * 20.0 - 9.52e-5 * 400.0
    b = 7.974 - 7.561e-2 * 20.0 + 4.724e-4 * 400.0
    salty = pure * (1.0 + a * 0.035 + b * 0.035**2)
    assert sea["kinematic_viscosity"] == pytest.approx(salty / sea["density"], rel=1e-5)


@pytest.mark.parametrize(
    ("name", "mass"), [("nitrogen", 28.0134), ("argon", 39.948), ("carbon-dioxide", 44.0095)]
)
def test_gases_have_the_constants_of_their_molecules(name, mass):
    gas = library()[name]
    assert gas["gas_constant"] == pytest.approx(8314.462618 / mass, rel=3e-6)
    eucken = 4.0 * gas["gamma"] / (9.0 * gas["gamma"] - 5.0)
    assert gas["prandtl"] == pytest.approx(eucken, abs=2e-4)


def test_air_is_that_of_the_standard_atmosphere():
    air, temperature = library()["air"], 288.15
    viscosity = 1.458e-6 * temperature**1.5 / (temperature + 110.4)
    ratio = (temperature / air["reference_temperature"]) ** 1.5
    ratio *= (air["reference_temperature"] + air["sutherland"]) / (temperature + air["sutherland"])
    assert air["viscosity"] * ratio == pytest.approx(viscosity, rel=1e-4)
    conductivity = (
        2.64638e-3 * temperature**1.5 / (temperature + 245.4 * 10.0 ** (-12.0 / temperature))
    )
    heat = 3.5 * air["gas_constant"]
    assert air["prandtl"] == pytest.approx(viscosity * heat / conductivity, abs=1e-3)


@parameters
class Oil:
    """Oil.

    Parameters
    ----------
    thickness : Pa s
        How thick it is.
    """

    thickness: Positive = 1.0


@parameters
class Bath:
    """A bath.

    Parameters
    ----------
    material
        Its name.
    density : kg/m3
        Of the oil.
    oil
        What is in it.
    """

    MATERIAL: ClassVar = {"density": "density", "oil.thickness": "viscosity"}
    material: MaterialName | None = None
    density: Positive
    oil: Oil = Oil()


@parameters
class Room:
    """A room.

    Parameters
    ----------
    baths
        In a row.
    tubs
        By name.
    """

    baths: tuple[Bath, ...] = ()
    tubs: dict[str, Bath] | None = None


STOCK = {"olive": {"density": 910.0, "viscosity": 0.08}, "lead": {"density": 11340.0}}


def test_keys_of_the_table_go_before_those_of_the_material():
    table = {
        "baths": ["olive", {"material": "olive", "density": 900.0}],
        "tubs": {"material": "olive", "b": {"material": "olive", "oil": {"thickness": 2.0}}},
    }
    filled, mistakes = fill(Room, table, "room", STOCK)
    assert mistakes == []
    assert filled == {
        "baths": [
            {"density": 910.0, "oil": {"thickness": 0.08}},
            {"density": 900.0, "oil": {"thickness": 0.08}},
        ],
        "tubs": {
            "material": {"density": 910.0, "oil": {"thickness": 0.08}},
            "b": {"density": 910.0, "oil": {"thickness": 2.0}},
        },
    }
    assert table["baths"][0] == "olive"


WRONG = {
    "oliv": "room.baths.0.material oliv is not known. Did you mean olive? `quintet materials`",
    "xyzzy": "room.baths.0.material xyzzy is not known. Known here: olive. `quintet materials`",
    "lead": "room.baths.0.material must be one with constants for this table: olive; found lead",
}


@pytest.mark.parametrize("name", WRONG)
def test_names_that_are_unknown_or_do_not_fit_are_refused(name):
    _, mistakes = fill(Room, {"baths": [name]}, "room", STOCK)
    assert len(mistakes) == 1
    assert mistakes[0].startswith(WRONG[name])


def test_a_name_that_is_no_text_is_refused():
    _, mistakes = fill(Bath, {"material": 3}, "bath", STOCK)
    assert mistakes[0].startswith("bath.material must be the name of a material; found 3.")


def test_of_keys_that_exclude_each_other_the_given_one_stays():
    (solid,) = {params for _, path, params in PLACES if path == "bodies.0.material"}
    filled, _ = fill(solid, {"material": "42CrMo4", "shear_modulus": 7e10}, "solid", library())
    assert "youngs_modulus" not in filled
    assert filled["shear_modulus"] == 7e10
    part, _ = fill(solid, {"material": "steel", "johnson_cook": {"a": 1.0}}, "solid", library())
    assert (part["johnson_cook"]["a"], part["johnson_cook"]["b"]) == (1.0, 275e6)


def test_a_name_that_nobody_filled_in_is_refused():
    _, mistakes = read(Bath, {"material": "olive", "density": 1.0}, "bath")
    assert "material olive: material names work only in scene files" in mistakes[0]


def test_own_materials_have_known_constants():
    assert wrong_materials({"a": {"density": "1 g/cm3", "title": "A"}}, "materials") == []
    assert wrong_materials({"a": {"densty": 1.0}}, "materials") == [
        "materials.a.densty is not known. Did you mean density?"
    ]
    assert wrong_materials({"a": 3}, "mine.toml")[0].startswith("mine.toml.a must be a table")
    assert wrong_materials([], "materials")[0].startswith("materials must be tables by name")
