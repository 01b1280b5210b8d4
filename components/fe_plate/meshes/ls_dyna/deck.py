"""A mesh in an LS-DYNA keyword file: arrays and sets, from what the file lists by numbers."""

from collections import Counter
from pathlib import Path

import numpy as np

from quintet.components.fe_plate.meshes.arrays import Whole
from quintet.components.fe_plate.meshes.ls_dyna.cards import Block, Card, blocks
from quintet.components.fe_plate.meshes.ls_dyna.entries import (
    SETS,
    SOLIDS,
    Element,
    Entries,
    Listed,
    read_entries,
    require_eight_nodes,
    tetrahedron_of,
)
from quintet.components.fe_plate.meshes.ls_dyna.velocities import KEYWORDS, velocities
from quintet.components.fe_plate.meshes.source import FOUR_NODES as TETRA
from quintet.components.fe_plate.meshes.source import HEXAHEDRON, TETRAHEDRON, Cells, Source

KINDS = (HEXAHEDRON, TETRAHEDRON, TETRA)
SUFFIXES = (".k", ".key")
SILENT = ("KEYWORD", "TITLE")


def read_deck(path: Path) -> Source:
    """Read nodes, solids, shells, parts, sets and initial velocities of a file."""
    entries, moving = Entries(), list[Block]()
    skipped, foreign = Counter[str](), Counter[str]()
    for block in blocks(path):
        if block.keyword in KEYWORDS:
            moving.append(block)
        elif block.keyword.startswith("ELEMENT_SOLID_") and block.keyword not in SOLIDS:
            rule = "solids must be *ELEMENT_SOLID, or tetrahedra of *ELEMENT_SOLID_TET4TOTET10"
            block.head.refuse(rule, f"*{block.keyword}", "Mesh it with these.")
        elif read_entries(block, entries) or block.keyword in SILENT:
            continue
        elif block.keyword.startswith("ELEMENT_"):
            foreign[f"*{block.keyword}"] += 1
        else:
            skipped[f"*{block.keyword}"] += 1
    return _Numbers(path.name, entries).source(moving, skipped, foreign)


