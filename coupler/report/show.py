"""The summary of a run, printed from its results.json."""

import json
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from quintet.coupler.files.checksums import require_sealed
from quintet.coupler.measures.advice import sentences
from quintet.interfaces.errors import SceneError

NAME = "results.json"
UNWRAPPED = 10_000  # characters, more than any line has
MASS_TOLD = 1e-3  # of a component's mass, a change that is told
START_AND_END = 2  # totals of a run
ROUNDING = 1e-9  # of the energy that was turned over
Row = list[Any]


def results(folder: Path) -> dict[str, Any]:
    """Read the results of a run; `folder` is the run's, or the file itself."""
    path = Path(folder) / NAME if Path(folder).is_dir() else Path(folder)
    try:
        run = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError as error:
        raise SceneError(f"run {folder}: it has no {NAME}. Run a scene into it first.") from error
    except (OSError, ValueError) as error:
        raise SceneError(f"run {folder}: {path.name} must be JSON; {error}. Run again.") from error
    if not isinstance(run, dict):
        raise SceneError(
            f"run {folder}: {path.name} must be one table; found a {type(run).__name__}."
        )
    require_sealed(run, path)
    return run


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
    for warning in run.get("warnings") or []:
        said = f"Warning of {warning.get('source', '?')}: {warning.get('text', warning)}"
        screen.print(Text(said, style="red"))
    for table in (_expectations(run), _ledger(run), _timing(run)):
        if table is not None:
            table.box = frame
            screen.print(table)
    for outcome in run.get("expect") or []:
        if outcome.get("reason"):
            screen.print(Text(f"{outcome.get('name', '?')}: not met: {outcome['reason']}"))
    advised = sentences(run["advice"]) if run.get("advice") else []
    for line in (_balance(run), _masses(run), _shares(run), *advised):
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
    text.append(f", {run.get('windows', 0)} windows to t = {_number(run.get('time'))} s")
    text.append(f" over {run['transport']}" if run.get("transport") else "")
    return text


def _table(title: str, names: list[str], left: int, rows: list[Row]) -> Table | None:
    """Lay out rows; the first `left` columns are text, the others numbers."""
    if not rows:
        return None
    table = Table(title=title, title_justify="left", title_style="bold", pad_edge=False)
    for place, name in enumerate(names):
        table.add_column(name, justify="left" if place < left else "right", overflow="fold")
    for row in rows:
        table.add_row(*(cell if isinstance(cell, Text) else Text(str(cell)) for cell in row))
    return table


def _expectations(run: Mapping[str, Any]) -> Table | None:
    rows = [
        [
            _met(outcome.get("met"), outcome.get("required", True), outcome.get("not_reached")),
            outcome.get("name", "?"),
            outcome.get("unit", ""),
            *(_number(outcome.get(key)) for key in ("value", "reference", "within")),
        ]
        for outcome in run.get("expect") or []
    ]
    names = ["", "expectation", "unit", "value", "reference", "within"]
    return _table("Expectations", names, 3, rows)


def _met(met: Any, required: Any, not_reached: Any = None) -> Text:
    text = "met" if met else "not met"
    if not_reached is not None:
        text = f"not reached (t = {_number(not_reached)} s)"
    if not required:
        return Text(f"{text}, not required")
    return Text(text, style="green" if met else "red")


# What of a link shows that it carries what these are of, also where they are 0.
CARRIED_AS = {
    "momentum_residual": "impulse",
    "heat_residual": "heat",
    "work_given": "turnover",
    "work_taken": "turnover",
    "energy_residual": "turnover",
}


def _carries(link: Mapping[str, Any], key: str) -> bool:
    """Whether a sum of a link is not 0, or is 0 although the link carries what it is of."""
    values = (link.get(key), link.get(CARRIED_AS.get(key, key)))
    return any(any(value) if isinstance(value, list) else bool(value) for value in values)


def _sum_of(link: Mapping[str, Any], key: str) -> str:
    return _number(link.get(key)) if _carries(link, key) else "-"


