"""What a scene says about spheres."""

from quintet.interfaces.params import NotNegative, Number, Positive, Vector, parameters


@parameters
class Sphere:
    """A rigid sphere; as a point, if nobody looks at its size.

    Parameters
    ----------
    position : m
        Of its centre at the start.
    diameter : m
        Of the sphere: what it strikes with, and what loads and heat act on.
    density : kg/m3
        Of its material.
    velocity : m/s
        With which it is launched.
    angular_velocity : rad/s
        With which it is launched.
    launch : s
        When it is launched; before it rests where it is, whatever acts on it.
    temperature : K
        At the start, the same throughout.
    specific_heat : J/(kg K)
        Of its temperature.
    """

    position: Vector
    diameter: Positive
    density: Positive
    velocity: Vector = (0.0, 0.0, 0.0)
    angular_velocity: Vector = (0.0, 0.0, 0.0)
    launch: NotNegative = 0.0
    temperature: Positive = 300.0
    specific_heat: Positive = 1000.0


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
