"""The run loop: window after window, until the end or until something ends it."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from quintet.coupler.coupling.participant import Part, describe_all
from quintet.coupler.coupling.schedule import SCHEMES, Coupling
from quintet.coupler.scene.scene import Scene
from quintet.interfaces.component import Fields


class Witness(Protocol):
    """Sees a run pass: writes it down, tells the user, asks for an end."""

    def begin(self, coupling: Coupling, described: dict[str, Fields], windows: int) -> None:
        """Take note of the start, with all components primed."""

    def due(self, window: int) -> bool:
        """Whether totals and views are wanted at the end of a window."""

    def end_window(self, coupling: Coupling, window: int) -> None:
        """Take note of a window's end."""

    def wants_end(self) -> bool:
        """Whether to stop here."""

    def ends_early(self, coupling: Coupling, window: int) -> None:
        """Take note that it stops at the end of a window, before the last."""


@dataclass(slots=True)
class Progress:
    """How far a run came."""

    windows: int  # of the whole run
    done: int = 0
    dt: float = 0.0  # s, one window

    @property
    def time(self) -> float:
        """Simulated time; counted in windows, never summed."""
        return self.done * self.dt


def run(
    scene: Scene,
    parts: dict[str, Part],
    coupling: Coupling,
    witness: Witness,
    resume: Callable[[Coupling], int] = lambda _: 0,
) -> Progress:
    """Couple the components of a scene to the end, from the start or where `resume` puts them."""
    described = describe_all(parts)
    limits = prepare(coupling, described)
    progress = Progress(*windows_of(scene, limits))
    coupling.dt = progress.dt
    progress.done = resume(coupling)
    witness.begin(coupling, described, progress.windows)
    step = SCHEMES[scene.file.scheme]
    while progress.done < progress.windows and not witness.wants_end():
        step(coupling, progress.done, witness.due(progress.done))
        progress.done += 1
        witness.end_window(coupling, progress.done)
    if progress.done < progress.windows:
        witness.ends_early(coupling, progress.done)
    return progress


def prepare(coupling: Coupling, described: dict[str, Fields]) -> dict[str, float]:
    """Join the ports and hand out what holds at the start; return the steps that each allows."""
    exchange, limits = coupling.exchange, {}
    static = exchange.bind(described)
    for name, part in coupling.parts.items():
        answer = part.ask("bind", static[name], works=exchange.works(name))
        part.timing.items = int(answer.header["items"])
        limits[name] = float(answer.header["limit"])
    # Motion is known at once; forces, which follow from it, are zero before the first window.
    coupling.outputs = {name: part.give() for name, part in coupling.parts.items()}
    for name, part in coupling.parts.items():
        fields = exchange.inputs(name, coupling.outputs, ()).fields
        instants = {k: v for k, v in fields.items() if not exchange.is_impulse(name, k)}
        part.ask("prime", instants)
        coupling.ledger.primed(name, instants)
    return limits


def windows_of(scene: Scene, limits: dict[str, float]) -> tuple[int, int, float]:
    """Count the windows, none done, and their length: as asked, or what the slowest steps in."""
    end = scene.file.end
    if scene.file.window == "auto":
        # No longer than that step: a window a little longer would take two.
        longest = min(max(limits.values()), end)
        windows = max(1, math.ceil(end / longest - 1e-9)) if longest > 0.0 else 1
    else:
        windows = max(1, round(end / scene.file.window))
    return windows, 0, end / windows
