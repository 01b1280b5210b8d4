"""Every fault at every moment over every transport: the outcomes of the runs, as two tables.

``python tests/coupler/faults/fault_matrix.py`` tries all of them and writes the tables into
coupler/README.md. The result of each cell is kept in a file, so that an ended matrix can go on;
cells that broke a rule are tried again. ``--fault``, ``--moment`` and ``--transport`` try a part.
The tests hold each cell to the same rules.
"""

import argparse
import json
import os
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests/coupler/toy_scenes"))

import component_faults  # noqa: E402
import disk_faults  # noqa: E402
import rank_faults  # noqa: E402
from outcomes import broken_rules, shortened  # noqa: E402

TABLE = ROOT / "coupler/README.md"
BEGIN, END = "<!-- faults -->", "<!-- end of faults -->"
TRANSPORTS = component_faults.TRANSPORTS
MOMENTS = tuple(component_faults.MOMENTS)
LATER = component_faults.LATER
ONE_RANK, DISK = "rank 1 of 2: ", "full disk: "
PATIENCE = 8.0  # s


@dataclass(frozen=True)
class Cell:
    """One fault at one moment over one transport."""

    fault: str
    moment: str
    transport: str

    @property
    def key(self):
        """Its name in the file of results."""
        return f"{self.fault}, {self.moment}, {self.transport}"

    def run(self, folder, slack):
        """Try the cell; return the result to keep."""
        if self.fault.startswith(DISK):
            name = self.fault.removeprefix(DISK)
            broken, delay, cause = disk_faults.full_disk(name, self.transport, folder)
            return {"broken": broken, "told": None, "said": delay, "cause": cause}
        rank = self.fault.startswith(ONE_RANK)
        module = rank_faults if rank else component_faults
        name = self.fault.removeprefix(ONE_RANK)
        fault = next(fault for fault in module.FAULTS if fault.name == name)
        outcome = module.fail(fault, self.moment, self.transport, folder / "run", PATIENCE)
        if rank:
            broken = rank_faults.wrong(fault, self.moment, PATIENCE, outcome, slack)
        else:
            rules = component_faults.expected(fault, self.moment, self.transport, PATIENCE)
            broken = broken_rules(rules, outcome, slack)
        naming_delay = outcome.told if fault.kind == "hangs" else None
        return {
            "broken": broken,
            "told": naming_delay,
            "said": outcome.said,
            "status": outcome.status,
            "cause": outcome.cause,
        }


def cells():
    """All cells, in the order of the tables."""
    for fault, moment, transport in component_faults.CASES:
        yield Cell(fault.name, moment, transport)
    for fault, moment, transport in rank_faults.CASES:
        yield Cell(ONE_RANK + fault.name, moment, transport)
    for file_kind in disk_faults.WRITTEN:
        for transport in TRANSPORTS:
            yield Cell(DISK + file_kind, LATER, transport)


class Kept:
    """Results of cells, in a file."""

    def __init__(self, path, again):
        self.path = path
        self.cells = {} if again or not path.is_file() else json.loads(path.read_text())

    def is_right(self, cell):
        """Whether it was tried, and broke no rule."""
        return cell.key in self.cells and not self.cells[cell.key]["broken"]

    def add(self, cell, result):
        """Keep the result of a cell."""
        self.cells[cell.key] = result
        part = self.path.with_suffix(".part")
        part.write_text(json.dumps(self.cells, indent=1))
        part.replace(self.path)


def worst(results):
    """The cell of several results: the rules that were broken, else the longest times."""
    results = [result for result in results if result]
    if broken := [rule for result in results for rule in result["broken"]]:
        return "; ".join(dict.fromkeys(broken))
    if not results:
        return ""
    delay = max(result["said"] for result in results)
    hangs = [result["told"] for result in results if result["told"] is not None]
    return f"{max(0.0, *hangs, 0.0):.1f} s, {delay:.1f} s" if hangs else f"{max(delay, 0.0):.2f} s"


