"""Direct: items of one component are items of the other; fields pass as they are.

For resolved particles in a flow (pose one way, force, torque and heat back), for springs
between bodies, and for components of a user's own.
"""

from collections.abc import Callable, Mapping
from typing import Any

from quintet.coupler.coupling.exchange import (
    Binding,
    Demands,
    Ends,
    Link,
    Mapped,
    Ports,
    Transfer,
    Works,
)
from quintet.coupler.coupling.links.keys import Pairs, is_stand_in, with_keys
from quintet.coupler.coupling.links.port_checks import misfits
from quintet.interfaces.component import Array, Field, Fields, Port
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


class Direct:
    """Fields pass unchanged from port to port."""

    def __init__(self, name: str, joined: list[tuple[str, Port, str, Port]]) -> None:
        self.name = name
        self.joined = joined
        self.partner = {b: p.name for _, _, b, p in joined if p.items == "partner"}
        works: dict[str, Works] = {}
        transfers = []
        for giver, giving, taker, taken in joined:
            for field in giving.fields:
                if pair := self._velocity(taker, giver, field, taken=True):
                    works.setdefault(giver, []).append((f"{giving.name}.{field.name}", *pair))
            on = [(f"{taken.name}.{f.name}", self._velocity(taker, giver, f)) for f in taken.fields]
            transfers.append(
                Transfer(
                    giver,
                    taker,
                    reads=tuple(f"{giving.name}.{f.name}" for f in taken.fields),
                    fills=tuple(f"{taken.name}.{f.name}" for f in taken.fields),
                    sums=tuple(
                        (f"{giving.name}.{f.name}", f"{taken.name}.{f.name}")
                        for f in taken.fields
                        if f.centring == "impulse"
                    ),
                    works_on=tuple((key, *pair) for key, pair in on if pair),
                )
            )
        self.works = works
        self.transfers = tuple(transfers)

    def _velocity(
        self, mover: str, pusher: str, force: Field, taken: bool = False
    ) -> tuple[str, str] | None:
        """Key of the velocity with which a force works, and of what that is the rate, or "".

        Looked for among the ports that lead from who is moved to who pushes: as the pusher takes
        it, or as the mover gives it. On the taking side only a position (3,) is named, from which
        the moment about the origin follows.
        """
        if not force.works_with:
            return None
        for giver, giving, taker, taking in self.joined:
            fields = {field.name: field for field in taking.fields}
            if (giver, taker) != (mover, pusher) or force.works_with not in fields:
                continue
            port = taking if taken else giving
            whole = [field for field in port.fields if field.rate == force.works_with]
            if taken:
                whole = [field for field in whole if field.shape == (3,) and force.unit == "N"]
            place = f"{port.name}.{whole[0].name}" if whole else ""
            return f"{port.name}.{force.works_with}", place
        return None

    def demands(self) -> Demands:
        """Nothing: any steps, any scheme."""
        return Demands()

    def refuses(self, initial: Mapping[str, Fields]) -> list[str]:
        """See `exchange.refused_starts`: what is larger than the taker requests."""
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
