"""Energy and mass of a whole run: what changed, what brought it about, and what nothing explains.

Of a component, between the first and the last time at which totals were noted:

    change of kinetic, potential and internal energy
        = work from outside + work over links + heat over links - lost + unexplained

Of the run the same holds of all components that report energies. Its work over links is that of the
links to components that report none. Work that the two sides of another link count differently is
part of the unexplained energy. Heat that is still on its way at the end counts as negative heat
over links.
"""

from collections import defaultdict
from collections.abc import Mapping
from copy import deepcopy
from dataclasses import asdict, dataclass
from typing import Any

from quintet.coupler.coupling.saved_values import like

KINDS = ("kinetic", "potential", "internal")
WORK, HEAT = 0, 1  # places in what a link brought
# Of the largest energy that a component has: what changes by less is rounding, not turned over.
NEGLIGIBLE = 1e-6


@dataclass(slots=True)
class Balance:
    """Where the energy of a component, or of the run, came from and went to [J].

    Attributes
    ----------
    change : float
        Of the sum of kinetic, potential and internal energy, from start to end.
    outside : float
        Work done on it by what no link brings (`Totals.work`).
    links, heat : float
        Work and heat that links brought, as it counts them itself.
    lost : float
        What it reports as dissipated; if it reports none, all that is missing at the end.
    unexplained : float or None
        What is left over; None if it reports no dissipation and energy is missing, for that may all
        be dissipated.
    gained : float
        The largest increase of the unexplained energy since the start, at any time.
    coupling : float
        Of the run, part of what is unexplained: work that one side of its links took beyond what
        the other gave.
    """

    change: float = 0.0
    outside: float = 0.0
    links: float = 0.0
    heat: float = 0.0
    lost: float = 0.0
    unexplained: float | None = None
    gained: float = 0.0
    coupling: float = 0.0


@dataclass(slots=True)
class ComponentEnergy:
    """Energies of one component [J], at the start and last, and their extremes."""

    ranges: dict[str, list[float]]  # by kind: least, most
    first: list[float]  # energy, work from outside, dissipated
    last: list[float]
    dissipates: bool  # whether it reports what it dissipates
    largest_excess: float = 0.0  # largest increase of the unexplained energy

    @property
    def reports(self) -> bool:
        """Whether it reports any energy: those of one that does not are all 0, at all times."""
        return any(map(any, self.ranges.values())) or any(self.last)

    def since_start(self) -> tuple[float, float, float]:
        """Change of its energy, work from outside, and dissipated energy since the start [J]."""
        energy, outside, dissipated = (b - a for a, b in zip(self.first, self.last, strict=True))
        return energy, outside, dissipated


