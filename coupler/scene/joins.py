"""What kinds say and refuse of joined ports and partners, before a component is built."""

from collections.abc import Iterator, Mapping

from quintet.coupler.coupling.exchange import Exchange
from quintet.coupler.coupling.link import Link
from quintet.coupler.scene.scene import ComponentPlan
from quintet.interfaces.component import Fields
from quintet.interfaces.errors import SceneError


def refused_joins(
    components: Mapping[str, ComponentPlan],
    links: list[Link],
    initial: Mapping[str, Fields],
    begun: set[str],
) -> Iterator[str]:
    """Yield what the kinds of components refuse of their joined ports.

    Parameters
    ----------
    components
        By their names.
    links
        Of the scene.
    initial
        What linked components state before they are built.
    begun
        Components that begin from another run: nothing is said of them and of their partners.
    """
    if any(component.unread for component in components.values()):  # nor are their links
        return
    ports = {name: (component.takes, component.gives) for name, component in components.items()}
    exchange = Exchange(links, ports)
    unknown = {name for link in links if not begun.isdisjoint(link.ends) for name in link.ends}
    for name, component in components.items():
        if component.manifest.joins is None or name in begun | unknown:
            continue
        static, joined = _described(name, links, exchange, initial), exchange.joined(name)
        try:
            component.manifest.joins(component.checked, static, frozenset(joined))
        except SceneError as error:
            yield from (f"components.{name}: {mistake}" for mistake in error.mistakes)


def refused_partners(
    components: Mapping[str, ComponentPlan], links: list[Link], begun: set[str]
) -> Iterator[str]:
    """Yield what the kinds of components refuse of their partners."""
    for component, partner in _meetings(components, links, begun):
        try:
            if component.manifest.meets:
                component.manifest.meets(component.checked, partner.surroundings())
        except SceneError as error:
            yield from (f"components.{component.name}: {mistake}" for mistake in error.mistakes)


def partner_notes(
    components: Mapping[str, ComponentPlan], links: list[Link]
) -> dict[str, list[str]]:
    """Sentences of components about their partners, by their names."""
    begun = {name for name, component in components.items() if component.begun}
    notes: dict[str, list[str]] = {}
    for component, partner in _meetings(components, links, begun):
        if component.manifest.meeting_notes:
            notes.setdefault(component.name, []).extend(
                component.manifest.meeting_notes(component.checked, partner.surroundings())
            )
    return notes


def _meetings(
    components: Mapping[str, ComponentPlan], links: list[Link], begun: set[str]
) -> Iterator[tuple[ComponentPlan, ComponentPlan]]:
    """Each component with each partner that has surroundings for it."""
    pairs = {
        (name, partner): None  # once, also where several links join them
        for link in links
        if begun.isdisjoint(link.ends)
        for name in sorted(link.ends)
        for partner in sorted(link.ends - {name})
    }
    for name, partner in pairs:
        if components[partner].manifest.surroundings:
            yield components[name], components[partner]


def _described(
    name: str, links: list[Link], exchange: Exchange, initial: Mapping[str, Fields]
) -> Fields:
    """Static fields of a component's partners, of the ports about which all partners state them.

    Links other than direct ones make static fields of samples, which need components.
    """
    # Start-up: only scenes with kinds that refuse joins load direct links for it.
    from quintet.coupler.coupling.links.direct import Direct

    direct = [link for link in links if isinstance(link, Direct) and name in link.ends]
    lacking = {
        key.partition(".")[0]
        for link in links
        if link not in direct
        for transfer in link.transfers
        if transfer.taker == name
        for key in transfer.fills
    }
    lacking |= {
        taken.name
        for link in direct
        for giver, giving, taker, taken in link.joined
        for field in taken.static
        if taker == name and f"{giving.name}.{field.name}" not in initial[giver]
    }
    merged = Exchange(direct, exchange.ports).bind(initial)[name]
    return {key: array for key, array in merged.items() if key.partition(".")[0] not in lacking}
