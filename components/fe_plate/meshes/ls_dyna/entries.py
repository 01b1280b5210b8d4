"""Nodes, solids, shells, parts and sets of LS-DYNA keyword files, by their numbers there.

Source: LS-DYNA Keyword User's Manual, volume I: *NODE, *ELEMENT_SOLID, *ELEMENT_SHELL, *PART,
*SET_NODE, *SET_PART, *SET_SOLID.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

from quintet.components.fe_plate.meshes.ls_dyna.cards import Block, Card

OF_NODE = (8, 16, 16, 16, 8, 8)
OF_ELEMENT = (8,) * 10
OF_OTHERS = (10,) * 8
SETS = {"SET_NODE": "set", "SET_PART": "part set", "SET_SOLID": "solid set"}
SET_OPTIONS = {"LIST", "TITLE", "GENERATE"}
# By the number of different nodes.
DEGENERATE = {4: "a tetrahedron with its nodes in another order", 5: "a pyramid", 6: "a wedge"}
SOLIDS = ("ELEMENT_SOLID", "ELEMENT_SOLID_TET4TOTET10")
# Places of the four nodes of a tetrahedron in the eight of a solid; later ones are repeated.
FOUR_OF_EIGHT = ((0, 1, 2, 3, 3, 3, 3, 3), (0, 1, 2, 2, 3, 3, 3, 3))


class Element(NamedTuple):
    """A solid or a shell."""

    part: int
    nodes: list[int]
    card: Card


class Listed(NamedTuple):
    """A set, by what it lists."""

    title: str
    ranges: list[tuple[int, int]]  # first and last number
    generated: bool  # ranges need not be full
    card: Card


@dataclass
class Entries:
    """All that is read of a file."""

    nodes: dict[int, tuple[list[float], Card]] = field(default_factory=dict)  # in units of the file
    solids: dict[int, Element] = field(default_factory=dict)
    shells: dict[int, Element] = field(default_factory=dict)
    titles: dict[int, str] = field(default_factory=dict)  # of parts
    sets: dict[tuple[str, int], Listed] = field(default_factory=dict)  # by kind and number
    constrained: int = 0  # nodes with constraints of their own


def read_entries(block: Block, entries: Entries) -> bool:
    """Read a block, if it is one of nodes, elements, parts or sets; return whether it is."""
    kind, *options = block.keyword.split("_")
    head = "_".join([kind, *options[:1]])
    if block.keyword == "NODE":
        _nodes(block, entries)
    elif block.keyword in SOLIDS:
        _solids(block, entries)
    elif block.keyword == "ELEMENT_SHELL":
        for card in filled(block):
            number, part, *nodes = _wholes(card, OF_ELEMENT[:6], "EID PID N1 N2 N3 N4")
            _add(entries.shells, number, Element(part, nodes, card), "shell")
    elif block.keyword == "PART":
        _parts(block, entries)
    elif head in SETS and set(options[1:]) <= SET_OPTIONS:
        _set(block, SETS[head], set(options[1:]), entries)
    else:
        return False
    return True


def filled(block: Block) -> Iterator[Card]:
    """Cards of a block that are not blank."""
    return (card for card in block.cards if card.text.strip())


def _nodes(block: Block, entries: Entries) -> None:
    for card in filled(block):
        number, *place, translations, rotations = card.fields(OF_NODE)[:6]
        key = card.whole(number, "NID")
        value = card.numbers(place, "X Y Z"), card
        if key in entries.nodes:
            finding = f"two {key}, the first on line {entries.nodes[key][1].line}"
            card.refuse("nodes must have different numbers", finding, "Renumber them.")
        entries.nodes[key] = value
        if card.number(translations, "TC") or card.number(rotations, "RC"):
            entries.constrained += 1


def _solids(block: Block, entries: Entries) -> None:
    """Solids on one line each, or on two: number and part, then up to ten nodes."""
    cards = filled(block)
    for card in cards:
        number, part, *nodes = _wholes(card, OF_ELEMENT, "EID PID N1 N2 N3 N4 N5 N6 N7 N8")
        if not any(nodes):
            second = next(cards, None)
            if second is None:
                rule = "a solid must have nodes, on its line or on the next"
                card.refuse(rule, "none", "Complete it.")
            nodes = _wholes(second, OF_ELEMENT, "N1 N2 N3 N4 N5 N6 N7 N8 N9 N10")
        nodes = nodes if any(nodes[8:]) else nodes[:8]
        _add(entries.solids, number, Element(part, nodes, card), "solid")


def tetrahedron_of(solid: Element) -> list[int]:
    """Nodes of a tetrahedron, ten or four, as a solid of LS-DYNA has them; none of others."""
    nodes = [node for node in solid.nodes if node]
    if len(nodes) == 10 and len(set(nodes)) == 10:
        return nodes
    four = list(dict.fromkeys(nodes))
    orders = [[four[k] for k in order] for order in FOUR_OF_EIGHT] if len(four) == 4 else []
    if len(nodes) == 4 == len(four):
        return four
    # Ten columns may repeat the last node too.
    return four if nodes[:8] in orders and set(nodes[8:]) <= {four[3]} else []


def require_eight_nodes(number: int, solid: Element) -> None:
    """Refuse a solid that is written with 8 nodes, but is another one."""
    different = len({node for node in solid.nodes if node})
    if different == 8 and len(solid.nodes) == 8 and all(solid.nodes):
        return
    finding = DEGENERATE.get(different, f"one of {different} different nodes")
    cure = "Mesh it with 8-node solids or tetrahedra alone, or choose other parts."
    rule = f"solid {number} must have 8 different nodes, or those of a tetrahedron"
    solid.card.refuse(rule, finding, cure)


def _parts(block: Block, entries: Entries) -> None:
    """Parts: a title, then a card of numbers, and so on."""
    cards = list(block.cards)
    while cards and not cards[-1].text.strip():
        cards.pop()
    for title, card in zip(cards[::2], cards[1::2], strict=False):
        number = card.whole(card.fields(OF_OTHERS)[0], "PID")
        entries.titles[number] = title.text.strip()
    if len(cards) % 2:
        cards[-1].refuse("a title of *PART must have a card below it", "none", "Complete it.")


def _set(block: Block, kind: str, options: set[str], entries: Entries) -> None:
    cards = list(block.cards)
    title = cards.pop(0).text.strip() if "TITLE" in options and cards else ""
    cards = [card for card in cards if card.text.strip()]
    if not cards:
        block.head.refuse("a set must have a number", "none", "Complete it, or remove it.")
    first = cards.pop(0)
    number = first.whole(first.fields(OF_OTHERS)[0], "SID")
    ranges: list[tuple[int, int]] = []
    for card in cards:
        listed = _wholes(card, OF_OTHERS, "1 2 3 4 5 6 7 8")
        if "GENERATE" in options:
            pairs = zip(listed[::2], listed[1::2], strict=True)
            ranges += [pair for pair in pairs if any(pair)]
        else:
            ranges += [(member, member) for member in listed if member]
    if (kind, number) in entries.sets:
        finding = f"two {number}, the first on line {entries.sets[kind, number].card.line}"
        first.refuse("sets of a kind must have different numbers", finding, "Renumber them.")
    entries.sets[kind, number] = Listed(title, ranges, "GENERATE" in options, first)


def _wholes(card: Card, widths: tuple[int, ...], names: str) -> list[int]:
    """Whole numbers of some fields, which have names in one text."""
    pairs = zip(card.fields(widths), names.split(), strict=False)
    return [card.whole(field, name) for field, name in pairs]


def _add(elements: dict[int, Element], number: int, element: Element, kind: str) -> None:
    if number in elements:
        finding = f"two {number}, the first on line {elements[number].card.line}"
        element.card.refuse(f"{kind}s must have different numbers", finding, "Renumber them.")
    elements[number] = element
