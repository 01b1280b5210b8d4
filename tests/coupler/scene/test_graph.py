"""``quintet check --graph`` draws every component, port and link; ``--mermaid`` writes the same."""

import re

import pytest
from started import write_scene

from quintet.coupler.cli import main
from quintet.coupler.scene.graph import drawing, edges, mermaid
from quintet.coupler.scene.read import library, load

CUBES = """\
┌ cubes: dem_bodies ─┐
│ takes load         │◄──────┐
│ gives motion       │────┐  │
└────────────────────┘    │  │
┌ water: sph_fluid ──┐    │  │
│ takes surface      │◄───┘  │
│ gives surface_load │───────┘
└────────────────────┘
water-cubes: cubes.motion → water.surface
water-cubes: water.surface_load → cubes.load"""


def test_a_box_for_each_component_and_a_line_for_each_way_of_a_link():
    assert drawing(load("dam_break_cubes")) == CUBES


@pytest.mark.parametrize("name", library())
def test_all_components_ports_and_links_are_drawn(name):
    scene = load(name)
    drawn, lines = drawing(scene), drawing(scene).splitlines()
    for one in scene.components.values():
        assert f"┌ {one.name}: {one.kind} " in drawn
    told = [("takes", port) for one in scene.components.values() for port in one.takes]
    told += [("gives", port) for one in scene.components.values() for port in one.gives]
    rows = re.findall(r"^│ (takes|gives) (\w+) ", drawn, re.MULTILINE)
    assert sorted(rows) == sorted((way, port.name) for way, port in told)
    found = list(edges(scene))
    for one in found:
        assert f"{one.link}: {one.giver}.{one.giving_port} → {one.taker}.{one.taking_port}" in lines
    assert drawn.count("◄") == len({(one.taker, one.taking_port) for one in found})


def follow(lines, row, column):
    """Walk along a line from where it leaves a box; return the rows in which it ends."""
    ways = {"─": "lr", "│": "ud", "┐": "ld", "┘": "lu", "┤": "udl", "┼": "udlr", "┬": "ldr",
            "┴": "lur", "◄": "r"}  # fmt: skip
    steps = {"l": (0, -1, "r"), "r": (0, 1, "l"), "u": (-1, 0, "d"), "d": (1, 0, "u")}
    seen, queue, ends = set(), [(row, column, "l")], set()
    while queue:
        at = queue.pop()
        if at in seen:
            continue
        seen.add(at)
        y, x, came = at
        sign = lines[y][x] if x < len(lines[y]) else " "
        assert came in ways[sign] or sign == "◄", (y, x, sign)
        if sign == "◄":
            ends.add(y)
            continue
        # Lines that cross go straight on.
        onward = {"l": "r", "r": "l", "u": "d", "d": "u"}[came] if sign == "┼" else ways[sign]
        queue += [(y + steps[w][0], x + steps[w][1], steps[w][2]) for w in onward if w != came]
    return ends


def test_lines_lead_from_port_to_port():
    scene = load("dam_break_cubes")
    lines = drawing(scene).splitlines()
    for name, taken in (("gives motion", "takes surface"), ("gives surface_load", "takes load")):
        row = next(n for n, line in enumerate(lines) if name in line)
        end = next(n for n, line in enumerate(lines) if re.search(rf"{taken} ", line))
        assert follow(lines, row, len("┌ cubes: dem_bodies ─┐")) >= {end}


def test_mermaid_has_a_node_for_each_component_and_an_arrow_for_each_way(tmp_path):
    path = write_scene(tmp_path, ping="", pong="")
    path.write_text(
        path.read_text().replace("end =", 'order = ["both"]\nend =')
        + '[groups.both]\nmembers = ["ping", "pong"]\n'
    )
    assert mermaid(load(str(path))).splitlines() == [
        "flowchart LR",
        '    c0["ping<br/>toys:Toy"]',
        '    c1["pong<br/>toys:Toy"]',
        '    subgraph group_both["both: serial"]',
        "    c0",
        "    c1",
        "    end",
        '    c0 -- "ping-pong: out → in" --> c1',
        '    c1 -- "ping-pong: out → in" --> c0',
    ]


@pytest.mark.parametrize(("option", "first"), [("--graph", "┌ lower"), ("--mermaid", "flowchart")])
def test_check_draws_instead_of_the_plan(capsys, option, first):
    with pytest.raises(SystemExit) as ended:
        main(["check", "two_springs", option])
    assert ended.value.code == 0 and capsys.readouterr().out.startswith(first)
