"""Initial velocities of LS-DYNA keyword files.

Source: LS-DYNA Keyword User's Manual, volume I: *INITIAL_VELOCITY, _NODE, _GENERATION. Later cards
replace earlier ones; rotations of nodes mean nothing to solids.
"""

from collections.abc import Callable

import numpy as np

from quintet.components.fe_plate.meshes.arrays import Array, Whole
from quintet.components.fe_plate.meshes.ls_dyna.cards import Block, Card
from quintet.components.fe_plate.meshes.ls_dyna.entries import OF_OTHERS, filled

KEYWORDS = ("INITIAL_VELOCITY", "INITIAL_VELOCITY_NODE", "INITIAL_VELOCITY_GENERATION")
STYPES = {1: "part set", 2: "part", 3: "set"}
NODE = "node"
NodesOf = Callable[[str, int, Card], Whole]  # rows of the nodes of a kind and a number


def velocities(blocks: list[Block], points: Array, nodes_of: NodesOf) -> Array | None:
    """Velocities (p, 3) of points (p, 3), in units of the file; None if it has none."""
    if not blocks:
        return None
    heads = {block.keyword: block.head for block in blocks}
    if len(heads) > 1 and KEYWORDS[2] in heads:
        rule = "*INITIAL_VELOCITY_GENERATION must stand without other keywords of velocities"
        heads[KEYWORDS[2]].refuse(rule, " and ".join(sorted(heads)), "Use one of them.")
    velocity = np.zeros_like(points)
    # Those of single nodes replace those of sets.
    for block in sorted(blocks, key=lambda block: KEYWORDS.index(block.keyword)):
        cards = list(filled(block))
        if block.keyword == KEYWORDS[1]:
            for card in cards:
                number, *rest = card.fields(OF_OTHERS)
                _require_zero(card, rest[6], "ICID")
                row = nodes_of(NODE, card.whole(number, "NID"), card)
                velocity[row] = card.numbers(rest[:3], "VX VY VZ")
        elif block.keyword == KEYWORDS[0]:
            _of_set(cards, velocity, nodes_of)
        else:
            _generated(block, cards, points, velocity, nodes_of)
    return velocity


def _of_set(cards: list[Card], velocity: Array, nodes_of: NodesOf) -> None:
    """*INITIAL_VELOCITY: a set or all nodes, but for those of a second set."""
    while cards:
        card = cards.pop(0)
        chosen, exempt, box, _, system, *_ = card.fields(OF_OTHERS)
        _require_zero(card, box, "BOXID")
        _require_zero(card, system, "ICID")
        second = card.whole(exempt, "NSIDEX")
        number = card.whole(chosen, "NSID")
        rows: Whole = nodes_of("set", number, card) if number else np.arange(len(velocity))
        excepted = nodes_of("set", second, card) if second else rows[:0]
        rows = np.setdiff1d(rows, excepted)
        velocity[rows] = _vector(card, cards, "VX VY VZ")
        if second:
            velocity[excepted] = _vector(card, cards, "VXE VYE VZE")


def _vector(above: Card, cards: list[Card], names: str) -> list[float]:
    if not cards:
        above.refuse("a card of velocities must follow", "none", "Complete it.")
    card = cards.pop(0)
    return card.numbers(card.fields(OF_OTHERS)[:3], names)


def _generated(
    block: Block, cards: list[Card], points: Array, velocity: Array, nodes_of: NodesOf
) -> None:
    """*INITIAL_VELOCITY_GENERATION: a velocity and a rotation about an axis, v + ω n x (x - c)."""
    if len(cards) % 2:
        rule = "*INITIAL_VELOCITY_GENERATION has two cards for each velocity"
        block.head.refuse(rule, f"{len(cards)} in all", "Complete them.")
    for first, second in zip(cards[::2], cards[1::2], strict=True):
        number, kind, omega, *mean, _, system = first.fields(OF_OTHERS)[:8]
        *axis, phase, _ = second.fields(OF_OTHERS)[:8]
        _require_zero(first, system, "ICID")
        _require_zero(second, phase, "PHASE")
        chosen, stype = first.whole(number, "ID"), first.whole(kind, "STYP")
        if chosen and stype not in STYPES:
            rule = "STYP must be 1, 2 or 3: set of parts, part, set of nodes"
            first.refuse(rule, kind or "none", "Correct it.")
        every: Whole = np.arange(len(points))
        rows = nodes_of(STYPES[stype], chosen, first) if chosen else every
        velocity[rows] = first.numbers(mean, "VX VY VZ")
        rate = first.number(omega, "OMEGA")
        if rate:
            place = np.array(second.numbers(axis, "XC YC ZC NX NY NZ"))
            centre, along = place[:3], place[3:]
            length = float(np.linalg.norm(along))
            if along[0] == -999.0 or not length:
                rule = "the axis of a rotation must be given by its direction NX, NY, NZ"
                second.refuse(rule, f"{along.tolist()}", "Give its components.")
            velocity[rows] += rate * np.cross(along / length, points[rows] - centre)


def _require_zero(card: Card, field: str, name: str) -> None:
    if card.number(field, name):
        rule = f"{name} of initial velocities is not read and must be 0"
        card.refuse(rule, field, "Set the part's velocity in the scene, and remove it here.")
