"""Running small scenes in this process, and looking at what is left of them."""

import itertools
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from quintet.coupler.coupling.exchange import Exchange
from quintet.coupler.coupling.ledger import Account, Ledger
from quintet.coupler.coupling.participant import Part
from quintet.coupler.coupling.schedule import Coupling
from quintet.coupler.files.toml_writer import dumps
from quintet.coupler.launch.connect import connect
from quintet.coupler.run.loop import run
from quintet.coupler.scene.read import load
from quintet.interfaces.component import Array, Component, Fields

HERE = Path(__file__).parent


@dataclass
class Trace:
    """What a run gave, window by window, and the coupling that it was made with."""

    coupling: Coupling
    components: dict[str, Component]
    outputs: list[dict[str, Fields]] = field(default_factory=list)
    energies: list[float] = field(default_factory=list)  # J

    def history(self, name: str, key: str) -> Array:
        """One field of a component at the start and at every window's end."""
        return np.array([outputs[name][key] for outputs in self.outputs])

    @property
    def times(self) -> Array:
        """Of these, in s."""
        return np.arange(len(self.outputs)) * self.coupling.dt

    @property
    def account(self) -> Account:
        """The ledger's account of the only link."""
        (found,) = self.coupling.ledger.accounts.values()
        return found

    def momentum(self) -> Array:
        """Sum of the components' momenta (3,)."""
        return sum((c.totals().momentum for c in self.components.values()), np.zeros(3))

    def energy(self) -> float:
        """Sum of the components' energies."""
        totals = [c.totals() for c in self.components.values()]
        return sum(one.kinetic + one.potential + one.internal for one in totals)

    # What a run loop's witness does.

    def begin(self, coupling: Coupling, described: dict[str, Fields], windows: int) -> None:
        self.end_window(coupling, 0)

    def due(self, window: int) -> bool:
        return False

    def end_window(self, coupling: Coupling, window: int) -> None:
        self.outputs.append(dict(coupling.outputs))
        self.energies.append(self.energy())

    def wants_end(self) -> bool:
        return False


def scene(folder: Path, components: dict[str, Any], link: Any, **settings: Any) -> Path:
    """Write a scene; one link or several."""
    links = link if isinstance(link, list) else [link]
    table = {"name": "toy", "transport": "memory", **settings}
    path = folder / "scene.toml"
    path.write_text(dumps({**table, "components": components, "links": links}))
    return path


def couple(path: Path) -> Trace:
    """Run a scene in this process."""
    checked = load(str(path))
    ports = {name: (one.takes, one.gives) for name, one in checked.components.items()}
    exchange = Exchange(checked.links, ports)
    parts = connect(checked, path.parent, lambda: False).parts
    coupling = Coupling(parts, exchange, Ledger(exchange), 0.0, checked.iteration())
    trace = Trace(coupling, {name: component_of(part) for name, part in parts.items()})
    run(checked, parts, coupling, trace)
    return trace


def component_of(part: Part) -> Component:
    """Take the component out of a part that lives in this process."""
    server = part.line.handle.args[0]  # type: ignore[attr-defined]
    return server.component  # type: ignore[no-any-return]


def in_transit(trace: Trace, giver: str, key: str) -> Array:
    """Sum of the impulses that were given in the last window."""
    return np.asarray(trace.outputs[-1][giver][key].sum(axis=0))


def orders(errors: list[float]) -> list[float]:
    """Observed orders of convergence of errors at windows that are halved."""
    return [float(np.log2(a / b)) for a, b in itertools.pairwise(errors)]
