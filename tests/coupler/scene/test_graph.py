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
    picture, lines = drawing(scene), drawing(scene).splitlines()
    components = scene.components.values()
    for component in components:
        assert f"┌ {component.name}: {component.kind} " in picture
    ports = [("takes", port) for component in components for port in component.takes]
    ports += [("gives", port) for component in components for port in component.gives]
    rows = re.findall(r"^│ (takes|gives) (\w+) ", picture, re.MULTILINE)
    assert sorted(rows) == sorted((way, port.name) for way, port in ports)
    links = list(edges(scene))
    for link in links:
        giver, taker = f"{link.giver}.{link.giving_port}", f"{link.taker}.{link.taking_port}"
        assert f"{link.link}: {giver} → {taker}" in lines
    assert picture.count("◄") == len({(link.taker, link.taking_port) for link in links})


def follow(lines, row, column):
    """Walk along a line from where it leaves a box; return the rows in which it ends."""
    ways = {"─": "lr", "│": "ud", "┐": "ld", "┘": "lu", "┤": "udl", "┼": "udlr", "┬": "ldr",
            "┴": "lur", "◄": "r"}  # fmt: skip
    steps = {"l": (0, -1, "r"), "r": (0, 1, "l"), "u": (-1, 0, "d"), "d": (1, 0, "u")}
    visited, queue, ends = set(), [(row, column, "l")], set()
    while queue:
        position = queue.pop()
        if position in visited:
            continue
        visited.add(position)
        y, x, side = position
        sign = lines[y][x] if x < len(lines[y]) else " "
        assert side in ways[sign] or sign == "◄", (y, x, sign)
        if sign == "◄":
            ends.add(y)
            continue
        # Lines that cross go straight on.
        onward = {"l": "r", "r": "l", "u": "d", "d": "u"}[side] if sign == "┼" else ways[sign]
        queue += [(y + steps[w][0], x + steps[w][1], steps[w][2]) for w in onward if w != side]
    return ends


def test_lines_lead_from_port_to_port():
    scene = load("dam_break_cubes")
    lines = drawing(scene).splitlines()
    for name, target in (("gives motion", "takes surface"), ("gives surface_load", "takes load")):
        row = next(number for number, line in enumerate(lines) if name in line)
        end = next(number for number, line in enumerate(lines) if re.search(rf"{target} ", line))
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


@pytest.mark.parametrize(
    ("option", "beginning"), [("--graph", "┌ lower"), ("--mermaid", "flowchart")]
)
def test_check_draws_instead_of_the_plan(capsys, option, beginning):
    with pytest.raises(SystemExit) as exit_info:
        main(["check", "two_springs", option])
    assert exit_info.value.code == 0 and capsys.readouterr().out.startswith(beginning)
