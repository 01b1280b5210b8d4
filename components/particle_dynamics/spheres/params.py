"""What a scene says about spheres."""

from typing import ClassVar, Literal

from quintet.interfaces.params import (
    Count,
    NotNegative,
    Number,
    Positive,
    PositiveVector,
    Vector,
    parameters,
)


@parameters
class Copies:
    """A lattice of equal spheres; they count as spheres in its order, x slowest.

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
    """A rigid sphere, or a lattice of equal ones; as a point, if nobody looks at its size.

    Parameters
    ----------
    shape
        Name of the shape.
    centre : m
        At the start.
    radius : m
        Of the sphere: what it strikes with, and what loads and heat act on. That of a body with
        nodes in a gas is no smaller than the body, and larger if it strikes others: two layers of
        nodes on each must fit between.
    density : kg/m3
        Of its material. The mass is that of a sphere, also where it moves a cylinder 1 m long in a
        gas of two dimensions: 0.75 m/r of the cylinder's density, r the radius of both, makes it
        the cylinder's.
    velocity : m/s
        With which it is launched.
    angular_velocity : rad/s
        With which it is launched.
    launch : s
        When it is launched; before it rests where it is, whatever acts on it, and is not there for
        a gas that is coarser than it.
    temperature : K
        At the start, the same throughout.
    specific_heat : J/(kg K)
        Of its temperature.
    tether : N/m
        Of a spring that pulls it back to where it started.
    parcel : 1
        How many equal ones it stands for: mass, loads and heat are those of all of them.
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
