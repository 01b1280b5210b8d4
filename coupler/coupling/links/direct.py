"""Direct: items of one component are items of the other; fields pass as they are.

For resolved particles in a flow (pose one way, force, torque and heat back), for springs
between bodies, and for components of a user's own.
"""

from collections.abc import Mapping
from typing import Any

from quintet.coupler.coupling.exchange import Leg, Ports, Works, misfits
from quintet.interfaces.component import Array, Fields, Port
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import unknown


def join(name: str, pairs: Any, ports: Mapping[str, Ports]) -> "Direct":
    """Match pairs of ports, each given first: ``["a.motion", "b.foot"]``."""
    mistakes: list[str] = []
    joined = []
    for giver, taker in pairs:
        given = _port(name, giver, ports, 1, mistakes)
        taken = _port(name, taker, ports, 0, mistakes)
        if given and taken:
            wrong = misfits(taker.split(".")[0], taken, given)
            mistakes += [f"link {name}: {one}. Change one of the ports." for one in wrong]
            joined.append((giver.split(".")[0], given, taker.split(".")[0], taken))
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
        self.memory = None
        self.partner = {b: p.name for _, _, b, p in joined if p.items == "partner"}
        self.works: dict[str, Works] = {}
        self.legs = []
        for giver, given, taker, taken in joined:
            names = [(f"{given.name}.{f.name}", f"{taken.name}.{f.name}") for f in taken.fields]
            pushed = [f"{given.name}.{f.name}" for f in given.fields if f.unit == "N"]
            self._note_work(giver, taker, pushed)
            self.legs.append(
                Leg(
                    giver,
                    taker,
                    _passing(names),
                    sums=tuple(
                        (f"{given.name}.{f.name}", f"{taken.name}.{f.name}")
                        for f in taken.fields
                        if f.centring == "impulse"
                    ),
                    works_on=self._works_on(giver, taker, taken),
                )
            )

    def _note_work(self, giver: str, taker: str, pushed: list[str]) -> None:
        """Pair a force that is given with the velocity that came the other way."""
        for back_giver, _, back_taker, port in self.joined:
            fields = {field.name: field for field in port.fields}
            if (back_giver, back_taker) == (taker, giver) and "velocity" in fields:
                place = f"{port.name}.position" if "position" in fields else ""
                if place and fields["position"].shape != (3,):
                    place = ""
                works = [(force, f"{port.name}.velocity", place) for force in pushed]
                self.works.setdefault(giver, []).extend(works)

    def _works_on(self, giver: str, taker: str, taken: Port) -> tuple[tuple[str, str, str], ...]:
        for back_giver, port, back_taker, _ in self.joined:
            fields = {field.name for field in port.fields}
            if (back_giver, back_taker) == (taker, giver) and "velocity" in fields:
                place = f"{port.name}.position" if "position" in fields else ""
                return tuple(
                    (f"{taken.name}.{f.name}", f"{port.name}.velocity", place)
                    for f in taken.fields
                    if f.unit == "N"
                )
        return ()

    def describe(self, described: Mapping[str, Fields]) -> dict[str, dict[str, Array]]:
        """Pass on the static fields that the taking port asks for."""
        passed: dict[str, dict[str, Array]] = {}
        for giver, given, taker, taken in self.joined:
            for field in taken.static:
                array = described[giver].get(f"{given.name}.{field.name}")
                if array is not None:
                    passed.setdefault(taker, {})[f"{taken.name}.{field.name}"] = array
        return passed


def _passing(names: list[tuple[str, str]]) -> Any:
    def carry(given: Fields) -> dict[str, Array]:
        return {taken: given[key] for key, taken in names}

    return carry
