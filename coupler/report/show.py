"""The summary of a run, printed from its results.json."""

import json
import shlex
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from quintet.coupler.files.checksums import require_sealed
from quintet.coupler.files.run_files import read_marker
from quintet.coupler.measures.advice import sentences
from quintet.coupler.report.run_tables import (
    TableOfRun,
    energies,
    error_bar_notes,
    error_bars,
    expectations,
    ledger,
    mass_balances,
    mass_changes,
    number,
    time_shares,
    timing,
)
from quintet.interfaces.errors import SceneError

NAME = "results.json"
UNWRAPPED = 10_000  # characters, more than any line has


def results(folder: Path) -> dict[str, Any]:
    """Read the results of a run; `folder` is the run's, or the file itself."""
    path = Path(folder) / NAME if Path(folder).is_dir() else Path(folder)
    try:
        run = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError as error:
        raise SceneError(f"run {folder}: it has no {NAME}. {_remedy(Path(folder))}") from error
    except (OSError, ValueError) as error:
        raise SceneError(f"run {folder}: {path.name} must be JSON; {error}. Run again.") from error
    if not isinstance(run, dict):
        raise SceneError(
            f"run {folder}: {path.name} must be one table; found a {type(run).__name__}."
        )
    require_sealed(run, path)
    return run


def _remedy(folder: Path) -> str:
    """What to do about a folder without results."""
    marker = read_marker(folder)
    if marker is None:
        return "Run a scene into it first."
    if marker.kind == "run":
        return (
            "The run goes on, or was killed. Wait for its end, or continue it: quintet run "
            f"--resume {shlex.quote(str(folder))}."
        )
    return f"It is the folder of a {marker.kind}. Name that of one of its runs."


def show(folder: Path, as_json: bool = False) -> None:
    """Print the summary of a run: status, expectations, ledger, timing and fault.

    Parameters
    ----------
    folder : Path
        Of a run.
    as_json : bool
        Print the results as they are, for a program.
    """
    run = results(folder)
    if as_json:
        print(json.dumps(run, indent=2))
        return
    print_results(run, console(), box.SIMPLE_HEAD if sys.stdout.isatty() else None)


def print_results(run: Mapping[str, Any], screen: Console, frame: box.Box | None = None) -> None:
    """Print results on a console, their tables in a frame or plain."""
    screen.print(_headline(run))
    if run.get("cause"):
        screen.print(Text(f"Cause: {run['cause']}", style="red"))
    for warning in run.get("warnings") or []:
        text = f"Warning of {warning.get('source', '?')}: {warning.get('text', warning)}"
        screen.print(Text(text, style="red"))
    for table in (expectations(run), error_bars(run), ledger(run), energies(run), timing(run)):
        if table.rows:
            screen.print(_drawn(table, frame))
    for outcome in run.get("expect") or []:
        if outcome.get("reason"):
            screen.print(Text(f"{outcome.get('name', '?')}: not met: {outcome['reason']}"))
    advised = sentences(run["advice"]) if run.get("advice") else []
    masses = [mass_changes(run), *mass_balances(run)]
    for line in (error_bar_notes(run), *masses, time_shares(run), *advised):
        if line:
            screen.print(line)
    for name, notes in (run.get("notes") or {}).items():
        for note in notes:
            screen.print(Text(f"note of {name}: {note}"))
    if fault := run.get("fault"):
        screen.print(_fault(fault))


def console() -> Console:
    """The console that tables are printed on; where there is no terminal no line is wrapped."""
    width = None if sys.stdout.isatty() else UNWRAPPED
    return Console(width=width, highlight=False, markup=False)


def _headline(run: Mapping[str, Any]) -> Text:
    status = str(run.get("status", "unknown"))
    text = Text(f"{run.get('scene', '?')}", style="bold")
    if run.get("preset"):
        text.append(f" ({run['preset']})", style="")
    text.append(f": {status}", style="green" if status == "done" else "red")
    text.append(f", {run.get('windows', 0)} windows to t = {number(run.get('time'))} s")
    text.append(f" over {run['transport']}" if run.get("transport") else "")
    return text


def _drawn(table: TableOfRun, frame: box.Box | None) -> Table:
    """Lay out a table for a console."""
    drawn = Table(
        title=table.title, title_justify="left", title_style="bold", pad_edge=False, box=frame
    )
    for place, name in enumerate(table.names):
        justify: Any = "left" if place < table.left else "right"
        drawn.add_column(name, justify=justify, overflow="fold")
    for row in table.rows:
        drawn.add_row(*(cell if isinstance(cell, Text) else Text(str(cell)) for cell in row))
    return drawn


def _fault(fault: Mapping[str, Any]) -> Text:
    text = Text("Fault\n", style="bold red")
    for key, value in fault.items():
        lines = value if isinstance(value, list) else str(value).splitlines()
        if len(lines) > 1:
            text.append(f"  {key}:\n" + "".join(f"    {line}\n" for line in lines), style="")
        elif lines:
            text.append(f"  {key}: {lines[0]}\n", style="")
    return text
