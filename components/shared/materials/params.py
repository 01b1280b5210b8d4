"""What a scene says about a material that yields, is shocked, and breaks."""

import math
from typing import Annotated, Any, ClassVar

from pydantic import AfterValidator, Field
from pydantic_core import PydanticCustomError

from quintet.interfaces.materials.filling import MaterialName as UnfilledName
from quintet.interfaces.materials.filling import fitting
from quintet.interfaces.materials.library import constants, library
from quintet.interfaces.params import Fraction, NotNegative, Number, Positive, parameters

# A material of the library has some of these, by the names of the keys.
CONSTANTS = (
    "density", "youngs_modulus", "shear_modulus", "poissons_ratio", "johnson_cook",
    "mie_gruneisen", "spall_stress", "failure_strain", "damage", "specific_heat",
    "taylor_quinney", "temperature",
)  # fmt: skip
# Incompressible ones would need an infinite bulk modulus.
Poisson = Annotated[float, Field(ge=0, lt=0.5, allow_inf_nan=False)]


@parameters
class JohnsonCook:
    """Flow stress of Johnson & Cook (1983): (A + B ε_pⁿ)(1 + C ln ε̇*)(1 - T*ᵐ).

    Parameters
    ----------
    a : Pa
        A, the yield stress at rest.
    b : Pa
        B, of hardening.
    n : 1
        Exponent of hardening.
    c : 1
        C, of the rate of strain.
    m : 1
        Exponent of thermal softening.
    reference_rate : 1/s
        Rate of plastic strain below which C has no part: ε̇* is the rate over it.
    reference_temperature : K
        At which there is no softening.
    melting_temperature : K
        At which there is no strength.
    """

    a: NotNegative
    b: NotNegative = 0.0
    n: Positive = 1.0
    c: NotNegative = 0.0
    m: Positive = 1.0
    reference_rate: Positive = 1.0
    reference_temperature: Positive = 298.0
    melting_temperature: Positive = 1e9

    def __post_init__(self) -> None:
        if self.melting_temperature <= self.reference_temperature:
            raise ValueError(
                "johnson_cook: melting_temperature must be above reference_temperature; found "
                f"{self.melting_temperature:g} and {self.reference_temperature:g} K."
            )


@parameters
class MieGruneisen:
    """Equation of state after Mie and Grüneisen, about the Hugoniot U_s = c + S₁u_p (+ …).

    As of LS-DYNA's EOS 4 (Steinberg 1996): in tension p = ρ₀c²μ + (γ₀ + aμ) ρ₀e.

    Parameters
    ----------
    sound_speed : m/s
        c, where the line U_s(u_p) begins.
    s1, s2, s3 : 1
        Its slope, and coefficients of (u_p/U_s) u_p and (u_p/U_s)² u_p.
    gamma : 1
        γ₀, Grüneisen's coefficient; γρ is constant without `a`.
    a : 1
        Its first-order correction with μ.
    """

    sound_speed: Positive
    s1: NotNegative = 0.0
    s2: Number = 0.0
    s3: Number = 0.0
    gamma: NotNegative = 0.0
    a: NotNegative = 0.0


@parameters
class JohnsonCookDamage:
    """Strain at fracture of Johnson & Cook (1985).

    ε_f = (D₁ + D₂ exp(D₃ σ*)) (1 + D₄ ln ε̇*) (1 + D₅ T*), where σ* is the mean tension over
    the equivalent stress; damage grows as ∫ dε_p/ε_f, and at 1 the material has failed. D₁ may be
    below 0, as of 6061-T6 (Lesuer, Kay & LeBlanc 2001: -0.77, 1.45, -0.47, 0, 1.6); where ε_f would
    be no more than 1e-6, any plastic strain breaks the material. In uniaxial tension, σ* = 1/3, ε_f
    must be above 0.

    Parameters
    ----------
    d1, d2, d3, d4, d5 : 1
        D₁ to D₅.
    """

    d1: Number
    d2: NotNegative = 0.0
    d3: Number = 0.0
    d4: Number = 0.0
    d5: Number = 0.0

    def __post_init__(self) -> None:
        strain = self.d1 + self.d2 * math.exp(min(self.d3 / 3.0, 600.0))
        # With neither D₁ nor D₂ there is no damage.
        if strain <= 0.0 and (self.d1 != 0.0 or self.d2 != 0.0):
            raise ValueError(
                "damage: the strain at fracture in uniaxial tension, d1 + d2 exp(d3/3), must be "
                f"above 0; found {strain:.4g}. Correct d1, d2 or d3."
            )