class _Numbers:
    """Rows of arrays by the numbers in a file."""

    def __init__(self, name: str, entries: Entries) -> None:
        self.name, self.entries = name, entries
        self.node_row = {number: row for row, number in enumerate(entries.nodes)}
        self.node_ids = np.array(list(entries.nodes), np.int64)
        self.solid_ids = np.array(list(entries.solids), np.int64)
        self.part = np.array([solid.part for solid in entries.solids.values()], np.int64)
        shells = [shell.part for shell in entries.shells.values()]
        self.part_ids = np.union1d(self.part, np.array([*shells, *entries.titles], np.int64))
        # (e, 10), -1 where there is none; of tetrahedra their four or ten nodes come first
        solids = entries.solids
        tetrahedra = {number: tetrahedron_of(solid) for number, solid in solids.items()}
        # (e,) nodes of tetrahedra, 0 of hexahedra
        self.tetrahedra = np.array([len(nodes) for nodes in tetrahedra.values()], np.int64)
        chosen = {
            k: solid._replace(nodes=tetrahedra[k] or solid.nodes) for k, solid in solids.items()
        }
        self.corner = self._corners(chosen, 10)

    def _corners(self, elements: dict[int, Element], count: int) -> Whole:
        """Rows (e, c) of the nodes of elements; -1 where a number is 0."""
        row, corner = self.node_row, np.full((len(elements), count), -1)
        for rows, element in zip(corner, elements.values(), strict=True):
            for number in element.nodes:
                if number and number not in row:
                    rule = "an element must have nodes of the file"
                    element.card.refuse(rule, f"{number}, which is none", "Add or correct it.")
            nodes = element.nodes[:count]
            rows[: len(nodes)] = [row.get(number, -1) for number in nodes]
        return corner

    def source(self, moving: list[Block], skipped: Counter[str], foreign: Counter[str]) -> Source:
        """Return the mesh as other readers do."""
        places = [place for place, _ in self.entries.nodes.values()]
        points = np.array(places, np.float64).reshape(-1, 3)
        kinds = [np.flatnonzero(self.tetrahedra == nodes) for nodes in (0, 10, 4)]
        cells = [
            Cells(kind, 3, self.corner[rows, :nodes])
            for kind, rows, nodes in zip(KINDS, kinds, (8, 10, 4), strict=True)
        ]
        shells = self._corners(self.entries.shells, 4)
        if len(shells):
            cells.append(Cells("quad", 2, shells))
        sets, notes = self._named_sets()
        groups, more = self._named_groups()
        notes += more
        if skipped:
            text = ", ".join(f"{count} {key}" for key, count in sorted(skipped.items()))
            notes.append(f"mesh {self.name}: these keywords are not read: {text}.")
        if count := self.entries.constrained:
            notes.append(
                f"mesh {self.name}: {count} nodes have constraints TC or RC, which are not read; "
                "hold nodes by fixed."
            )
        return Source(
            points,
            cells,
            sets,
            {
                key: [
                    *[np.searchsorted(kind, rows[np.isin(rows, kind)]) for kind in kinds],
                    *[None] * (len(cells) - len(kinds)),
                ]
                for key, rows in groups.items()
            },
            velocities(moving, points, self.nodes_of),
            tuple(notes),
            dict(foreign),
            self.require_eight_nodes,
        )

    def require_eight_nodes(self, rows: Whole) -> None:
        """Refuse hexahedra, by their rows, that have other numbers of nodes."""
        rows = np.flatnonzero(self.tetrahedra == 0)[rows]
        corner = self.corner[rows]
        corner[(corner[:, 8:] >= 0).any(axis=1)] = -1  # found below
        ordered = np.sort(corner[:, :8], axis=1)
        wrong = (ordered[:, 0] < 0) | (ordered[:, 1:] == ordered[:, :-1]).any(axis=1)
        if wrong.any():
            number = int(self.solid_ids[rows[np.argmax(wrong)]])
            require_eight_nodes(number, self.entries.solids[number])

    def nodes_of(self, kind: str, number: int, card: Card) -> Whole:
        """Rows of the nodes of a node, a part, or a set of nodes or of parts."""
        if kind == "node":
            if number not in self.node_row:
                card.refuse("NID must be a node of the file", f"{number}", "Correct it.")
            return np.array([self.node_row[number]])
        if kind == "part":
            if number not in self.part_ids:
                rule = "a velocity must be of a part of the file"
                card.refuse(rule, f"{number}, which is none", "Correct it, or add the part.")
            return _nodes_at(self.corner[self.part == number])
        if (kind, number) not in self.entries.sets:
            what = "set of nodes" if kind == "set" else "set of parts"
            rule = f"a velocity must be of a {what} of the file"
            card.refuse(rule, f"{number}, which is none", "Correct it, or add the set.")
        listed = self.entries.sets[kind, number]
        if kind == "set":
            return _members(listed, self.node_ids, "node")
        if not len(_members(listed, self.part_ids, "part")):
            rule = "a velocity must be of parts of the file"
            card.refuse(rule, f"part set {number}, which lists none", "Correct it, or add a part.")
        return _nodes_at(self.corner[_members(listed, self.part, "")])

    def _named_sets(self) -> tuple[dict[str, Whole], list[str]]:
        """Sets of nodes by their titles and numbers."""
        named = [
            (f"{number}", listed.title, _members(listed, self.node_ids, "node"))
            for (kind, number), listed in self.entries.sets.items()
            if kind == "set"
        ]
        return self._named(named)

    def _named_groups(self) -> tuple[dict[str, Whole], list[str]]:
        """Solids of parts and of sets by their titles and numbers."""
        named = []
        for number in np.unique(self.part).tolist():
            title = self.entries.titles.get(number, "")
            named.append((f"part {number}", title, np.flatnonzero(self.part == number)))
        for (kind, number), listed in self.entries.sets.items():
            if kind == SETS["SET_PART"]:
                named.append((f"{kind} {number}", listed.title, _members(listed, self.part, "")))
            elif kind == SETS["SET_SOLID"]:
                rows = _members(listed, self.solid_ids, "solid")
                named.append((f"{kind} {number}", listed.title, rows))
        return self._named(named)

    def _named(self, named: list[tuple[str, str, Whole]]) -> tuple[dict[str, Whole], list[str]]:
        """Members by name and by title, if it is the title of one alone."""
        members = {name: rows for name, _, rows in named}
        titles = Counter(title for _, title, _ in named if title)
        notes = []
        for _, title, rows in named:
            if titles[title] == 1 and title not in members:
                members[title] = rows
        if twice := sorted(title for title, count in titles.items() if count > 1):
            notes.append(
                f"mesh {self.name}: titles of several parts or sets are no names: "
                f"{', '.join(twice)}; use their numbers."
            )
        return members, notes


def _nodes_at(corner: Whole) -> Whole:
    """Nodes at corners; -1 is none."""
    nodes = np.unique(corner)
    return nodes[nodes >= 0]


def _members(listed: Listed, ids: Whole, kind: str) -> Whole:
    """Rows of those numbers (n,) that a set lists; without a kind they need not be there."""
    chosen = np.zeros(len(ids), bool)
    order = np.argsort(ids, kind="stable")
    rising = ids[order]
    for first, last in listed.ranges:
        begin, end = np.searchsorted(rising, first, "left"), np.searchsorted(rising, last, "right")
        if begin == end and kind and not listed.generated:
            rule = f"a set must list {kind}s of the file"
            listed.card.refuse(rule, f"{first}, which is none", "Correct it.")
        chosen[order[begin:end]] = True
    return np.flatnonzero(chosen)
