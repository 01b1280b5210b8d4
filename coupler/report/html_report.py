"""A run as one page: what was expected, pictures, balances, time, machine, how to repeat it.

Matplotlib is loaded by the functions that draw: a run without a report does not need it.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from quintet.coupler.files.run_files import PICTURES, SCENE
from quintet.coupler.measures.advice import sentences
from quintet.coupler.report import page, run_tables
from quintet.coupler.report import report_figures as figures
from quintet.coupler.report.page import Part
from quintet.coupler.report.run import Run
from quintet.coupler.report.run_tables import number

HEADINGS = {  # of pictures, by their file
    PICTURES[0]: ("What moves", "Components at the times of the panels"),
    PICTURES[1]: ("Against references", "Computed curves and what is expected of them"),
}


def write_report(folder: Path, out: Path) -> Path:
    """Write the page of a run; return where.

    Parameters
    ----------
    folder : Path
        Of a run that has ended, well or not.
    out : Path
    """
    return page.write(render(Run(folder)), folder, out)


def render(run: Run) -> str:
    """The page of a run."""
    results, scene = run.results, run.folder / SCENE
    preset = f" ({results['preset']})" if results.get("preset") else ""
    transport = f" over {results['transport']}" if results.get("transport") else ""
    windows, end = results.get("windows") or 0, number(results.get("time"))
    cause = f". Cause: {results['cause']}" if results.get("cause") else ""
    return page.render(
        f"{results.get('scene', '?')}{preset}",
        results.get("status") or "unknown",
        results.get("status") == "done",
        summary=f"{windows} windows to t = {end} s{transport}{cause}",
        warnings=results.get("warnings") or [],
        fault=results.get("fault"),
        outcomes=[_outcome(outcome) for outcome in results.get("expect") or []],
        references=run_tables.references(results),
        has_bars=any(each.get("error_bar") is not None for each in results.get("expect") or []),
        pictures=_pictures(run),
        parts=_parts(run),
        command=results.get("command", ""),
        machine=page.machine_words(results.get("machine") or {}),
        scene_text=scene.read_text(encoding="utf-8") if scene.is_file() else "",
    )


def _outcome(outcome: Mapping[str, Any]) -> dict[str, Any]:
    """An expectation as a row of the page."""
    met = run_tables.met(outcome)
    value, reference = outcome.get("value"), outcome.get("reference")
    difference = None if value is None or reference is None else value - reference
    return {**outcome, "met": str(met), "style": str(met.style), "difference": difference}


def _parts(run: Run) -> list[Part]:
    """Sections behind the pictures."""
    results, ledger = run.results, run.ledger
    masses = [run_tables.mass_changes(results), *run_tables.mass_balances(results)]
    waits = sentences(results["advice"]) if results.get("advice") else []
    components = (results.get("timing") or {}).get("components") or {}
    notes = [
        f"{name}: {note}" for name, texts in (results.get("notes") or {}).items() for note in texts
    ]
    bars = run_tables.error_bars(results)
    return [
        Part(bars.title, [run_tables.error_bar_notes(results)] if bars.rows else [], bars),
        Part(
            "Balances",
            [line for line in masses if line],
            run_tables.ledger(results),
            page.svg_image(figures.links(ledger)),
            "Work of the links as both sides count it, and by how much their sums disagree",
        ),
        Part(
            "Energy",
            table=run_tables.energies(results),
            figure=page.svg_image(figures.energies(ledger)),
            caption="Change since the start, by component",
        ),
        Part(
            "Time, and who waited for whom",
            [text for text in (run_tables.time_shares(results), *waits) if text],
            run_tables.timing(results),
            page.svg_image(figures.times_of(components)),
            "Wall time of each component",
        ),
        Part("Notes of the components", notes),
    ]


def _pictures(run: Run) -> list[dict[str, str]]:
    """Pictures of a run as data of images."""
    paths = [path for path in run.pictures.values() if path.name in HEADINGS]
    return [
        {**dict(zip(("heading", "caption"), HEADINGS[path.name], strict=True)), "data": data}
        for path, data in zip(paths, page.images(paths), strict=True)
    ]
