"""What meshio's reader of Abaqus files would lose without a word."""

from collections import Counter
from pathlib import Path

from quintet.interfaces.errors import SceneError


def require_readable(path: Path) -> None:
    """Refuse an Abaqus file of which meshio reads another mesh than it describes.

    Of several blocks of nodes it keeps the last and gives it to all elements; it does not move
    instances; of sets it keeps the last of a name, and of sets of nodes no names of other sets.
    """
    lines = [line.strip() for line in path.read_text(errors="replace").splitlines()]
    lines = [line for line in lines if line and not line.startswith("**")]
    blocks = [number for number, line in enumerate(lines) if line.startswith("*")]
    names: Counter[str] = Counter()
    nodes = 0
    for number, end in zip(blocks, [*blocks[1:], len(lines)], strict=True):
        keyword, *options = (word.strip() for word in lines[number][1:].split(","))
        data = lines[number + 1 : end]
        match keyword.upper():
            case "NODE":
                nodes += 1
            case "INCLUDE":
                _refuse(path, "no *INCLUDE", "one", "Write all into one file.")
            case "INSTANCE" if data:
                rule, cure = "instances without a translation or rotation", "Export them in place."
                _refuse(path, rule, "one with it", cure)
            case "NSET" | "ELSET" as kind:
                names[f"*{kind} {_name(options)}"] += 1
                if kind == "NSET" and any(not _is_number(line) for line in data):
                    wrong = f"names in {_name(options)}"
                    _refuse(path, "sets of nodes by numbers", wrong, "Write the numbers.")
    if nodes > 1:
        finding = f"{nodes}, of which the reader keeps the last alone"
        _refuse(path, "one block *NODE", finding, "Write all nodes into one block.")
    for name, count in names.items():
        if count > 1:
            finding = f"{count} of {name}, of which the reader keeps the last alone"
            _refuse(path, "sets of different names", finding, "Rename or merge them.")


def _name(options: list[str]) -> str:
    for option in options:
        key, _, value = option.partition("=")
        if key.strip().upper() in ("NSET", "ELSET"):
            return value.strip()
    return ""


def _is_number(line: str) -> bool:
    return all(word.strip().isdigit() for word in line.strip(",").split(","))


def _refuse(path: Path, rule: str, finding: str, cure: str) -> None:
    raise SceneError(f"file {path.name} must have {rule}; found {finding}. {cure}")
