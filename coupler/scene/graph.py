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
    giving_port: str
    taker: str
    taking_port: str


def edges(scene: Scene) -> Iterator[Edge]:
    """Yield what fills what; ports are paired where a transfer has as many on both sides."""
    for link in scene.links:
        for transfer in link.transfers:
            giving, taken = _ports(transfer.reads), _ports(transfer.fills)
            paired = zip(giving, taken, strict=False)
            pairs = paired if len(giving) == len(taken) else product(giving, taken)
            for a, b in pairs:
                yield Edge(link.name, transfer.giver, a, transfer.taker, b)


def _ports(keys: tuple[str, ...]) -> list[str]:
    return list(dict.fromkeys(key.partition(".")[0] for key in keys))


def _box(title: str, lines: list[str]) -> list[str]:
    """Rows of a box with a title in its upper edge."""
    lines = lines or ["no ports"]
    width = max(len(title) + 1, *map(len, lines)) + 1
    within = [f"│ {line:<{width}}│" for line in lines]
    return [f"┌ {title} ".ljust(width + 2, "─") + "┐", *within, f"└{'─' * (width + 1)}┘"]


def drawing(scene: Scene) -> str:
    """Draw a box for each component, its ports in it, and a line from port to port."""
    rows: list[str] = []
    place: dict[tuple[str, str, str], int] = {}  # component, "takes" or "gives", port -> row
    for name, plan in scene.components.items():
        ports = [("takes", port.name) for port in plan.takes]
        ports += [("gives", port.name) for port in plan.gives]
        first = len(rows) + 1  # below the title
        place |= {(name, *port): first + number for number, port in enumerate(ports)}
        rows += _box(f"{name}: {plan.kind}", [f"{way} {port}" for way, port in ports])
    all_edges = list(edges(scene))
    ends = [
        (place[e.giver, "gives", e.giving_port], place[e.taker, "takes", e.taking_port])
        for e in all_edges
    ]
    lines_of_edges = [
        f"{e.link}: {e.giver}.{e.giving_port} → {e.taker}.{e.taking_port}" for e in all_edges
    ]
    return "\n".join([*_joined(rows, ends), *lines_of_edges])


def _joined(rows: list[str], ends: list[tuple[int, int]]) -> list[str]:
    """Add a line beside the rows for each pair of a row where it starts and one where it ends."""
    left = max(map(len, rows)) + 2
    heads = {end for _, end in ends}
    from_boxes = {row for pair in ends for row in pair}
    drawn = []
    for number, (text, strokes) in enumerate(zip(rows, _strokes(len(rows), ends), strict=True)):
        if number in from_boxes:
            text += ("◄" if number in heads else "─") + "─" * (left - len(text) - 1)
        tail = "".join(STROKES.get(stroke, " ") for stroke in strokes)
        drawn.append((f"{text:<{left}}" + tail).rstrip())
    return drawn


def _strokes(rows: int, ends: list[tuple[int, int]]) -> list[list[int]]:
    """For each row and column, the ways in which a line leaves it; see `STROKES`."""
    lanes = _lanes(ends)
    strokes = [[0] * (3 * len(lanes)) for _ in range(rows)]
    for column, lane in enumerate(lanes):
        at = 3 * column + 2
        for low, high in map(sorted, lane):
            for row in range(low, high + 1):
                strokes[row][at] |= (1 if row > low else 0) | (2 if row < high else 0)
            for row in (low, high):
                strokes[row][at] |= 4
                for nearer in range(at):
                    strokes[row][nearer] |= 12
    return strokes


def _lanes(ends: list[tuple[int, int]]) -> list[list[tuple[int, int]]]:
    """Share out lines among lanes, in which none lies beside another; short ones run inside."""
    lanes: list[list[tuple[int, int]]] = []
    for pair in sorted(ends, key=lambda pair: abs(pair[0] - pair[1])):
        for lane in lanes:
            if all(max(pair) < min(other) or min(pair) > max(other) for other in lane):
                lane.append(pair)
                break
        else:
            lanes.append([pair])
    return lanes


def mermaid(scene: Scene) -> str:
    """Write the same as a Mermaid flowchart; groups are boxes around their members."""
    number = {name: f"c{n}" for n, name in enumerate(scene.components)}
    lines = ["flowchart LR"]
    for name, plan in scene.components.items():
        lines.append(f'    {number[name]}["{name}<br/>{plan.kind}"]')
    for inner in scene.coupling.inner():
        lines += _subgraph(inner, number)
    for edge in edges(scene):
        label = f"{edge.link}: {edge.giving_port} → {edge.taking_port}"
        lines.append(f'    {number[edge.giver]} -- "{label}" --> {number[edge.taker]}')
    return "\n".join(lines)


def _subgraph(plan: CouplingPlan, number: dict[str, str]) -> Iterator[str]:
    yield f'    subgraph group_{plan.name}["{plan.name}: {plan.scheme}"]'
    for name, inner in plan.members.items():
        if inner is None:
            yield f"    {number[name]}"
        else:
            yield from _subgraph(inner, number)
    yield "    end"
