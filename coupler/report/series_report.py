"""A series of runs as one page: a study, an ensemble, a sweep, a calibration, or limits."""

import json
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

from rich.table import Table

from quintet.coupler.report import (
    calibration_report,
    ensemble_report,
    page,
    peer_tables,
    stability_tables,
    study_tables,
    sweep_report,
)
from quintet.coupler.report.page import Part
from quintet.coupler.report.run_tables import TableOfRun
from quintet.coupler.report.work_precision import three_digits
from quintet.coupler.scene.sweep_axes import Axis
from quintet.interfaces.errors import SceneError

CAPTIONS = {  # of the picture of a series, by its kind
    "study": "Error over processor time; a line joins what no other refinement beats",
    "ensemble": "Every run, their distribution, and the reference",
    "sweep": "Quantities over the keys that were varied",
    "calibrate": "Misfit of every run over each key",
    "stability": "Runs that held and that broke, and the limit by theory",
}
Content = Mapping[str, Any]


def write_series_report(kind: str, folder: Path, out: Path) -> Path:
    """Write the page of a series; return where.

    Parameters
    ----------
    kind : str
        Of the series, as the marker of its folder names it: a key of `CAPTIONS`.
    folder, out : Path

    Raises
    ------
    SceneError
        The series has not come to its end: it left no results yet.
    """
    return page.write(render(kind, folder), folder, out)


def render(kind: str, folder: Path) -> str:
    """The page of a series."""
    path = folder / f"{kind}.json"
    if not path.is_file():
        raise SceneError(
            f"report of {folder}: this {kind} has no {path.name} yet. Go on with it, by the same "
            "command."
        )
    content = json.loads(path.read_text(encoding="utf-8"))
    if not isinstance(content, dict):
        raise SceneError(
            f"report of {folder}: it must be of one scene; it is of {len(content)}. Name the "
            "folder of one."
        )
    pictures = [picture for picture in [folder / f"{kind}.png"] if picture.is_file()]
    shown = zip(pictures, page.images(pictures), strict=True)
    status, is_good = _status(kind, content)
    return page.render(
        f"{content['scene']}: {kind}",
        status,
        is_good,
        summary=f"in {folder.name}",
        pictures=[
            {"heading": "At a glance", "caption": CAPTIONS[kind], "data": data} for _, data in shown
        ],
        parts=list(PARTS[kind](content)),
        command=content.get("command", ""),
        machine=page.machine_words(content.get("machine") or {}),
    )


def _status(kind: str, content: Content) -> tuple[str, bool]:
    """How many runs, or limits, are done, and whether all are."""
    if kind == "stability":
        limits = content["limits"]
        done = sum(limit["found"] is not None for limit in limits)
        return f"{done} of {len(limits)} limits found", done == len(limits)
    done = sum(row["status"] == "done" for row in content["rows"])
    return f"{done} of {len(content['rows'])} runs done", done == len(content["rows"])


def _study(content: Content) -> Iterator[Part]:
    advice = content["recommended"]
    words = [
        f"The cheapest refinement that meets all required expectations is {advice['label']}, "
        f"{three_digits(advice['cpu'])} s of processor time."
        if advice
        else "No refinement meets all required expectations."
    ]
    sentences = words if content["has_expectations"] else []
    yield Part(
        "Errors and costs", sentences, _plain(study_tables.costs_and_errors(content["rows"]))
    )
    yield Part("Observed orders", table=_plain(study_tables.orders(content["kinds"])))
    if content["shares"]:
        table = _plain(study_tables.shares(content["shares"]))
        yield Part("Where the error comes from", table=table)
    for peer in content.get("peers", ()):
        words = peer_tables.beside_words(peer, content["rows"])
        table = _plain(peer_tables.beside_table(peer, content["rows"]))
        yield Part(f"Beside {peer_tables.title_of(peer)}", words, table)


def _ensemble(content: Content) -> Iterator[Part]:
    uncertain = [f"{name}: {drawn}" for name, drawn in _perturbations(content)]
    table = _plain(ensemble_report.table(content["expectations"]))
    yield Part("Distribution of the results", table=table)
    if any(row.get("origins") for row in content["expectations"]):
        table = _plain(ensemble_report.origins_table(content["expectations"]))
        yield Part("Where the spread comes from", table=table)
    yield Part("What is uncertain", [f"Random numbers begin at {content['seed']}.", *uncertain])


def _perturbations(content: Content) -> Iterator[tuple[str, str]]:
    for name, perturbation in content["perturbations"].items():
        keys = (
            f"{key} = {value}" for key, value in perturbation.items() if value not in (None, "")
        )
        yield name, ", ".join(keys)


def _sweep(content: Content) -> Iterator[Part]:
    units = content.get("units", {})
    axes = [
        Axis(path, tuple(values), units.get(path, "")) for path, values in content["over"].items()
    ]
    table = sweep_report.table(axes, content["rows"])
    yield Part("Runs", [str(table.caption)] if table.caption else [], _plain(table))


def _calibrate(content: Content) -> Iterator[Part]:
    yield Part("What fits best", list(calibration_report.sentences(content)))


def _stability(content: Content) -> Iterator[Part]:
    limits = content["limits"]
    sentences = list(stability_tables.sentences(limits))
    yield Part(
        "Limits", sentences, _plain(stability_tables.table(limits, content.get("units", {})))
    )


PARTS: Mapping[str, Callable[[Content], Iterator[Part]]] = {
    "study": _study,
    "ensemble": _ensemble,
    "sweep": _sweep,
    "calibrate": _calibrate,
    "stability": _stability,
}


def _plain(table: Table) -> TableOfRun:
    """A table of the screen as one of the page."""
    names = [str(column.header) for column in table.columns]
    columns = [[str(cell) for cell in column.cells] for column in table.columns]
    left = next((k for k, c in enumerate(table.columns) if c.justify == "right"), len(names))
    return TableOfRun("", names, left, [list(row) for row in zip(*columns, strict=True)])
