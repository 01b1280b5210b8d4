"""Parameters of spheres in free flight."""

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from quintet.interfaces.params import (
    Count,
    Fraction,
    NotNegative,
    Number,
    Positive,
    PositiveVector,
    Vector,
    parameters,
)


@parameters
class Copies:
    """A lattice of equal spheres, numbered in its order, x slowest.

    Parameters
    ----------
    number : 1
        How many along x, y and z.
    spacing : m
        From one copy to the next.
    interval : s
        From the launch of one copy to that of the next.
    """

    number: tuple[Count, Count, Count]
    spacing: PositiveVector
    interval: NotNegative = 0.0


@parameters
class Sphere:
    """A rigid sphere, or a lattice of equal ones.

    Parameters
    ----------
    shape
        Name of the shape.
    centre : m
        At the start.
    radius : m
        Of the sphere. A body with nodes in a gas must not be larger; if it strikes others, its
        sphere must be larger, so that two layers of nodes fit between them.
    density : kg/m3
        Of its material. The mass is that of a sphere. For a cylinder 1 m long in a gas of two
        dimensions give 0.75 m/r of the cylinder's density; r is the radius of both.
    velocity : m/s
        With which it is launched.
    angular_velocity : rad/s
        With which it is launched.
    launch : s
        When it is launched. Until then it rests, whatever acts on it, and is absent for a gas that
        is coarser than it.
    temperature : K
        At the start, the same throughout.
    specific_heat : J/(kg K)
        Of its temperature.
    tether : N/m
        Of a spring that pulls it back to where it started.
    parcel : 1
        Number of equal spheres that it represents; mass, loads and heat are their totals.
    copies
        A lattice of such spheres, the first at `centre`.
    """

    RENAMED: ClassVar = {"position": "centre", "diameter": "radius, half of it"}
    shape: Literal["sphere"] = "sphere"
    centre: Vector
    radius: Positive
    density: Positive
    velocity: Vector = (0.0, 0.0, 0.0)
    angular_velocity: Vector = (0.0, 0.0, 0.0)
    launch: NotNegative = 0.0
    temperature: Positive = 300.0
    specific_heat: Positive = 1000.0
    tether: NotNegative = 0.0
    parcel: Positive = 1.0
    copies: Copies | None = None

    @property
    def count(self) -> int:
        """Number of spheres."""
        if self.copies is None:
            return 1
        x, y, z = self.copies.number
        return x * y * z


@parameters
class Wall:
    """A plane from which spheres bounce without friction.

    Parameters
    ----------
    normal : 1
        Towards the spheres; of any length.
    offset : m
        Of the plane along its unit normal.
    """

    normal: Vector
    offset: Number = 0.0

    def __post_init__(self) -> None:
        if not any(self.normal):
            raise ValueError("wall: normal must have a length; found 0.")


@parameters
class ParticleSpheresParams:
    """Spheres in free flight under the loads of a partner.

    Parameters
    ----------
    spheres
        Spheres, in the order in which ports count them.
    walls
        Planes from which spheres bounce.
    gravity : m/s2
        Acceleration of free fall.
    restitution : 1
        Normal velocity after an impact over that before, among spheres and with walls.
    collisions
        Whether spheres strike each other; parcels cannot.
    longest_step : s
        Upper limit of the step. Without it only tethers and closing speeds limit the step.
    integrator
        Of second order, or Yoshida's of fourth; without tethers both are exact.
    courant : 1
        Step over the greatest stable one of the stiffest tether: 2/ω, of Yoshida's 1.573/ω.
    """

    spheres: Annotated[tuple[Sphere, ...], Field(min_length=1)]
    walls: tuple[Wall, ...] = ()
    gravity: Vector = (0.0, 0.0, 0.0)
    restitution: Fraction = 1.0
    collisions: bool = True
    longest_step: Positive | None = None
    integrator: Literal["velocity_verlet", "yoshida"] = "velocity_verlet"
    courant: Annotated[float, Field(gt=0.0, le=1.0)] = 0.03

    def __post_init__(self) -> None:
        if self.collisions and any(sphere.parcel != 1.0 for sphere in self.spheres):
            raise ValueError(
                "spheres: a parcel has no size to strike with; it must not collide. "
                "Set collisions = false."
            )
