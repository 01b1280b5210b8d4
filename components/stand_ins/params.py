"""Parameters of the stand-ins."""

from pathlib import Path
from typing import Literal

from quintet.interfaces.component import Field, Port
from quintet.interfaces.errors import SceneError
from quintet.interfaces.manifest import Ports
from quintet.interfaces.params import Count, Number, Positive, PositiveVector, Vector, parameters
from quintet.interfaces.ports import LOAD, MOTION, from_json

PASSED = Port("passed", (Field("value", (3,), "m"),))
RETURNED = Port("returned", (Field("value", (3,), "m"),))
# What pushes bodies that do not yield, as it came: the force of water on a fixed block.
HELD = Port("held", LOAD.fields)


@parameters
class ReplayParams:
    """Which recording, and which of its components."""

    recording: str  # a recording, or the folder of a run
    component: str


@parameters
class PrescribedBody:
    """One rigid body on its path: steady motion and spin from where it is at the start."""

    shape: Literal["box", "sphere"]
    size: PositiveVector  # m, edges; of a sphere its diameter three times
    position: Vector  # m, centre at the start
    velocity: Vector = (0.0, 0.0, 0.0)  # m/s
    angular_velocity: Vector = (0.0, 0.0, 0.0)  # rad/s, about the centre
    mass: Positive = 1.0  # kg, stated to the partner; it moves nothing here
    amplitude: Vector = (0.0, 0.0, 0.0)  # m, of a sine on top of the steady motion
    frequency: Number = 0.0  # 1/s, of the sine


@parameters
class PrescribedParams:
    """Bodies that move as told."""

    bodies: tuple[PrescribedBody, ...]
    held: bool = False  # whether the loads on them are taken, and given as port `held`

    def __post_init__(self) -> None:
        if not self.bodies:
            raise ValueError("bodies: at least one is needed; found none. Add one.")


@parameters
class EchoParams:
    """How many items go to and fro."""

    items: Count = 100
    fails_at: int = -1  # step at which it fails; below 0 never. For trying out failures
    fails_by: Literal["raise", "exit", "nan", "kill", "stop"] = "raise"


def prescribed_ports(params: PrescribedParams) -> Ports:
    """It gives motion; if asked to it takes loads, and gives them again."""
    return ((LOAD,), (MOTION, HELD)) if params.held else ((), (MOTION,))


def echo_ports(params: EchoParams) -> Ports:
    """It takes and gives one field of three numbers an item."""
    return (PASSED,), (RETURNED,)


def recording_file(path: str) -> Path:
    """File of a recording that is given as a file or as a run's folder."""
    found = Path(path)
    return found / "recording.h5" if found.is_dir() else found


def recorded_ports(params: ReplayParams) -> Ports:
    """Ports that the recorded component gave; it takes nothing back."""
    import h5py

    path = recording_file(params.recording)
    if not path.is_file():
        raise SceneError(
            f"recording {params.recording}: there is no such file. Run the scene first, or name "
            "the run to replay, as in --swap NAME=replay@DIR."
        )
    with h5py.File(path, "r", locking=False) as file:
        known = list(file["components"])
        if params.component not in known:
            raise SceneError(
                f"recording {params.recording}: component {params.component} is not in it. It has "
                f"{', '.join(known)}."
            )
        listed = str(file[f"components/{params.component}"].attrs["ports"])
    return (), from_json(listed)