class EnergyBalance:
    """Energies and masses of all components, and what links brought to each."""

    def __init__(self) -> None:
        self._components: dict[str, ComponentEnergy] = {}
        # by link, then component: work and heat that it brought [J]
        self._brought: dict[str, dict[str, list[float]]] = defaultdict(dict)
        self._times = 0  # at which totals were noted
        self._largest_excess = 0.0  # J, of the run
        self._masses: dict[str, list[float]] = {}  # kg, by component: at the start and the last

    def add_work(self, link: str, name: str, work: float) -> None:
        """Add work [J] that a link did on a component in a window, as that counts it."""
        self._brought[link].setdefault(name, [0.0, 0.0])[WORK] += work

    def add_heat(self, link: str, name: str, heat: float) -> None:
        """Add heat [J] that a link brought to a component in a window."""
        self._brought[link].setdefault(name, [0.0, 0.0])[HEAT] += heat

    def brought(self, name: str) -> tuple[float, float]:
        """Work and heat [J] that all links brought to a component."""
        parts = [sides[name] for sides in self._brought.values() if name in sides]
        return sum(part[WORK] for part in parts), sum(part[HEAT] for part in parts)

    def note(self, totals: Mapping[str, Mapping[str, Any]]) -> None:
        """Take down the energies [J] and masses [kg] of all components at one time."""
        self._times += 1
        for name, sums in totals.items():
            self._note_energies(name, sums)
            mass = float(sums["mass"])
            self._masses[name] = [self._masses.get(name, [mass])[0], mass]
        if excess := [self._excess(name) for name in self._components]:
            whole = sum(excess) + self._made_by_links()
            self._largest_excess = max(self._largest_excess, whole)

    def _note_energies(self, name: str, sums: Mapping[str, Any]) -> None:
        energies = [float(sums[kind]) for kind in KINDS]
        dissipated = sums.get("dissipated")
        now = [sum(energies), float(sums["work"]), float(dissipated or 0.0)]
        component = self._components.get(name)
        if component is None:
            ranges = {kind: [e, e] for kind, e in zip(KINDS, energies, strict=True)}
            component = ComponentEnergy(ranges, now, now, dissipated is not None)
            self._components[name] = component
        for kind, energy in zip(KINDS, energies, strict=True):
            least, most = component.ranges[kind]
            component.ranges[kind] = [min(least, energy), max(most, energy)]
        component.last = now
        component.largest_excess = max(component.largest_excess, self._excess(name))

    def _excess(self, name: str) -> float:
        """Energy [J] that a component has beyond what explains it; below 0 where some is missing.

        Nothing where it reports no energy.
        """
        component = self._components[name]
        energy, outside, dissipated = component.since_start()
        if not component.reports:
            return 0.0
        return energy - outside - sum(self.brought(name)) + dissipated

    def _made_by_links(self) -> float:
        """Work [J] that links between components that report energies made; below 0: lost."""
        inner = [sides for sides in self._brought.values() if all(map(self._reports, sides))]
        return sum(brought[WORK] for sides in inner for brought in sides.values())

    def _reports(self, name: str) -> bool:
        return name in self._components and self._components[name].reports

    def largest(self, *kinds: str) -> float:
        """Largest energy [J] of one of some kinds that any component had, by magnitude."""
        ranges = [component.ranges[k] for component in self._components.values() for k in kinds]
        return max((abs(value) for pair in ranges for value in pair), default=0.0)

    def scale(self) -> float:
        """Largest energy [J] turned over; 0 where all of it is rounding.

        The largest change of one kind of energy of one component at the times at which totals were
        noted, and the largest work or heat that came to one component from outside or over links.
        """
        turned = [0.0]
        for name, component in self._components.items():
            turned += [most - least for least, most in component.ranges.values()]
            _, outside, dissipated = component.since_start()
            turned += [abs(part) for part in (outside, dissipated, *self.brought(name))]
        return max(turned) if max(turned) > NEGLIGIBLE * self.largest(*KINDS) else 0.0

    def summary(self) -> dict[str, Any] | None:
        """The balance of the run and of its components; None where no energy was turned over.

        `scale` [J] is 100 %; `times` counts those at which totals were noted; components that
        report no energies are left out.
        """
        if not (scale := self.scale()):
            return None
        names = [name for name in self._components if self._reports(name)]
        components = {name: self._balance(name) for name in names}
        return {
            "scale": scale,
            "times": self._times,
            "run": asdict(self._of_run(components)),
            "components": {name: asdict(balance) for name, balance in components.items()},
        }

    def _balance(self, name: str) -> Balance:
        component, (links, heat) = self._components[name], self.brought(name)
        change, outside, dissipated = component.since_start()
        excess = self._excess(name)
        lost, unexplained = dissipated, excess
        if not component.dissipates:
            lost = max(-excess, 0.0)
            unexplained = excess + lost
        known = component.dissipates or excess > 0.0
        gained = component.largest_excess
        return Balance(change, outside, links, heat, lost, unexplained if known else None, gained)

    def _of_run(self, components: Mapping[str, Balance]) -> Balance:
        """Sum of components; work that they do on each other is none on the run."""
        parts, coupling = list(components.values()), self._made_by_links()
        known = [part.unexplained for part in parts if part.unexplained is not None]
        return Balance(
            change=sum(part.change for part in parts),
            outside=sum(part.outside for part in parts),
            links=sum(part.links for part in parts) - coupling,
            heat=sum(part.heat for part in parts),
            lost=sum(part.lost for part in parts),
            unexplained=sum(known) + coupling if known or coupling else None,
            gained=self._largest_excess,
            coupling=coupling,
        )

    def mass_drift(self) -> dict[str, dict[str, float | None]]:
        """Change of each component's mass since the start: in kg, and relative.

        Components without a mass are left out; the relative change is None where there was none at
        the start.
        """
        return {
            name: {"kg": last - start, "relative": (last - start) / start if start else None}
            for name, (start, last) in self._masses.items()
            if start or last
        }

    def save(self) -> dict[str, Any]:
        """All of it, for a snapshot."""
        return {
            "components": {name: asdict(part) for name, part in self._components.items()},
            "brought": deepcopy(dict(self._brought)),  # it goes on after a trial window
            "times": self._times,
            "excess": self._largest_excess,
            "masses": deepcopy(self._masses),
        }

    def load(self, state: Mapping[str, Any]) -> None:
        """Come back to what was saved."""
        parts = state["components"].items()
        self._components = {name: _component(part) for name, part in parts}
        self._brought = defaultdict(dict)
        for link, sides in state["brought"].items():
            self._brought[link] = {name: _numbers(brought, 2) for name, brought in sides.items()}
        self._times, self._largest_excess = like(0, state["times"]), like(0.0, state["excess"])
        self._masses = {name: _numbers(pair, 2) for name, pair in state["masses"].items()}


def _component(saved: Mapping[str, Any]) -> ComponentEnergy:
    """Read the energies of a component from a snapshot."""
    return ComponentEnergy(
        ranges={kind: _numbers(saved["ranges"][kind], 2) for kind in KINDS},
        first=_numbers(saved["first"], 3),
        last=_numbers(saved["last"], 3),
        dissipates=like(True, saved["dissipates"]),
        largest_excess=like(0.0, saved["largest_excess"]),
    )


def _numbers(values: Any, count: int) -> list[float]:
    """So many numbers of a snapshot, in which anything may be."""
    if len(values) != count:
        raise ValueError(f"{count} numbers expected, found {len(values)}")
    return [like(0.0, value) for value in values]
