"""Who steps with whom: the coupling of a scene's components, and the groups in it."""

from collections import Counter
from collections.abc import Iterator
from typing import Any

from quintet.coupler.coupling import plan
from quintet.coupler.coupling.exchange import Exchange
from quintet.coupler.coupling.iteration.settings import unknown_fields
from quintet.coupler.coupling.link import Link
from quintet.coupler.coupling.plan import CouplingPlan
from quintet.coupler.measures.evaluation import lacking_items
from quintet.coupler.measures.expectation import Expectation
from quintet.coupler.scene.joins import refused_joins, refused_partners
from quintet.coupler.scene.scene import NAME, ComponentPlan, GroupSettings, SceneFile
from quintet.interfaces.component import Fields, lacked
from quintet.interfaces.params import read, shown, unknown


def lay_out(
    file: SceneFile, groups: Any, components: dict[str, ComponentPlan], mistakes: list[str]
) -> CouplingPlan | None:
    """Lay out who steps with whom: the run, and the groups in it."""
    settings = _groups(groups, components, mistakes)
    members = [name for group in settings.values() for name in group.members]
    for name, count in Counter(members).items():
        if count > 1:
            mistakes.append(f"groups: {name} is in {count} of them. Leave it in one.")
    for name, group in settings.items():
        known = [*components, *(other for other in settings if other != name)]
        for member in group.members:
            if member not in known:
                place = f"groups.{name}.members: {member}"
                mistakes.append(unknown(place, member, known))
    if mistakes:
        return None
    first = {member: name for name, group in settings.items() for member in group.members}
    steppers: dict[str, None] = {}  # components and groups that step with the run, in order
    for name in components:
        top = name
        while top in first:
            top = first[top]
        steppers[top] = None
    order = list(file.order) or list(steppers)
    if sorted(order) != sorted(steppers):
        mistakes.append(
            f"scene.order must name every component and group once ({', '.join(steppers)}); found "
            f"{', '.join(order)}."
        )
        return None

    def plan_of(name: str) -> CouplingPlan | None:
        if name not in settings:
            return None
        group = settings[name]
        inside = {member: plan_of(member) for member in group.members}
        return CouplingPlan(name, inside, group.scheme, group.window, group.iteration)

    inside = {name: plan_of(name) for name in order}
    return CouplingPlan("", inside, file.scheme, file.window, file.iteration)


def _groups(
    table: Any, components: dict[str, ComponentPlan], mistakes: list[str]
) -> dict[str, GroupSettings]:
    if not isinstance(table, dict) or not all(isinstance(part, dict) for part in table.values()):
        mistakes.append(f"groups must be tables; found {shown(table)}. Write [groups.NAME].")
        return {}
    groups = {}
    for name, keys in table.items():
        group, wrong = read(GroupSettings, keys, f"groups.{name}")
        mistakes += wrong
        if not NAME.fullmatch(name) or name in components:
            mistakes.append(
                f"groups: a name must be letters, digits, _ or -, and no component's; found "
                f"{name!r}. Rename it."
            )
        if group is not None:
            groups[name] = group
    _refuse_circles(groups, mistakes)
    return groups


def _refuse_circles(groups: dict[str, GroupSettings], mistakes: list[str]) -> None:
    """Refuse groups that are in themselves."""
    for name in groups:
        seen, inside = set(), list(groups[name].members)
        while inside:
            member = inside.pop()
            if member == name:
                mistakes.append(f"groups.{name}.members: it is in itself. Take it out.")
                return
            if member in groups and member not in seen:
                seen.add(member)
                inside += groups[member].members


def refused(
    coupling: CouplingPlan, components: dict[str, ComponentPlan], links: list[Link]
) -> list[str]:
    """What the links do not allow of schemes, orders and groups; fields that nobody takes."""
    ports = {name: (component.takes, component.gives) for name, component in components.items()}
    wrong = plan.mistakes(coupling, Exchange(links, ports))
    takes = {name: component.takes for name, component in components.items()}
    unread = [f"{name}." for name, component in components.items() if component.unread]

    def below(group: CouplingPlan) -> Iterator[CouplingPlan]:
        yield group
        for inner in group.inner():
            yield from below(inner)

    for group in below(coupling):
        where = f"groups.{group.name}.iteration" if group.name else "iteration"
        wrong += unknown_fields(group.iteration, takes, where, tuple(unread))
    return wrong


def begins_wrong(
    components: dict[str, ComponentPlan], all_links: list[Link], expect: list[Expectation]
) -> list[str]:
    """What links, kinds and expectations refuse of how components begin, as far as it is known.

    Of components that begin from another run that is found when their ports are joined.
    """
    begun = {name for name, component in components.items() if component.begun}
    links = [link for link in all_links if begun.isdisjoint(link.ends)]
    linked = [name for link in links for transfer in link.transfers for name in transfer.ends]
    initial: dict[str, Fields] = {}
    for name in dict.fromkeys([*linked, *(expectation.component for expectation in expect)]):
        try:
            initial[name] = components[name].initial()
        except Exception as error:  # of any kind: what it does here is its author's
            cause = f"{type(error).__name__}: {error}"
            return [f"components.{name}: its start cannot be computed ({cause}). Correct it."]
    refused = [text for link in links for text in link.refusals(initial)]
    refused += refused_joins(components, all_links, initial, begun)
    refused += refused_partners(components, links, begun)
    return [*refused, *lacking_items(expect, initial)]


def unknown_outputs(file: SceneFile, components: dict[str, ComponentPlan]) -> list[str]:
    """Refuse outputs to be recorded that no component gives, or to be drawn that none shows."""
    known = [
        f"{name}.{port.name}.{field.name}"
        for name, component in components.items()
        for port in component.gives
        for field in port.fields
    ]
    unread = tuple(f"{name}." for name, component in components.items() if component.unread)
    shown = [
        f"{name}.{field.name}"
        for name, component in components.items()
        for field in component.shows
    ]
    output = file.output
    lists = (
        ("fields", output.fields, known),
        ("watch", output.watch, known),
        ("colours", output.colours, shown),
    )

    def remedy(path: str) -> str:
        name, _, field = path.partition(".")
        return lacked(components[name].gives, field) if name in components else ""

    return [
        f"output.{key}: {path} is not given with these settings. {remedy(path)}"
        if remedy(path)
        else unknown(f"output.{key}: {path}", path, names)
        for key, paths, names in lists
        for path in paths
        if path not in names and not path.startswith(unread)
    ]


def nothing_to_watch(
    file: SceneFile, links: list[Link], expect: list[Expectation]
) -> Iterator[str]:
    """Say what an error bar lacks: links, quantities, or the recording of their curves."""
    if not file.error_bar.on:
        return
    if not links:
        yield "error_bar.on needs links, whose coupling errs; found none. Remove error_bar."
    if not expect and not file.output.watch:
        yield (
            "error_bar.on needs a quantity to watch; found none. Name a field in output.watch, or "
            "add [[expect]]."
        )
    if not file.output.record:
        yield "error_bar.on needs output.record = true; found false. Record the run."
    for link in links:
        demands = link.demands()
        if demands.relaxation or demands.settles:
            yield (
                f"error_bar.on needs links that step in time; link {link.name} is an iteration "
                "towards a state of rest. Remove error_bar."
            )
