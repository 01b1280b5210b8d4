"""The list of scenes, and the plan of one scene."""

import io
import json
import math
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from rich.console import Console
from rich.table import Table

from quintet.coupler.coupling.plan import CouplingPlan
from quintet.coupler.coupling.windows import auto_length, count_windows
from quintet.coupler.measures.advice import sentences
from quintet.coupler.measures.expectation import ROUNDING, Expectation
from quintet.coupler.scene.foreign_code import unread_note
from quintet.coupler.scene.joins import partner_notes
from quintet.coupler.scene.planned_times import planned_advice, planned_load
from quintet.coupler.scene.read import library, parse
from quintet.coupler.scene.scene import ComponentPlan, Scene, SceneFile
from quintet.interfaces.component import Port, port_text

UNWRAPPED = 10_000  # characters, more than any line has


def console() -> Console:
    """The console that tables are printed on; where there is no terminal no line is wrapped."""
    width = None if sys.stdout.isatty() else UNWRAPPED
    return Console(width=width, highlight=False, markup=False)


def list_all(as_json: bool) -> None:
    """Print the scenes that come with quintet: name, title, components, presets, run times."""
    rows = [_row(name, parse(path)) for name, path in library().items()]
    if as_json:
        print(json.dumps(rows, indent=2))
    else:
        print_list(rows, console())


def print_list(rows: list[dict[str, Any]], screen: Console) -> None:
    """Print scenes in groups of the kinds that they couple, single kinds first."""
    groups: dict[tuple[str, ...], list[dict[str, Any]]] = {}
    for row in rows:
        names = {component.partition(": ")[2] for component in row["components"]}
        groups.setdefault(tuple(sorted(names)), []).append(row)
    widest = max(len(row["scene"]) for row in rows)
    for kinds in sorted(groups, key=lambda kinds: (len(kinds), kinds)):
        screen.print("\n" + " and ".join(kinds), style="bold")
        table = Table(box=None, show_header=False, pad_edge=False)
        table.add_column(no_wrap=True, min_width=widest)
        table.add_column(overflow="fold", ratio=1)
        for row in groups[kinds]:
            (_, minutes), *presets = row["presets"].items()
            title = f"{row['title']} ({minutes:g} min)" if minutes else row["title"]
            others = [f"{name} ({time:g})" if time else name for name, time in presets]
            more = f"; presets {', '.join(others)}" if others else ""
            table.add_row(row["scene"], title + more)
        screen.print(table)


def _row(name: str, table: dict[str, Any]) -> dict[str, Any]:
    presets = {"": table.get("minutes", 0.0)}
    for preset, settings in table.get("presets", {}).items():
        presets[preset] = settings.get("minutes", 0.0)
    presets = {name or "(none)": minutes for name, minutes in presets.items()}
    components = table.get("components", {}).items()
    kinds = [f"{component}: {keys['kind']}" for component, keys in components]
    return {"scene": name, "title": table.get("title", ""), "components": kinds, "presets": presets}


@dataclass(frozen=True, slots=True)
class Plan:
    """A checked scene, and what running it will need."""

    scene: Scene

    def __str__(self) -> str:
        screen = Console(file=io.StringIO(), width=UNWRAPPED, highlight=False, markup=False)
        print_plan(self.scene, screen)
        return screen.file.getvalue()  # type: ignore[attr-defined]

    def __repr__(self) -> str:
        return str(self)


def print_plan(scene: Scene, console: Console) -> None:
    """Print processes, ports, windows, message sizes, memory and expected time."""
    file = scene.file
    console.print(f"{file.name}: {file.title}", style="bold")
    console.print(f"{file.end:g} s over {scene.transport}; {_processes(scene)}")
    for line in _windows(scene, scene.coupling):
        console.print(line)
    table = Table(box=None, pad_edge=False)
    shared = any(plan.ranks > 1 for plan in scene.components.values())
    cores = ("ranks", "threads") if shared else ("threads",)
    for head in ("component", "kind", *cores, "items", "step", "memory", "time"):
        table.add_column(head)
    for plan in scene.components.values():
        numbers = [str(getattr(plan, head)) for head in cores]
        table.add_row(plan.name, plan.kind, *numbers, *_needs(plan, file))
    console.print(table)
    for line in _advice(scene):
        console.print(line)
    for note in unread_notes(scene):
        console.print(note)
    of_partners = partner_notes(scene.components, scene.links)
    for plan in (plan for plan in scene.components.values() if not plan.unread):
        console.print(f"{plan.name} takes {_names(plan.takes)}; gives {_names(plan.gives)}")
        notes = plan.planned.notes if plan.planned else ()
        for note in (*notes, *of_partners.get(plan.name, ())):
            console.print(f"note of {plan.name}: {note}")
    for link in scene.links:
        for one_way in link.transfers:
            console.print(f"link {link.name}: {one_way.giver} -> {one_way.taker}")
    for expected in scene.expect:
        late = beyond(expected, file.end)
        console.print(f"expects {expected.name} within {expected.within:g} {expected.unit}{late}")