@parameters
class Material:
    """An isotropic solid: elastic, and if told so plastic, compressible by shocks, and brittle.

    Of `youngs_modulus` and `shear_modulus` one is given. With an equation of state the bulk modulus
    is its ρc², and Poisson's ratio only gives the shear modulus from Young's.

    Parameters
    ----------
    material
        Name of a material, which gives the constants that are not set here.
    density : kg/m3
        ρ₀, unstressed.
    youngs_modulus : Pa
        E, with `poissons_ratio`.
    shear_modulus : Pa
        G.
    poissons_ratio : 1
        ν.
    johnson_cook
        Its flow stress; elastic without.
    mie_gruneisen
        Its equation of state; p = K μ without.
    spall_stress : Pa
        Greatest principal stress that it bears; beyond it bears neither shear nor tension.
    failure_strain : 1
        Plastic strain at which it has failed.
    damage
        Johnson and Cook's damage, by which it fails.
    specific_heat : J/(kg K)
        Of its temperature.
    taylor_quinney : 1
        Share of plastic work that heats a material without equation of state.
    temperature : K
        At the start.
    """

    MATERIAL: ClassVar = {key: key for key in CONSTANTS}
    INSTEAD_OF: ClassVar = {
        "youngs_modulus": "shear_modulus", "shear_modulus": "youngs_modulus"
    }  # fmt: skip
    material: UnfilledName | None = None
    density: Positive
    youngs_modulus: Positive | None = None
    shear_modulus: Positive | None = None
    poissons_ratio: Poisson | None = None
    johnson_cook: JohnsonCook | None = None
    mie_gruneisen: MieGruneisen | None = None
    spall_stress: Positive | None = None
    failure_strain: Positive | None = None
    damage: JohnsonCookDamage | None = None
    specific_heat: Positive | None = None
    taylor_quinney: Fraction = 0.9
    temperature: Positive = 298.0

    def __post_init__(self) -> None:
        for is_wrong, sentence in (
            (
                (self.youngs_modulus is None) == (self.shear_modulus is None),
                "one of youngs_modulus and shear_modulus must be given.",
            ),
            (
                self.youngs_modulus is not None and self.poissons_ratio is None,
                "with youngs_modulus poissons_ratio is needed.",
            ),
            (
                self.poissons_ratio is None and self.mie_gruneisen is None,
                "poissons_ratio or mie_gruneisen is needed: nothing tells its bulk modulus.",
            ),
            (
                self.damage is not None and self.johnson_cook is None,
                "damage grows with plastic strain; give johnson_cook too.",
            ),
            (
                self.failure_strain is not None and self.johnson_cook is None,
                "failure_strain is of plastic strain; give johnson_cook too.",
            ),
            (
                self._softens and self.specific_heat is None,
                "it softens with temperature; give specific_heat.",
            ),
        ):
            if is_wrong:
                raise ValueError(f"material: {sentence}")

    @property
    def _softens(self) -> bool:
        return self.johnson_cook is not None and self.johnson_cook.melting_temperature < 1e9

    @property
    def shear(self) -> float:
        """Shear modulus G [Pa]."""
        if self.shear_modulus is not None:
            return self.shear_modulus
        assert self.youngs_modulus is not None and self.poissons_ratio is not None
        return self.youngs_modulus / (2.0 * (1.0 + self.poissons_ratio))

    @property
    def bulk(self) -> float:
        """Bulk modulus K [Pa] at rest."""
        if self.mie_gruneisen is not None:
            return self.density * self.mie_gruneisen.sound_speed**2
        assert self.poissons_ratio is not None
        ν = self.poissons_ratio
        return 2.0 * self.shear * (1.0 + ν) / (3.0 * (1.0 - 2.0 * ν))


def _material_name(name: str) -> str:
    """Return the name of a material of the library."""
    if name not in (names := fitting(Material, library())):
        raise PydanticCustomError(
            "material", f"Input should be a material of the library ({', '.join(names)})"
        )
    return name


MaterialName = Annotated[str, AfterValidator(_material_name)]


def material(described: "Material | str") -> Material:
    """Return a material that a scene describes, or names from the library."""
    if isinstance(described, Material):
        return described
    return _from_table(constants(library()[described]))


def _from_table(table: dict[str, Any]) -> Material:
    parts = {
        "johnson_cook": JohnsonCook,
        "mie_gruneisen": MieGruneisen,
        "damage": JohnsonCookDamage,
    }
    known = {key: parts[key](**value) if key in parts else value for key, value in table.items()}
    return Material(**known)
