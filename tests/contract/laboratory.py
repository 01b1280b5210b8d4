"""Run small scenes in this process, and record their results."""

import itertools
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w

from quintet.coupler.coupling.group import assemble
from quintet.coupler.coupling.judgement.checks import Judgement
from quintet.coupler.coupling.ledger import Account, Ledger
from quintet.coupler.coupling.participant import Participant
from quintet.coupler.coupling.schedule import Coupling
from quintet.coupler.coupling.windows import Windows
from quintet.coupler.launch.connect import connect
from quintet.coupler.launch.watchdog import Watchdog
from quintet.coupler.run.loop import run
from quintet.coupler.run.signals import StopRequest
from quintet.coupler.scene.overrides import plain
from quintet.coupler.scene.read import load
from quintet.interfaces.component import Array, Component, Fields

HERE = Path(__file__).parent


@dataclass
class Trace:
    """Results of a run, window by window, and its coupling."""

    coupling: Coupling
    judgement: Judgement
    components: dict[str, Component]
    outputs: list[dict[str, Fields]] = field(default_factory=list)
    energies: list[float] = field(default_factory=list)  # J
    ends: list[float] = field(default_factory=list)  # s, of the windows
    stable: list[dict[str, float]] = field(default_factory=list)  # s, steps allowed
    warnings: list[str] = field(default_factory=list)

    def history(self, name: str, key: str) -> Array:
        """One field of a component at the start and at every window's end."""
        return np.array([outputs[name][key] for outputs in self.outputs])

    @property
    def times(self) -> Array:
        """Ends of the windows [s]."""
        return np.array(self.ends)

    @property
    def account(self) -> Account:
        """The ledger's account of the only link."""
        (account,) = self.coupling.ledger.accounts.values()
        return account

    def momentum(self) -> Array:
        """Sum of the components' momenta (3,)."""
        return sum((c.totals().momentum for c in self.components.values()), np.zeros(3))

    def energy(self) -> float:
        """Sum of the components' energies."""
        totals = [c.totals() for c in self.components.values()]
        return sum(total.kinetic + total.potential + total.internal for total in totals)

    # Methods of a run loop's observer.

    def plan(self, windows: Windows) -> None:
        pass

    def begin(self, coupling: Coupling, described: Mapping[str, Fields]) -> None:
        self.end_window(coupling)

    def due(self, ticks: int) -> bool:
        return False

    def end_window(self, coupling: Coupling) -> None:
        self.ends.append(coupling.windows.time)
        self.stable.append(
            {name: component.stable for name, component in coupling.components.items()}
        )
        self.outputs.append(dict(coupling.outputs))
        self.energies.append(self.energy())

    def warn(self, text: str) -> None:
        self.warnings.append(text)

    def wants_end(self) -> bool:
        return False

    def ends_early(self, coupling: Coupling) -> None:
        pass


def scene(folder: Path, components: dict[str, Any], link: Any, **settings: Any) -> Path:
    """Write a scene; one link or several."""
    links = link if isinstance(link, list) else [link]
    table = {"name": "toy", "transport": "memory", **settings}
    path = folder / "scene.toml"
    document = plain({**table, "components": components, "links": links})
    path.write_text(tomli_w.dumps(document))
    return path


def couple(path: Path) -> Trace:
    """Run a scene in this process, all outputs wanted."""
    checked_scene = load(str(path))
    exchange = checked_scene.exchange()
    watchdog = Watchdog(StopRequest())
    participants = connect(checked_scene, path.parent, watchdog).participants
    coupling = assemble(checked_scene.coupling, participants, exchange, Ledger(exchange))
    judgement = Judgement(coupling.ledger.accounts)
    components = {name: component_of(participant) for name, participant in participants.items()}
    trace = Trace(coupling, judgement, components)
    outputs = {name: list(exchange.gives[name]) for name in participants}
    try:
        run(coupling, checked_scene.file.end, trace, outputs, judgement)
    finally:
        watchdog.close()
    return trace


def component_of(participant: Participant) -> Component:
    """Take the component out of a participant that lives in this process."""
    server = participant.line.handle.args[0]  # type: ignore[attr-defined]
    return server.component  # type: ignore[no-any-return]


def in_transit(trace: Trace, giver: str, key: str) -> Array:
    """Sum of the impulses that were given in the last window."""
    return np.asarray(trace.outputs[-1][giver][key].sum(axis=0))


def orders(errors: list[float]) -> list[float]:
    """Observed orders of convergence of errors at windows that are halved."""
    return [float(np.log2(a / b)) for a, b in itertools.pairwise(errors)]