def beyond(expected: Expectation, end: float) -> str:
    """What a plan says of an expectation that a run will not reach."""
    last = expected.begin if expected.end is None else expected.end
    if last <= end * (1.0 + ROUNDING):
        return ""
    return f": not reached, as it needs t = {last:g} s and the run ends at {end:g} s"


def unread_notes(scene: Scene) -> list[str]:
    """What was not checked of a scene, as it is code that was not imported."""
    names: dict[str, list[str]] = {}
    for plan in scene.components.values():
        if plan.unread:
            names.setdefault(plan.kind, []).append(plan.name)
    return [unread_note(of_kind, kind) for kind, of_kind in names.items()]


def tell_unread(scene: Scene) -> None:
    """Print the same where something else is printed for programs."""
    for note in unread_notes(scene):
        print(f"quintet: {note}", file=sys.stderr)


def _windows(scene: Scene, plan: CouplingPlan) -> Iterator[str]:
    """Members, scheme and windows of a coupling and its groups; steps are estimates."""
    exchange = scene.exchange()
    where = f"group {plan.name}" if plan.name else "run"
    members = ", ".join(plan.members)
    plans = {name: component.planned for name, component in scene.components.items()}
    steps = {
        n: planned.dt
        for n, planned in plans.items()
        if planned is not None and math.isfinite(planned.dt)
    }
    joined = {name for ends in plan.transfers(exchange).values() for name in ends}
    equal = plan.equal(exchange)
    known = [steps[name] for name in joined or set(plan.members) if name in steps]
    length, why = auto_length(known, [steps[name] for name in equal if name in steps])
    about = f"about {length:.2g} s (estimated), {why}" if known else "as far as the members allow"
    if plan.window == "auto":
        windows = f"windows follow the state: {about}"
    elif equal:
        windows = f"windows follow the state, {plan.window:g} s at most: {about}"
    elif plan.name:
        windows = f"windows of {plan.window:g} s at most"
    else:
        count = count_windows(scene.file.end, plan.window)
        windows = f"{count} windows of {scene.file.end / count:g} s"
    yield f"{where}: {members}; {plan.scheme}; {windows}"
    for inner in plan.inner():
        yield from _windows(scene, inner)


def _processes(scene: Scene) -> str:
    ranks = sum(plan.ranks for plan in scene.components.values())
    count = 1 if scene.transport == "memory" else 1 + ranks
    return f"{count} process" + ("es, the coupler one of them" if count > 1 else "")


def _needs(component: ComponentPlan, file: SceneFile) -> tuple[str, str, str, str]:
    plan = component.planned
    if plan is None:
        return "", "", "", ""
    memory = f"{plan.items * plan.bytes_per_item / 1e6:.0f} MB" if plan.bytes_per_item else ""
    if math.isinf(plan.dt):
        return f"{plan.items}", "any", memory, ""
    seconds = planned_load(component, file).seconds
    return f"{plan.items}", f"{plan.dt:.2g} s", memory, f"{seconds:.0f} s"


def _advice(scene: Scene) -> list[str]:
    """Who will wait for whom, and the threads for the shortest run here, by the kinds' plans."""
    advised = planned_advice(scene)
    if not advised["seconds"]:
        return []
    return [f"{text}; planned, not measured" for text in sentences(advised)]


def _names(ports: tuple[Port, ...]) -> str:
    return "; ".join(map(port_text, ports)) or "nothing"
