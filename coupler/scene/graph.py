"""Components, their ports and the links between these, drawn as text or as a Mermaid flowchart."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product

from quintet.coupler.coupling.plan import CouplingPlan
from quintet.coupler.scene.scene import Scene

# Lines that leave a corner: up 1, down 2, left 4, right 8.
STROKES = dict(zip([3, 12, 6, 5, 7, 15, 14, 13], "│─┐┘┤┼┬┴", strict=True))


@dataclass(frozen=True, slots=True)
class Edge:
    """A port that fills another one over a link."""

    link: str
    giver: str
    given: str
    taker: str
    taken: str


def edges(scene: Scene) -> Iterator[Edge]:
    """Yield what fills what; ports are paired where a transfer has as many on both sides."""
    for link in scene.links:
        for one in link.transfers:
            given, taken = _ports(one.reads), _ports(one.fills)
            paired = zip(given, taken, strict=False)
            pairs = paired if len(given) == len(taken) else product(given, taken)
            for a, b in pairs:
                yield Edge(link.name, one.giver, a, one.taker, b)


def _ports(keys: tuple[str, ...]) -> list[str]:
    return list(dict.fromkeys(key.partition(".")[0] for key in keys))


def drawing(scene: Scene) -> str:
    """Draw a box for each component, its ports in it, and a line from port to port."""
    rows: list[str] = []
    place: dict[tuple[str, str, str], int] = {}  # component, "takes" or "gives", port -> row
    for name, one in scene.components.items():
        ports = [("takes", port.name) for port in one.takes]
        ports += [("gives", port.name) for port in one.gives]
        lines = [f"{way} {port}" for way, port in ports] or ["no ports"]
        width = max(len(f"{name}: {one.kind}") + 1, *map(len, lines)) + 1
        rows.append(f"┌ {name}: {one.kind} ".ljust(width + 2, "─") + "┐")
        for number, line in enumerate(lines):
            if ports:
                place[name, *ports[number]] = len(rows)
            rows.append(f"│ {line:<{width}}│")
        rows.append(f"└{'─' * (width + 1)}┘")
    found = list(edges(scene))
    ends = [(place[e.giver, "gives", e.given], place[e.taker, "takes", e.taken]) for e in found]
    text = _with_lines(rows, ends)
    told = [f"{e.link}: {e.giver}.{e.given} → {e.taker}.{e.taken}" for e in found]
    return "\n".join([*text, *told])


def _with_lines(rows: list[str], ends: list[tuple[int, int]]) -> list[str]:
    """Add a line beside the rows for each pair of a row where it starts and one where it ends.

    Short ones run inside; those that leave the same row, or meet in it, share what they can.
    """
    left = max(map(len, rows), default=0) + 2
    order = sorted(range(len(ends)), key=lambda n: abs(ends[n][0] - ends[n][1]))
    lanes: list[list[int]] = []  # of each lane, the lines in it
    for number in order:
        low, high = sorted(ends[number])
        for lane in lanes:
            if all(high < min(ends[o]) or low > max(ends[o]) for o in lane):
                lane.append(number)
                break
        else:
            lanes.append([number])
    strokes = [[0] * (3 * len(lanes)) for _ in rows]
    for column, lane in enumerate(lanes):
        for number in lane:
            (start, end), at = ends[number], 3 * column + 2
            low, high = sorted((start, end))
            for row in range(low, high + 1):
                strokes[row][at] |= (1 if row > low else 0) | (2 if row < high else 0)
            for row in (start, end):
                strokes[row][at] |= 4
                for left_of in range(at):
                    strokes[row][left_of] |= 12
    heads = {end for _, end in ends}
    joined = {row for pair in ends for row in pair}
    drawn = []
    for number, text in enumerate(rows):
        if number in joined:
            text += ("◄" if number in heads else "─") + "─" * (left - len(text) - 1)
        tail = "".join(STROKES.get(one, " ") for one in strokes[number])
        drawn.append((f"{text:<{left}}" + tail).rstrip())
    return drawn


def mermaid(scene: Scene) -> str:
    """Write the same as a Mermaid flowchart; groups are boxes around their members."""
    number = {name: f"c{n}" for n, name in enumerate(scene.components)}
    lines = ["flowchart LR"]
    for name, one in scene.components.items():
        lines.append(f'    {number[name]}["{name}<br/>{one.kind}"]')
    for depth, inner in enumerate(scene.coupling.inner()):
        lines += _subgraph(inner, number, f"g{depth}")
    for edge in edges(scene):
        said = f"{edge.link}: {edge.given} → {edge.taken}"
        lines.append(f'    {number[edge.giver]} -- "{said}" --> {number[edge.taker]}')
    return "\n".join(lines)


def _subgraph(plan: CouplingPlan, number: dict[str, str], mark: str) -> Iterator[str]:
    yield f'    subgraph {mark}["{plan.name}: {plan.scheme}"]'
    for name, inner in plan.members.items():
        if inner is None:
            yield f"    {number[name]}"
        else:
            yield from _subgraph(inner, number, f"{mark}_{len(mark)}")
    yield "    end"
