"""Parameters of the stand-ins."""

from typing import ClassVar, Literal

from quintet.components.shared.geometry.polygons import require_outline
from quintet.components.shared.geometry.shape_keys import (
    RENAMED,
    BoxKeys,
    PolygonKeys,
    RoundKeys,
    shape_of,
)
from quintet.interfaces.component import Field, Port
from quintet.interfaces.manifest import Ports
from quintet.interfaces.params import Count, Number, Positive, Vector, parameters
from quintet.interfaces.ports import LOAD, MOTION, PLANAR_MOTION

PLANAR = ("disc", "polygon")
PASSED = Port("passed", (Field("value", (3,), "m"),))
RETURNED = Port("returned", (Field("value", (3,), "m"),))
# Loads on bodies that do not yield: the force of water on a fixed block, for example.
MEASURED_LOAD = Port("measured_load", LOAD.fields)


@parameters
class ReplayParams:
    """Which recording, and which of its components.

    Parameters
    ----------
    recording
        A recording, or the folder of a run.
    component
        Name of the component in it.
    """

    recording: str
    component: str


@parameters
class PrescribedBody(BoxKeys, RoundKeys, PolygonKeys):
    """One rigid body on its path: steady motion and rotation, and a sine on top.

    A polygon moves and turns with its origin, other shapes with their centre.

    Parameters
    ----------
    shape
        Disc and polygon in two dimensions, the others in three.
    velocity : m/s
        Of the steady motion.
    angular_velocity : rad/s
        About the centre, in world axes.
    mass : kg
        Stated to the partner; it moves nothing here.
    amplitude : m
        Of the sine along each axis.
    frequency : 1/s
        Of the sine.
    """

    RENAMED: ClassVar = RENAMED
    shape: Literal["box", "sphere", "disc", "polygon"]
    velocity: Vector = (0.0, 0.0, 0.0)
    angular_velocity: Vector = (0.0, 0.0, 0.0)
    mass: Positive = 1.0
    amplitude: Vector = (0.0, 0.0, 0.0)
    frequency: Number = 0.0


@parameters
class PrescribedParams:
    """Bodies on given paths.

    Parameters
    ----------
    bodies
        At least one, in the order in which ports count them.
    measure_loads
        Whether the loads on them are taken, and returned as port `measured_load`.
    """

    RENAMED: ClassVar = {"held": "measure_loads"}
    bodies: tuple[PrescribedBody, ...]
    measure_loads: bool = False

    def __post_init__(self) -> None:
        if not self.bodies:
            raise ValueError("bodies: at least one is required; found none. Add one.")
        for k, body in enumerate(self.bodies):
            check_body(f"bodies[{k}]", body, self.planar)

    @property
    def planar(self) -> bool:
        """Whether they have two dimensions, as the first of them."""
        return self.bodies[0].shape in PLANAR


def check_body(where: str, body: PrescribedBody, planar: bool) -> None:
    """Refuse a body whose description is incomplete, or that is not of the others' dimensions."""
    if (body.shape in PLANAR) != planar:
        raise ValueError(
            f"{where}.shape must have as many dimensions as those of the other bodies, two "
            f"({', '.join(PLANAR)}) or three; found {body.shape}. Put it in another component."
        )
    shape_of(body, where)
    if body.corners is not None:
        require_outline(f"{where}.corners", body.corners)
    across, normal = body.angular_velocity[::2], (body.velocity[1], body.amplitude[1])
    if planar and any((*across, *normal)):
        raise ValueError(
            f"{where} must move in the plane of x and z, in two dimensions; found velocity "
            f"{body.velocity}, amplitude {body.amplitude}, angular_velocity "
            f"{body.angular_velocity}. Set what leaves it to 0."
        )


@parameters
class EchoParams:
    """Number of items exchanged; and, to test failures, how it fails.

    Parameters
    ----------
    items : 1
        Of three numbers each.
    fails_at : 1
        Step at which it fails; below 0 never.
    fails_by
        How it fails: by an exception, by leaving, by a value that is not finite, by a signal that
        kills it, or by one that stops it.
    """

    items: Count = 100
    fails_at: int = -1
    fails_by: Literal["raise", "exit", "nan", "kill", "stop"] = "raise"


def prescribed_ports(params: PrescribedParams) -> Ports:
    """Motion is given; with `measure_loads` loads are taken and returned."""
    motion = PLANAR_MOTION if params.planar else MOTION
    return ((LOAD,), (motion, MEASURED_LOAD)) if params.measure_loads else ((), (motion,))


def echo_ports(params: EchoParams) -> Ports:
    """One field of three numbers per item, in and out."""
    return (PASSED,), (RETURNED,)