def _ledger(run: Mapping[str, Any]) -> Table | None:
    """One column for each link; a row for what any of them carries."""
    links = (run.get("ledger") or {}).get("links") or []
    keys = dict.fromkeys(key for link in links for key in link if key != "link")
    rows = [
        [key.replace("_", " "), *(_sum_of(link, key) for link in links)]
        for key in keys
        if any(_carries(link, key) for link in links)
    ]
    return _table("Ledger", ["", *(link.get("link", "?") for link in links)], 1, rows)


def _balance(run: Mapping[str, Any]) -> str:
    """How the energy of the run changed; nothing where no component tells its energies."""
    change = (run.get("ledger") or {}).get("energy_change")
    if not change:
        return ""
    gained, lost, turned = (change[key] for key in ("gained", "lost", "turned_over"))
    if change.get("times") == START_AND_END:  # what was turned over between them is not known
        return f"Energy: rose by {_number(gained)} J, lost {_number(lost)} J from start to end"
    return (
        f"Energy: rose by at most {_per_cent(gained / turned)} %, lost {_per_cent(lost / turned)} %"
        f" ({_number(lost)} J of {_number(turned)} J turned over)"
    )


def _masses(run: Mapping[str, Any]) -> str:
    """Which components' masses changed, by more than what is negligible."""
    drifts = (run.get("ledger") or {}).get("mass_drift") or {}
    said = []
    for name, drift in drifts.items():
        share = drift["relative"]
        if share is None:
            said.append(f"mass of {name} changed by {drift['kg']:+.3g} kg from none")
        elif abs(share) > MASS_TOLD:
            said.append(f"mass of {name} changed by {100.0 * share:+.2g} % ({drift['kg']:+.3g} kg)")
    return "Mass: " + ", ".join(said) if said else ""


def _per_cent(share: float) -> str:
    """A share in per cent; what is rounding is 0."""
    return f"{float(f'{100.0 * share:.2g}'):g}" if share > ROUNDING else "0"


def _timing(run: Mapping[str, Any]) -> Table | None:
    components = (run.get("timing") or {}).get("components") or {}
    rows = [
        [
            name,
            *(_number(times.get(key)) for key in ("build", "compute", "cpu", "wait")),
            times.get("steps", "-"),
            times.get("items", "-"),
            _number(_rate(times)),
        ]
        for name, times in components.items()
    ]
    seconds = [f"{name} [s]" for name in ("build", "compute", "CPU", "wait")]
    names = ["component", *seconds, "steps", "items", "item-steps/s"]
    return _table("Timing", names, 1, rows)


def _rate(times: Mapping[str, Any]) -> float | None:
    """Items stepped per second of computing time."""
    compute = times.get("compute")
    return times.get("steps", 0) * times.get("items", 0) / compute if compute else None


def _shares(run: Mapping[str, Any]) -> str:
    timing = run.get("timing") or {}
    times = {k: v for k, v in timing.items() if k not in ("components", "memory")}
    text = "Time: " + ", ".join(f"{k} {_number(v)} s" for k, v in times.items()) if times else ""
    text += f"; memory {timing['memory'] / 1e6:.0f} MB" if timing.get("memory") else ""
    again = run.get("repetitions")
    text += f"; windows repeated {again} times" if again else ""
    lacking = run.get("unconverged")
    return text + (f"; {lacking} windows did not converge" if lacking else "")


def _fault(fault: Mapping[str, Any]) -> Text:
    text = Text("Fault\n", style="bold red")
    for key, value in fault.items():
        lines = value if isinstance(value, list) else str(value).splitlines()
        if len(lines) > 1:
            text.append(f"  {key}:\n" + "".join(f"    {line}\n" for line in lines), style="")
        elif lines:
            text.append(f"  {key}: {lines[0]}\n", style="")
    return text


def _number(value: Any) -> str:
    if value is None:
        return "-"
    if isinstance(value, list):
        return " ".join(f"{number:.3g}" for number in value)
    return f"{value:.4g}" if isinstance(value, (int, float)) else str(value)
