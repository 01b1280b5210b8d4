"""Figures of panels, and how they are written.

Matplotlib is loaded by the functions that draw: a run without pictures does not need it.
"""

import math
import sys
import textwrap
from pathlib import Path
from typing import Any

from quintet.coupler.files.disk import reporting_disk
from quintet.interfaces.libraries import how_to_install, is_installed

WIDEST, TALLEST = 11.0, 8.5  # inches, shape of a page, and width of all panels together
LARGEST = 6.5  # inches, edge of a panel that shows a place
STRIP = 0.5  # height over width of such a panel that may be twice as wide
CURVES, HEIGHT = 5.2, 3.2  # inches, width and height of a panel of curves
SMALLEST = 1.4  # inches, height of a panel that shows a place, if its width allows
AROUND = (0.8, 0.95)  # inches, what axes take beside and below a panel, and its title
MOST = 6  # columns
GAP = 0.1  # inches, between rows of panels, and from their title
DOTS = 120  # per inch
LETTERS = 9.0  # of a title, per inch


def can_draw() -> bool:
    """Whether pictures can be drawn; if not, print what is missing."""
    if is_installed("matplotlib"):
        return True
    lacks = f"no pictures: matplotlib is not installed. {how_to_install('matplotlib')}"
    print(f"quintet: {lacks}", file=sys.stderr, flush=True)
    return False


def curve_panels(count: int, title: str = "") -> tuple[Any, list[Any]]:
    """Make a figure of panels for curves, with a title above all of them."""
    columns = min(count, 2 if count <= 8 else 3)
    return _figure(count, columns, (CURVES, HEIGHT), title, 0.0)


def place_panels(count: int, height: float, title: str = "") -> tuple[Any, list[Any]]:
    """Make a figure of panels that show a place, and a legend below all of them.

    `height` is that of a panel over its width; the number of columns is that which comes nearest to
    the shape of a page.
    """
    numbers = range(1, min(count, MOST) + 1)
    columns = min(numbers, key=lambda n: _misfit(count, n, height))
    return _figure(count, columns, _size(columns, height), title, 0.3)


def _figure(
    count: int, columns: int, panel: tuple[float, float], title: str, below: float
) -> tuple[Any, list[Any]]:
    # A run without pictures does not load matplotlib.
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.layout_engine import ConstrainedLayoutEngine

    (wide, tall), rows = panel, -(-count // columns)
    size = (columns * (wide + AROUND[0]) + 0.9, rows * (tall + AROUND[1]) + 0.5 + below)
    figure = Figure(figsize=size, layout=ConstrainedLayoutEngine(h_pad=GAP))
    FigureCanvasAgg(figure)  # no window, and none of the global state of pyplot
    if title:
        width = int(LETTERS * size[0])  # matplotlib breaks no words
        lines = [textwrap.fill(line, width) for line in title.split("\n")]
        figure.suptitle("\n".join(lines), fontsize=12, wrap=True)
    panels = figure.subplots(rows, columns, squeeze=False).ravel().tolist()
    for unused in panels[count:]:
        unused.remove()
    return figure, panels[:count]


def _size(columns: int, height: float) -> tuple[float, float]:
    """Width and height [inches] of a panel that shows a place, among some columns."""
    wide = LARGEST / min(max(height, STRIP), 1.0) if height < 1.0 else LARGEST / height
    wide = min(wide, WIDEST / columns - AROUND[0])
    return wide, wide * height


def _misfit(count: int, columns: int, height: float) -> float:
    """How far a figure is from the shape of a page; empty places and low panels count too."""
    rows = -(-count // columns)
    wide, tall = _size(columns, height)
    shape = (columns * (wide + AROUND[0])) / (rows * (tall + AROUND[1]))
    empty, low = rows * columns / count, max(SMALLEST / tall, 1.0)
    return abs(math.log(shape * TALLEST / WIDEST)) + 2.0 * math.log(empty) + 4.0 * math.log(low)


def save(figure: Any, out: Path) -> Path:
    """Write a figure in the format of the file's ending."""
    out = Path(out)
    take_literally(figure)
    with reporting_disk(out):
        out.parent.mkdir(parents=True, exist_ok=True)
        figure.savefig(out, dpi=DOTS)
    return out


def take_literally(figure: Any) -> None:
    """Escape the dollar signs of all words: matplotlib reads text between two as mathematics."""
    words = [*figure.texts]
    legends = [*figure.legends]
    for panel in figure.axes:
        words += [panel.title, panel.xaxis.label, panel.yaxis.label, *panel.texts]
        legends += [legend] if (legend := panel.get_legend()) else []
    words += [word for legend in legends for word in legend.get_texts()]
    for word in words:
        word.set_text(word.get_text().replace("$", r"\$"))
