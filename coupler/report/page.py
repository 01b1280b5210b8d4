"""One page of a report: sections with tables and pictures, in a file that needs nothing else.

The page has no scripts and no links to other files. Jinja2 is loaded by the function that renders.
"""

import base64
import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from importlib.resources import files
from pathlib import Path
from typing import Any

from quintet.coupler.files.disk import reporting_disk
from quintet.coupler.report.run_tables import TableOfRun, number
from quintet.interfaces.errors import SceneError

LARGEST = 5_000_000  # bytes of a page
OF_PICTURES = 3_000_000  # bytes of pictures as they are; larger ones are compressed again
WIDEST = 1600  # pixels of a picture that is compressed
QUALITY = 80  # of its JPEG
TEMPLATE = "report.html"
EMPTY: dict[str, Any] = {  # what a page may lack
    "summary": "", "warnings": [], "fault": None, "outcomes": [], "references": None,
    "has_bars": False, "pictures": [], "parts": [], "command": "", "machine": "", "scene_text": "",
}  # fmt: skip


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


def render(title: str, status: str, is_good: bool, **parts: Any) -> str:
    """Render a page from its title, its status, and what `EMPTY` names."""
    # Start-up: only reports need it.
    from jinja2 import Environment, StrictUndefined

    environment = Environment(autoescape=True, undefined=StrictUndefined, trim_blocks=True)
    text = files("quintet.coupler.report").joinpath(TEMPLATE).read_text(encoding="utf-8")
    content = {**EMPTY, **parts, "number": number}
    content["parts"] = [part for part in content["parts"] if not part.is_empty]
    return environment.from_string(text).render(
        title=title, status=status, is_good=is_good, **content
    )


def write(page: str, folder: Path, out: Path) -> Path:
    """Write the page about a folder; return where.

    Raises
    ------
    SceneError
        The page is too large.
    """
    content = page.encode()
    if len(content) > LARGEST:
        raise SceneError(
            f"report of {folder}: it must be smaller than {LARGEST / 1e6:g} MB; found "
            f"{len(content) / 1e6:.1f} MB. Draw fewer pictures."
        )
    with reporting_disk(out):
        out.parent.mkdir(parents=True, exist_ok=True)
        out.write_bytes(content)
    return out


def machine_words(machine: Mapping[str, Any]) -> str:
    """Processor and versions, in one sentence."""
    versions = ", ".join(f"{name} {text}" for name, text in machine.get("versions", {}).items())
    return f"{machine.get('cpu', '?')}, {machine.get('cores', '?')} cores; {versions}"


def images(paths: Sequence[Path]) -> list[str]:
    """Pictures as data of images; compressed where they are too large together."""
    total = sum(path.stat().st_size for path in paths)
    read = _plain if total <= OF_PICTURES else _compressed
    return [read(path) for path in paths]


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


def svg_image(svg: str) -> str:
    """An SVG as the data of an image; names within it do not meet those of others so."""
    return _data("image/svg+xml", svg.encode()) if svg else ""


def _data(kind: str, content: bytes) -> str:
    return f"data:{kind};base64,{base64.b64encode(content).decode()}"
