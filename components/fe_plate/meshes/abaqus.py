"""What meshio's reader of Abaqus files would lose without a word."""

from collections import Counter
from pathlib import Path
from typing import NamedTuple

from quintet.interfaces.errors import SceneError

GENERATING = ("ELGEN", "ELCOPY", "NGEN", "NFILL", "NCOPY", "NMAP")  # meshio skips these


class Block(NamedTuple):
    """A keyword with its data."""

    keyword: str  # in capitals, without the asterisk
    options: dict[str, str]  # by their names in capitals; those without a value have an empty one
    data: list[str]


def require_readable(path: Path) -> None:
    """Refuse an Abaqus file of which meshio reads another mesh than it describes.

    Of several blocks of nodes it keeps the last and gives it to all elements; it does not move
    instances, generates nothing and knows no systems of coordinates but that of the file; of sets
    it keeps the last of a name, and of names of other sets at most one a line.
    """
    blocks = _blocks(path)
    for block in blocks:
        match block.keyword:
            case "INCLUDE":
                _refuse(path, "no *INCLUDE", "one", "Write all into one file.")
            case "INSTANCE" if block.data:
                rule, cure = "instances without a translation or rotation", "Export them in place."
                _refuse(path, rule, "one with it", cure)
            case "SYSTEM" if block.data:
                rule = "nodes in the coordinates of the file"
                _refuse(path, rule, "*SYSTEM", "Write the nodes in these.")
            case "NODE" if (system := block.options.get("SYSTEM", "R").upper()) != "R":
                rule = "nodes in rectangular coordinates"
                _refuse(path, rule, f"SYSTEM={system}", "Write the nodes in these.")
            case keyword if keyword in GENERATING:
                rule = "all nodes and elements written out"
                _refuse(path, rule, f"*{keyword}", "Export the mesh without it.")
    if (nodes := sum(block.keyword == "NODE" for block in blocks)) > 1:
        finding = f"{nodes}, of which the reader keeps the last alone"
        _refuse(path, "one block *NODE", finding, "Write all nodes into one block.")
    _require_sets(path, blocks)


def _require_sets(path: Path, blocks: list[Block]) -> None:
    """Refuse sets that meshio would cut short, or fill with the elements of another set."""
    names: Counter[str] = Counter()
    for block in blocks:
        kind = {"NSET": "NSET", "ELSET": "ELSET", "ELEMENT": "ELSET"}.get(block.keyword, "")
        name = block.options.get(kind, "")
        if kind and (name or block.keyword != "ELEMENT"):
            names[f"*{block.keyword} {name}"] += 1
        if block.keyword in ("NSET", "ELSET") and not all(map(_is_number, block.data)):
            what = "nodes" if kind == "NSET" else "elements"
            _refuse(path, f"sets of {what} by numbers", f"names in {name}", "Write the numbers.")
    for name, count in names.items():
        if count > 1:
            finding = f"{count} of {name}, of which the reader keeps the last alone"
            _refuse(path, "sets of different names", finding, "Rename or merge them.")
    elements = [block for block in blocks if block.keyword in ("ELEMENT", "ELSET")]
    kinds = [block.keyword for block in elements]
    if "ELSET" in kinds and "ELEMENT" in kinds[kinds.index("ELSET") :]:
        name = elements[kinds.index("ELSET")].options.get("ELSET", "")
        rule, cure = "sets of elements below all elements", "Move it to the end."
        _refuse(path, rule, f"*ELSET {name} above some", cure)
    named = ["ELSET" in block.options for block in elements if block.keyword == "ELEMENT"]
    if named != sorted(named, reverse=True):
        rule = "a name ELSET in each *ELEMENT, or in none"
        finding = "one without it above another with it, whose elements the reader would mistake"
        _refuse(path, rule, finding, "Name each.")


def _blocks(path: Path) -> list[Block]:
    """Keywords of a file in order, each with the lines below it; comments are left out."""
    blocks: list[Block] = []
    for text in path.read_text(errors="replace").splitlines():
        line = text.strip()
        if not line or line.startswith("**"):
            continue
        if not line.startswith("*"):
            if blocks:
                blocks[-1].data.append(line)
            continue
        keyword, *options = line[1:].split(",")
        pairs = (option.partition("=") for option in options)
        values = {key.strip().upper(): value.strip() for key, _, value in pairs}
        blocks.append(Block(keyword.strip().upper(), values, []))
    return blocks


def _is_number(line: str) -> bool:
    return all(word.strip().isdigit() for word in line.strip(",").split(","))


def _refuse(path: Path, rule: str, finding: str, cure: str) -> None:
    raise SceneError(f"file {path.name} must have {rule}; found {finding}. {cure}")