def by_transport(results):
    """Rows of the first table: the later window, each transport, and the cause."""
    yield f"| fault | {' | '.join(TRANSPORTS)} | the cause, as reported |"
    yield "|---" * (len(TRANSPORTS) + 2) + "|"
    for fault in dict.fromkeys(cell.fault for cell in cells()):
        row = [results.get(Cell(fault, LATER, transport).key) for transport in TRANSPORTS]
        causes = [result["cause"] for result in row[1:] if result]
        cause = shortened(causes[0] if causes else "").replace(os.uname().nodename, "HOST")
        yield f"| {fault} | {' | '.join(worst([result]) for result in row)} | {cause} |"


def by_moment(results):
    """Rows of the second table: each moment, the worst of the transports."""
    yield f"| fault | {' | '.join(MOMENTS)} |"
    yield "|---" * (len(MOMENTS) + 1) + "|"
    for fault in dict.fromkeys(cell.fault for cell in cells()):
        if fault.startswith(DISK):
            continue
        rows = (
            [results.get(Cell(fault, moment, transport).key) for transport in TRANSPORTS]
            for moment in MOMENTS
        )
        yield f"| {fault} | {' | '.join(map(worst, rows))} |"


def write_tables(results):
    """Write both tables into the documentation."""
    rows = "\n".join([*by_transport(results), "", *by_moment(results)])
    before, _, rest = TABLE.read_text().partition(BEGIN)
    TABLE.write_text(f"{before}{BEGIN}\n{rows}\n{END}{rest.partition(END)[2]}")


def parsed(arguments):
    """Options of the command."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--fault", action="append", help="try this fault only; may be repeated")
    parser.add_argument("--moment", action="append", choices=MOMENTS, help="so a moment")
    parser.add_argument("--transport", action="append", choices=TRANSPORTS, help="so a transport")
    parser.add_argument("--cells", type=Path, default=ROOT / "build/fault_cells.json",
                        metavar="FILE", help="keep there what cells did")  # fmt: skip
    parser.add_argument("--again", action="store_true", help="forget what was kept")
    parser.add_argument("--slack", type=float, default=0.5, metavar="SECONDS",
                        help="that a loaded machine may need more than the rules say")  # fmt: skip
    options = parser.parse_args(arguments)
    names = {cell.fault for cell in cells()}
    if unknown := set(options.fault or ()) - names:
        parser.error(f"--fault must be of {', '.join(sorted(names))}; found {min(unknown)}")
    return options


def main(arguments=None):
    """Try all chosen cells without a kept result; write the tables if no cell is missing."""
    options = parsed(arguments)
    options.cells.parent.mkdir(parents=True, exist_ok=True)
    kept_results = Kept(options.cells, options.again)
    for cell in cells():
        filters = (
            (options.fault, cell.fault),
            (options.moment, cell.moment),
            (options.transport, cell.transport),
        )
        if kept_results.is_right(cell) or any(
            names and name not in names for names, name in filters
        ):
            continue
        with tempfile.TemporaryDirectory() as folder:
            try:
                result = cell.run(Path(folder), options.slack)
            except Exception as error:  # so that the others are tried
                broken = [f"{type(error).__name__}: {error}"]
                result = {"broken": broken, "told": None, "said": 0.0, "cause": ""}
        kept_results.add(cell, result)
        print(f"{cell.key}: {worst([result])}", flush=True)
    missing = [cell.key for cell in cells() if cell.key not in kept_results.cells]
    broken_cells = [
        cell.key
        for cell in cells()
        if cell.key in kept_results.cells and not kept_results.is_right(cell)
    ]
    if missing:
        print(f"{len(missing)} cells are missing: the tables are not written")
    else:
        write_tables(kept_results.cells)
    print("\n".join([f"{len(broken_cells)} cells broke a rule", *broken_cells]))
    return 1 if broken_cells else 0


if __name__ == "__main__":
    sys.exit(main())
