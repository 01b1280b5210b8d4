"""Direct: items of one component are items of the other; fields pass as they are.

For resolved particles in a flow (pose one way, force, torque and heat back), for springs
between bodies, and for components of a user's own.
"""

from collections.abc import Callable, Mapping
from typing import Any

from quintet.coupler.coupling.link import (
    Binding,
    Ends,
    Link,
    Mapped,
    Ports,
    Transfer,
)
from quintet.coupler.coupling.links.keys import Pairs, is_stand_in, with_keys
from quintet.coupler.coupling.links.port_checks import misfits
from quintet.interfaces.component import Array, Fields, Port
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import parameters, unknown

LARGEST = "largest_"  # begins the name of a state: the most that a field may be at the start


@parameters
class DirectKeys:
    """Fields pass as they are between ports that have the same ones.

    Parameters
    ----------
    pairs
        Pairs of ports, the giver's first: ``[["a.motion", "b.foot"]]``.
    """

    pairs: Pairs


@with_keys(DirectKeys)
def make(name: str, keys: DirectKeys, ports: Mapping[str, Ports]) -> Link:
    """Make a link with the names of its components if it has none."""
    names = dict.fromkeys(path.split(".")[0] for pair in keys.pairs for path in pair)
    return join(name or "-".join(names), keys.pairs, ports)


def join(name: str, pairs: Any, ports: Mapping[str, Ports]) -> "Direct":
    """Match pairs of ports, each given first: ``["a.motion", "b.foot"]``."""
    mistakes: list[str] = []
    joined = []
    for giver, taker in pairs:
        if is_stand_in(ports.get(taker.partition(".")[0])):
            continue
        giving = _port(name, giver, ports, 1, mistakes)
        taken = _port(name, taker, ports, 0, mistakes)
        if giving and taken:
            wrong = misfits(taker.split(".")[0], taken, giving)
            mistakes += [f"link {name}: {misfit}. Change one of the ports." for misfit in wrong]
            joined.append((giver.split(".")[0], giving, taker.split(".")[0], taken))
    if mistakes:
        raise SceneError(mistakes)
    return Direct(name, joined)


def _port(
    link: str, path: str, ports: Mapping[str, Ports], side: int, mistakes: list[str]
) -> Port | None:
    component, _, name = path.partition(".")
    if component not in ports:
        mistakes.append(unknown(f"link {link}: component {component}", component, ports))
        return None
    offered = {port.name: port for port in ports[component][side]}
    if name not in offered:
        verb = "gives" if side else "takes"
        known = ", ".join(offered) or "nothing"
        mistakes.append(
            f"link {link}: {component} {verb} {known}; found {path}. Name one of these."
        )
    return offered.get(name)


class Direct(Link):
    """Fields pass unchanged from port to port."""

    def __init__(self, name: str, joined: list[tuple[str, Port, str, Port]]) -> None:
        self.name = name
        self.joined = joined
        self.transfers = tuple(
            Transfer(
                giver,
                taker,
                reads=tuple(f"{giving.name}.{field.name}" for field in taken.fields),
                fills=tuple(f"{taken.name}.{field.name}" for field in taken.fields),
            )
            for giver, giving, taker, taken in joined
        )

    def refusals(self, initial: Mapping[str, Fields]) -> list[str]:
        """Refuse what is larger than the taker requests."""
        wrong = []
        for giver, giving, taker, taken in self.joined:
            for request in taken.requests:
                if not request.name.startswith(LARGEST):
                    continue
                place = f"{giving.name}.{request.name.removeprefix(LARGEST)}"
                limit = initial.get(taker, {}).get(f"{taken.name}.{request.name}")
                values = initial.get(giver, {}).get(place)
                if limit is None or values is None or not values.size:
                    continue
                if (largest := float(values.max())) > (most := float(limit[0])):
                    wrong.append(
                        f"link {self.name}: {giver}.{place} must be at most {most:.4g} "
                        f"{request.unit}, as {taker}.{taken.name}.{request.name} requests; found "
                        f"{largest:.4g} {request.unit} of item {int(values.argmax())}. Correct "
                        f"{giver} or {taker}."
                    )
        return wrong

    def bind(self, described: Mapping[str, Fields]) -> Binding:
        """Pass on the static fields that the taking port asks for."""
        passed: dict[str, dict[str, Array]] = {}
        for giver, giving, taker, taken in self.joined:
            for field in taken.static:
                array = described[giver].get(f"{giving.name}.{field.name}")
                if array is not None:
                    passed.setdefault(taker, {})[f"{taken.name}.{field.name}"] = array
        return Binding(passed, tuple(_passing(transfer) for transfer in self.transfers))


def _passing(transfer: Transfer) -> Callable[[Ends, Ends], Mapped]:
    names = tuple(zip(transfer.reads, transfer.fills, strict=True))

    def maps(_: Ends, end: Ends) -> Mapped:
        outputs = end[transfer.giver]
        return {taken: outputs[key] for key, taken in names}

    return maps
