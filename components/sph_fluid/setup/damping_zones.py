"""Zones of a tank in which the fluid's motion is damped, as by a beach."""

from quintet.components.shared.geometry.bounds import Bounds
from quintet.components.sph_fluid.setup.geometry import Face
from quintet.interfaces.params import Positive, Vector, parameters


@parameters
class DampingZone:
    """A box in which fluid loses its velocity: du/dt = -rate ξ² u.

    ξ rises from 0 to 1 across the box, to the face that waves run to.

    Parameters
    ----------
    lowest : m
        Lowest corner of the box.
    highest : m
        Highest corner of the box.
    towards
        Face of the box at which damping is strongest.
    rate : 1/s
        There.
    """

    lowest: Vector
    highest: Vector
    towards: Face
    rate: Positive = 10.0

    def __post_init__(self) -> None:
        """Refuse boxes without an inside."""
        if not all(low < high for low, high in zip(self.lowest, self.highest, strict=True)):
            raise ValueError(
                "damping must go from its lowest to its highest corner; found "
                f"{self.lowest} to {self.highest} m. Exchange the corners, or widen the box."
            )

    @property
    def bounds(self) -> Bounds:
        """Lowest and highest corner [m]."""
        return self.lowest, self.highest
