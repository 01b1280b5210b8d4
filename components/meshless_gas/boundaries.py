"""What a scene says about a gas, its states, and what is at its boundaries."""

import math
from collections.abc import Collection, Mapping
from typing import Annotated, ClassVar, Literal

from pydantic import Field

from quintet.interfaces.materials.filling import MaterialName
from quintet.interfaces.params import NotNegative, Positive, Vector, parameters

NO_SLIP = ("isothermal", "adiabatic")  # walls that hold the gas
NO_SLIP_KEYS = {"velocity", "accommodation"}  # what both may be given


@parameters
class Gas:
    """A perfect gas; air if nothing is given.

    Parameters
    ----------
    material
        Name of a material, which gives the constants that are not set here.
    gamma : 1
        Ratio of the specific heats.
    gas_constant : J/(kg K)
        p = ρ R T.
    viscosity : Pa s
        At the reference temperature.
    reference_temperature : K
        Of the viscosity.
    sutherland : K
        Sutherland's constant, by which the viscosity rises with the temperature; with 0 it rises as
        the root of it.
    prandtl : 1
        c_p μ/λ.
    """

    MATERIAL: ClassVar = {
        key: key
        for key in (
            "gamma", "gas_constant", "viscosity", "reference_temperature", "sutherland", "prandtl"
        )
    }  # fmt: skip
    material: MaterialName | None = None
    gamma: Annotated[float, Field(gt=1, allow_inf_nan=False)] = 1.4
    gas_constant: Positive = 287.05
    viscosity: Positive = 1.78e-5
    reference_temperature: Positive = 273.15
    sutherland: NotNegative = 110.4
    prandtl: Positive = 0.72


@parameters
class GasState:
    """A state of the gas.

    Parameters
    ----------
    density : kg/m3
        This or the temperature.
    temperature : K
        This or the density.
    velocity : m/s
        In two dimensions along x and z.
    pressure : Pa
        Of nothing it would have no temperature.
    """

    density: Positive | None = None
    temperature: Positive | None = None
    velocity: Vector = (0.0, 0.0, 0.0)
    pressure: Positive

    def __post_init__(self) -> None:
        if (self.density is None) == (self.temperature is None):
            raise ValueError("a state of the gas needs density or temperature, one of them.")

    def primitive(self, gas: Gas) -> tuple[float, float, float, float, float]:
        """Density, velocity and pressure."""
        density = self.density
        if density is None:
            assert self.temperature is not None
            density = self.pressure / (gas.gas_constant * self.temperature)
        return density, *self.velocity, self.pressure

    def mach(self, gas: Gas) -> float:
        """Mach number."""
        density, u, v, w, pressure = self.primitive(gas)
        return math.hypot(u, v, w) / math.sqrt(gas.gamma * pressure / density)

    def fastest(self, gas: Gas) -> float:
        """Speed [m/s] of its fastest wave."""
        density, u, v, w, pressure = self.primitive(gas)
        return math.hypot(u, v, w) + math.sqrt(gas.gamma * pressure / density)


@parameters
class TotalState:
    """Gas at rest, from which an inflow comes without losses.

    Parameters
    ----------
    pressure : Pa
        At rest.
    temperature : K
        At rest.
    direction : 1
        Of the flow; of any length above 0.
    """

    pressure: Positive
    temperature: Positive
    direction: Vector = (1.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        if not any(self.direction):
            raise ValueError("total: direction must not be 0. Say where the gas flows.")


@parameters
class Accommodation:
    """How molecules leave a wall, where the gas is rarefied.

    Parameters
    ----------
    momentum : 1
        Share of them that leave it in any direction, the others as from a mirror: σ of Maxwell.
    energy : 1
        Share of what their energy differs from that of the wall which they leave there: α of
        Smoluchowski.
    """

    momentum: Annotated[float, Field(gt=0, le=1, allow_inf_nan=False)] = 1.0
    energy: Annotated[float, Field(gt=0, le=1, allow_inf_nan=False)] = 1.0


@parameters
class Boundary:
    """What is at a part of the boundary.

    Parameters
    ----------
    kind
        "periodic" and "symmetry" have images of what is within beyond them, those of a sphere's
        wall in its tangent planes; a "slip" wall lets the gas pass along it, an "isothermal" or
        "adiabatic" one holds it; "inflow" has the state that is given, "outflow" that of the gas
        which leaves.
    state
        Of an inflow: of the gas beyond it. Where that comes in faster than sound the boundary has
        this state; where it is slower waves leave, by the Riemann problem of both gases.
    total
        Of an inflow, in place of the state: it then has the pressure of the gas that it meets.
    pressure : Pa
        Beyond an outflow, where it is slower than sound; if not given nothing comes from there.
    temperature : K
        Of an isothermal wall.
    velocity : m/s
        Of an isothermal or adiabatic wall, along itself.
    accommodation
        Of an isothermal or adiabatic wall: the gas then slips along it by its mean free path and
        its temperature jumps there; if not said both are the wall's.
    """

    kind: Literal["periodic", "symmetry", "slip", "isothermal", "adiabatic", "inflow", "outflow"]
    state: GasState | None = None
    total: TotalState | None = None
    pressure: Positive | None = None
    temperature: Positive | None = None
    velocity: Vector | None = None
    accommodation: Accommodation | None = None

    def __post_init__(self) -> None:
        names = ("state", "total", "pressure", "temperature", "velocity", "accommodation")
        keys = [key for key in names if getattr(self, key) is not None]
        wrong = {
            "inflow": keys not in (["state"], ["total"]),
            "outflow": bool(set(keys) - {"pressure"}),
            "isothermal": bool(set(keys) - {"temperature", *NO_SLIP_KEYS}) or not self.temperature,
            "adiabatic": bool(set(keys) - NO_SLIP_KEYS),
        }
        if wrong.get(self.kind, bool(keys)):
            need = {
                "inflow": "state or total",
                "outflow": "pressure or nothing",
                "isothermal": "temperature, and velocity and accommodation or not",
                "adiabatic": "velocity, accommodation or nothing",
            }
            raise ValueError(
                f"a boundary of kind {self.kind} takes {need.get(self.kind, 'nothing')}; found "
                f"{' and '.join(keys) or 'nothing'}. Correct it."
            )


def unknown_boundaries(boundaries: Collection[str], names: Collection[str]) -> list[str]:
    """Which boundaries are none of those that a cloud has."""
    return [
        f"boundaries.{name} is not known. Known here: {', '.join(names)}."
        for name in boundaries
        if name not in names
    ]


def wrong_round_layers(
    boundaries: Mapping[str, Boundary], names: Collection[str], is_sphere: bool
) -> list[str]:
    """What does not fit among the boundaries of a cloud in layers, which has all of some names."""
    lacking = [
        f"boundaries.{name} must be given. Say what is there."
        for name in names
        if name not in boundaries
    ]
    unfit = [
        f"boundaries.{name} of a cloud in layers cannot be {boundary.kind}. Take a wall or a flow."
        for name, boundary in boundaries.items()
        if boundary.kind == "periodic"
        or (boundary.kind == "symmetry" and (name != "wall" or not is_sphere))
    ]
    return unknown_boundaries(boundaries, names) + lacking + unfit
