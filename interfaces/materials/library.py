"""The library: materials of the files beside this one, and of a scene's own.

A material is a table: ``title``, constants, and ``sources``, which names for each citation the
constants that it gives, or "all".
"""

import tomllib
from collections.abc import Iterator, Mapping
from functools import cache
from importlib.resources import files
from typing import Any

from quintet.interfaces.params import shown, unknown

Table = dict[str, Any]
OWN_KEYS = ("title", "sources")  # of a material, beside its constants

STRENGTH, SHOCK = "flow stress of Johnson & Cook", "Hugoniot U_s(u_p)"
DAMAGE, SUTHERLAND = "strain at fracture of Johnson & Cook", "Sutherland's law"
# Constants that a material may have: unit and meaning.
CONSTANTS = {
    "density": ("kg/m3", "density"),
    "youngs_modulus": ("Pa", "Young's modulus"),
    "shear_modulus": ("Pa", "shear modulus"),
    "poissons_ratio": ("1", "Poisson's ratio"),
    "johnson_cook.a": ("Pa", f"A, {STRENGTH}"),
    "johnson_cook.b": ("Pa", f"B, {STRENGTH}"),
    "johnson_cook.n": ("1", f"n, {STRENGTH}"),
    "johnson_cook.c": ("1", f"C, {STRENGTH}"),
    "johnson_cook.m": ("1", f"m, {STRENGTH}"),
    "johnson_cook.reference_rate": ("1/s", f"reference rate, {STRENGTH}"),
    "johnson_cook.reference_temperature": ("K", f"reference temperature, {STRENGTH}"),
    "johnson_cook.melting_temperature": ("K", f"melting temperature, {STRENGTH}"),
    "mie_gruneisen.sound_speed": ("m/s", f"c, {SHOCK}"),
    "mie_gruneisen.s1": ("1", f"S₁, {SHOCK}"),
    "mie_gruneisen.s2": ("1", f"S₂, {SHOCK}"),
    "mie_gruneisen.s3": ("1", f"S₃, {SHOCK}"),
    "mie_gruneisen.gamma": ("1", "γ₀, Grüneisen's coefficient"),
    "mie_gruneisen.a": ("1", "a, change of Grüneisen's coefficient with compression"),
    "spall_stress": ("Pa", "greatest principal stress before fracture"),
    "failure_strain": ("1", "plastic strain at failure"),
    "damage.d1": ("1", f"D₁, {DAMAGE}"),
    "damage.d2": ("1", f"D₂, {DAMAGE}"),
    "damage.d3": ("1", f"D₃, {DAMAGE}"),
    "damage.d4": ("1", f"D₄, {DAMAGE}"),
    "damage.d5": ("1", f"D₅, {DAMAGE}"),
    "specific_heat": ("J/(kg K)", "specific heat"),
    "taylor_quinney": ("1", "share of plastic work that becomes heat"),
    "temperature": ("K", "temperature at the start"),
    "restitution": ("1", "restitution of two bodies of the material"),
    "friction": ("1", "friction of two bodies of the material"),
    "rolling_friction": ("1", "rolling friction of two bodies of the material"),
    "kinematic_viscosity": ("m2/s", "kinematic viscosity"),
    "gamma": ("1", "ratio of the specific heats"),
    "gas_constant": ("J/(kg K)", "specific gas constant"),
    "viscosity": ("Pa s", f"viscosity at the reference temperature, {SUTHERLAND}"),
    "reference_temperature": ("K", f"reference temperature, {SUTHERLAND}"),
    "sutherland": ("K", f"S, {SUTHERLAND}"),
    "prandtl": ("1", "Prandtl number"),
}


@cache
def library() -> Mapping[str, Table]:
    """Materials that come with quintet, by name; not to be changed."""
    materials: dict[str, Table] = {}
    for file in sorted(files(__package__).iterdir(), key=lambda file: file.name):
        if file.name.endswith(".toml"):
            materials |= tomllib.loads(file.read_text(encoding="utf-8"))
    return materials


def constants(material: Table) -> Table:
    """Return the constants of a material, nested as it states them."""
    return {key: value for key, value in material.items() if key not in OWN_KEYS}


def leaves(table: Table, above: str = "") -> Iterator[tuple[str, Any]]:
    """Yield dotted paths and values of nested tables."""
    for key, value in table.items():
        if isinstance(value, dict):
            yield from leaves(value, f"{above}{key}.")
        else:
            yield f"{above}{key}", value


def sources_of(material: Table) -> Iterator[tuple[str, str]]:
    """Yield each constant's path with its source; constants without one are left out."""
    paths = [path for path, _ in leaves(constants(material))]
    for source, paths_named in material.get("sources", {}).items():
        names = [""] if paths_named == "all" else paths_named
        for path in paths:
            if any(not name or path == name or path.startswith(f"{name}.") for name in names):
                yield path, source


def wrong_materials(materials: Any, where: str) -> list[str]:
    """Return the mistakes of materials that a scene defines."""
    if not isinstance(materials, dict):
        return [f"{where} must be tables by name; found {shown(materials)}. Write [{where}.NAME]."]
    mistakes = []
    for name, table in materials.items():
        place = f"{where}.{name}"
        if not isinstance(table, dict):
            mistakes.append(
                f"{place} must be a table of constants; found {shown(table)}. Write [{place}]."
            )
            continue
        mistakes += [
            unknown(f"{place}.{path}", path, CONSTANTS)
            for path, _ in leaves(constants(table))
            if path not in CONSTANTS
        ]
    return mistakes
