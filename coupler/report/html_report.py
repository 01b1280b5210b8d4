"""A run as one page: what was expected, pictures, balances, time, machine, how to repeat it.

The page is one file without scripts and without links to others. Jinja2 and matplotlib are loaded
by the functions that need them: a run without a report needs neither.
"""

import base64
import io
from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib.resources import files
from pathlib import Path
from typing import Any

from quintet.coupler.files.disk import reporting_disk
from quintet.coupler.files.run_files import PICTURES, SCENE
from quintet.coupler.measures.advice import sentences
from quintet.coupler.report import report_figures as figures
from quintet.coupler.report import run_tables
from quintet.coupler.report.run import Run
from quintet.coupler.report.run_tables import TableOfRun, number
from quintet.interfaces.errors import SceneError

LARGEST = 5_000_000  # bytes of a page
OF_PICTURES = 3_000_000  # bytes of pictures as they are; larger ones are compressed again
WIDEST = 1600  # pixels of a picture that is compressed
QUALITY = 80  # of its JPEG
TEMPLATE = "report.html"
HEADINGS = {  # of pictures, by their file
    PICTURES[0]: ("What moves", "Components at the times of the panels"),
    PICTURES[1]: ("Against references", "Computed curves and what is expected of them"),
}


@dataclass(frozen=True)
class Part:
    """A section of the page; what is empty is left out."""

    heading: str
    sentences: list[str] = field(default_factory=list)
    table: TableOfRun | None = None
    figure: str = ""  # data of an image
    caption: str = ""

    @property
    def is_empty(self) -> bool:
        """Whether it says nothing."""
        return not (self.sentences or self.figure or (self.table and self.table.rows))


def write_report(folder: Path, out: Path) -> Path:
    """Write the page of a run; return where.

    Parameters
    ----------
    folder : Path
        Of a run that has ended, well or not.
    out : Path
    """
    page = render(Run(folder)).encode()
    if len(page) > LARGEST:
        raise SceneError(
            f"report of {folder}: it must be smaller than {LARGEST / 1e6:g} MB; found "
            f"{len(page) / 1e6:.1f} MB. Draw fewer pictures."
        )
    out.parent.mkdir(parents=True, exist_ok=True)
    with reporting_disk(out):
        out.write_bytes(page)
    return out


def render(run: Run) -> str:
    """The page of a run."""
    # Start-up: only reports need it.
    from jinja2 import Environment, StrictUndefined

    environment = Environment(autoescape=True, undefined=StrictUndefined, trim_blocks=True)
    text = files("quintet.coupler.report").joinpath(TEMPLATE).read_text(encoding="utf-8")
    results, scene = run.results, run.folder / SCENE
    preset = f" ({results['preset']})" if results.get("preset") else ""
    return environment.from_string(text).render(
        title=f"{results.get('scene', '?')}{preset}",
        run={**EMPTY, **results},
        done=results.get("status") == "done",
        outcomes=[_outcome(outcome) for outcome in results.get("expect") or []],
        references=run_tables.references(results),
        has_bars=any(each.get("error_bar") is not None for each in results.get("expect") or []),
        pictures=_pictures(run),
        parts=[part for part in _parts(run) if not part.is_empty],
        machine=_machine(results.get("machine") or {}),
        scene_text=scene.read_text(encoding="utf-8") if scene.is_file() else "",
        number=number,
    )


EMPTY = {  # what a page reads of results that may lack
    "status": "", "windows": 0, "time": None, "transport": "", "warnings": [], "fault": None,
    "command": "",
}  # fmt: skip


def _outcome(outcome: Mapping[str, Any]) -> dict[str, Any]:
    """An expectation as a row of the page."""
    met = run_tables.met(outcome)
    value, reference = outcome.get("value"), outcome.get("reference")
    difference = None if value is None or reference is None else value - reference
    return {**outcome, "met": str(met), "style": str(met.style), "difference": difference}


def _parts(run: Run) -> list[Part]:
    """Sections behind the pictures."""
    results, ledger = run.results, run.ledger
    masses = run_tables.mass_changes(results)
    waits = sentences(results["advice"]) if results.get("advice") else []
    components = (results.get("timing") or {}).get("components") or {}
    notes = [
        f"{name}: {note}" for name, told in (results.get("notes") or {}).items() for note in told
    ]
    bars = run_tables.error_bars(results)
    return [
        Part(bars.title, [run_tables.error_bar_notes(results)] if bars.rows else [], bars),
        Part(
            "Balances",
            [masses] if masses else [],
            run_tables.ledger(results),
            _svg_data(figures.links(ledger)),
            "Work of the links as both sides count it, and by how much their sums disagree",
        ),
        Part(
            "Energy",
            table=run_tables.energies(results),
            figure=_svg_data(figures.energies(ledger)),
            caption="Change since the start, by component",
        ),
        Part(
            "Time, and who waited for whom",
            [text for text in (run_tables.time_shares(results), *waits) if text],
            run_tables.timing(results),
            _svg_data(figures.times_of(components)),
            "Wall time of each component",
        ),
        Part("Notes of the components", notes),
    ]


def _machine(machine: Mapping[str, Any]) -> str:
    """Processor and versions, in one sentence."""
    versions = ", ".join(f"{name} {text}" for name, text in machine.get("versions", {}).items())
    return f"{machine.get('cpu', '?')}, {machine.get('cores', '?')} cores; {versions}"


def _pictures(run: Run) -> list[dict[str, str]]:
    """Pictures of a run as data of images; too large ones compressed."""
    found_files = [path for path in run.pictures.values() if path.name in HEADINGS]
    total = sum(path.stat().st_size for path in found_files)
    read = _plain if total <= OF_PICTURES else _compressed
    return [
        {**dict(zip(("heading", "caption"), HEADINGS[path.name], strict=True)), "data": read(path)}
        for path in found_files
    ]


def _plain(path: Path) -> str:
    return _data("image/png", path.read_bytes())


def _compressed(path: Path) -> str:
    # Pillow comes with matplotlib.
    from PIL import Image

    with Image.open(path) as image:
        small = image.convert("RGB")
    small.thumbnail((WIDEST, 4 * WIDEST))
    file = io.BytesIO()
    small.save(file, "JPEG", quality=QUALITY)
    return _data("image/jpeg", file.getvalue())


def _svg_data(svg: str) -> str:
    """An SVG as the data of an image; names within it do not meet those of others so."""
    return _data("image/svg+xml", svg.encode()) if svg else ""


def _data(kind: str, content: bytes) -> str:
    return f"data:{kind};base64,{base64.b64encode(content).decode()}"
