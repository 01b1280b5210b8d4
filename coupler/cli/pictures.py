"""Commands that draw, describe and hand on what runs left: draw, report, export, trace."""

import argparse
import math
import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from quintet.coupler.cli.options import BAD, Command
from quintet.interfaces.errors import SceneError

if TYPE_CHECKING:
    from quintet.coupler.report.redraw import Wanted
    from quintet.coupler.report.viewpoint import Box

TIMES = "s, one panel each: 0.1,0.2 (default: those of the scene, else the last)"
COLOUR = "colour a component by what it shows: NAME.FIELD, as water.pressure; may be repeated"
RANGE = "ends of the colours of a component: NAME=LOW,HIGH; may be repeated"
VIEW = "side along y, front against x, top against z (default: side)"
SECTION = "m, on the axis along which one looks: leave out particles in front of it"
REGION = "m, corners of the box that is shown: X Y Z X Y Z (default: that of the scene)"
SCALE = "draw displacements so many times as large"
OUT = "the picture: .png, .svg, .pdf or .jpg (default: DIR/drawn.png)"
PAGE = "the page, one .html file (default: DIR/report.html)"
TIMELINE = "the trace, one .json file (default: DIR/trace.json)"
REPLACE = "replace the file of --out"
SERIES = (
    "draw recorded fields over time instead: NAME, NAME.PORT or NAME.PORT.FIELD (default: all of "
    "at most 1000 numbers)"
)
IN_SPACE = "draw the whole run in three dimensions (extra views3d; default: DIR/drawn-3d.png)"
ANIMATE = "make a film of all steps in three dimensions: .gif or .mp4 (extra views3d)"
OPTION = {"in_space": "3d"}  # whose name is that of no variable
FIELDS = "NAME, NAME.PORT or NAME.PORT.FIELD (default: all of at most 1000 numbers)"
FOLDER = "folder of the files, not DIR itself (default: DIR/export)"


def add_commands(command: Command) -> None:
    """Add what draws."""
    text = "draw a run again, without running it: other times, fields, places, views"
    drawing = command("draw", draw, text)
    drawing.add_argument("folder", type=Path, metavar="DIR")
    drawing.add_argument("--times", type=_numbers, default=[], metavar="T,T", help=TIMES)
    drawing.add_argument("--colour", action="append", default=[], metavar="NAME.FIELD", help=COLOUR)
    drawing.add_argument(
        "--range", action="append", default=[], type=_range, metavar="NAME=LOW,HIGH", help=RANGE
    )
    drawing.add_argument("--view", choices=("side", "front", "top"), default="", help=VIEW)
    drawing.add_argument("--section", type=_number, metavar="M", help=SECTION)
    drawing.add_argument("--region", type=_number, nargs=6, metavar="M", help=REGION)
    drawing.add_argument("--displacement-scale", type=_above_zero, metavar="N", help=SCALE)
    drawing.add_argument("--3d", action="store_true", dest="in_space", help=IN_SPACE)
    drawing.add_argument("--animate", type=Path, metavar="FILE", help=ANIMATE)
    drawing.add_argument("--series", nargs="*", metavar="FIELD", help=SERIES)
    drawing.add_argument("--out", type=Path, metavar="FILE", help=OUT)
    drawing.add_argument("--force", action="store_true", help=REPLACE)

    text = "write one page about a run or a series of runs: results, pictures, balances, time"
    reporting = command("report", report, text)
    reporting.add_argument("folder", type=Path, metavar="DIR")
    reporting.add_argument("--out", type=Path, metavar="FILE", help=PAGE)
    reporting.add_argument("--force", action="store_true", help=REPLACE)

    text = "write recorded fields and the ledger of a run as CSV, with units in the heads"
    exporting = command("export", export, text)
    exporting.add_argument("folder", type=Path, metavar="DIR")
    exporting.add_argument("fields", nargs="*", metavar="FIELD", help=FIELDS)
    exporting.add_argument("--out", type=Path, metavar="FOLDER", help=FOLDER)
    exporting.add_argument("--force", action="store_true", help="replace files of the same names")

    text = "write when each component computed and waited as Chrome trace JSON, for ui.perfetto.dev"
    tracing = command("trace", trace, text)
    tracing.add_argument("folder", type=Path, metavar="DIR", help="folder of a run with --trace")
    tracing.add_argument("--out", type=Path, metavar="FILE", help=TIMELINE)
    tracing.add_argument("--force", action="store_true", help=REPLACE)


def export(options: argparse.Namespace) -> int:
    """Write a run as CSV."""
    # Start-up: only this command needs it.
    from quintet.coupler.report.export import export as write_tables

    exported = write_tables(options.folder, options.fields, options.out, options.force)
    for path in exported.files:
        print(f"written: {os.path.relpath(path)}")
    for key in exported.left_out:
        print(f"left out, for a row has more than 1000 numbers: {key}; name it to export it")
    return 0


def trace(options: argparse.Namespace) -> int:
    """Write the trace of a run."""
    # Start-up: only this command needs it.
    from quintet.coupler.files.run_files import CHROME_TRACE
    from quintet.coupler.report.chrome_trace import cut_short, write_chrome_trace
    from quintet.coupler.report.free_place import free_place

    place = free_place(options.folder / CHROME_TRACE, options.out, [".json"], options.force)
    out, is_whole = write_chrome_trace(options.folder, place)
    if not is_whole:
        print(f"quintet: {cut_short(options.folder)}", file=sys.stderr)
    print(f"written: {os.path.relpath(out)}; open it in https://ui.perfetto.dev")
    return 0


def report(options: argparse.Namespace) -> int:
    """Write the page of a run, or of a series of runs."""
    # Start-up: only this command needs it.
    from quintet.coupler.files.run_files import REPORT, read_marker
    from quintet.coupler.report.free_place import free_place
    from quintet.coupler.report.html_report import write_report
    from quintet.coupler.report.series_report import CAPTIONS, write_series_report
    from quintet.interfaces.libraries import require

    for library in ("matplotlib", "jinja2"):
        require(library, "a report")
    place = free_place(options.folder / REPORT, options.out, [".html"], options.force)
    marker = read_marker(options.folder)
    left = [kind for kind in CAPTIONS if (options.folder / f"{kind}.json").is_file()]
    series = marker.kind if marker else "".join(left[:1])
    if series in CAPTIONS:
        written = write_series_report(series, options.folder, place)
    else:
        written = write_report(options.folder, place)
    print(f"written: {os.path.relpath(written)}")
    return 0


def draw(options: argparse.Namespace) -> int:
    """Draw a run again."""
    # Start-up: only this command needs it.
    from quintet.coupler.report.panels import can_draw
    from quintet.coupler.report.redraw import Wanted

    if not can_draw():
        return BAD
    if options.series is not None:
        return _draw_series(options)
    wanted = Wanted(
        options.times,
        options.colour,
        dict(options.range),
        options.view,
        options.section,
        _box(options.region),
        options.displacement_scale,
    )
    out = _redraw(options, wanted)
    print(f"drawn: {os.path.relpath(out)}")
    return 0


def _redraw(options: argparse.Namespace, wanted: "Wanted") -> Path:
    """Draw in two or in three dimensions."""
    # Start-up: only this command needs it.
    from quintet.coupler.report.redraw import redraw, redraw_3d
    from quintet.coupler.report.views3d import MOVIES

    folder, film, force = options.folder, options.animate, options.force
    if film is None:
        draws = redraw_3d if options.in_space else redraw
        return draws(folder, wanted, options.out, force)
    if options.out is not None or film.suffix.lower() not in MOVIES:
        raise SceneError(
            f"--animate {film}: it must end with .gif or .mp4, and stand without --out. Name one "
            "file."
        )
    return redraw_3d(folder, wanted, film, force)


def _draw_series(options: argparse.Namespace) -> int:
    """Draw recorded fields over time."""
    _refuse_options_of_places(options)
    # Start-up: only this command needs it.
    from quintet.coupler.files.run_files import SERIES_DRAWN
    from quintet.coupler.report.columns import chosen
    from quintet.coupler.report.free_place import free_place
    from quintet.coupler.report.redraw import FORMATS, title_of
    from quintet.coupler.report.run import Run
    from quintet.coupler.report.series_drawing import draw_series

    fields = Run(options.folder).fields
    keys, left_out = chosen(fields, options.series)
    if left_out and not keys:
        raise SceneError(
            f"--series: all recorded fields have more than 1000 numbers a row: "
            f"{', '.join(left_out)}. Name those that shall be drawn."
        )
    place = free_place(options.folder / SERIES_DRAWN, options.out, FORMATS, options.force)
    out = draw_series(fields, keys, place, title_of(options.folder))
    print(f"drawn: {os.path.relpath(out)}")
    for key in left_out:
        print(f"left out, for a row has more than 1000 numbers: {key}; name it to draw it")
    return 0


def _refuse_options_of_places(options: argparse.Namespace) -> None:
    """Refuse options that choose a time, a place or colours: series have none of them."""
    absent: dict[str, object] = {
        "times": [], "colour": [], "range": [], "view": "", "section": None, "region": None,
        "displacement_scale": None, "in_space": False, "animate": None,
    }  # fmt: skip
    names = [name for name, value in absent.items() if getattr(options, name) != value]
    if names:
        wrong = ", ".join("--" + OPTION.get(name, name.replace("_", "-")) for name in names)
        raise SceneError(
            f"--series draws recorded fields over the whole time of a run, for which {wrong} says "
            "nothing. Remove it, or --series."
        )


def _box(numbers: list[float] | None) -> "Box | None":
    """Lowest and highest corner of a region, of two opposite ones."""
    if numbers is None:
        return None
    (x, y, z), (u, v, w) = numbers[:3], numbers[3:]
    return (min(x, u), min(y, v), min(z, w)), (max(x, u), max(y, v), max(z, w))


def _number(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"must be a number; found {text!r}")
    return value


def _above_zero(text: str) -> float:
    value = _number(text)
    if value <= 0.0:
        raise argparse.ArgumentTypeError(f"must be a number above 0; found {text!r}")
    return value


def _numbers(text: str) -> list[float]:
    return [_number(part) for part in text.split(",")]


def _range(text: str) -> tuple[str, tuple[float, float]]:
    name, equals, ends = text.partition("=")
    numbers = _numbers(ends) if equals else []
    if len(numbers) != 2 or not numbers[0] < numbers[1]:
        raise argparse.ArgumentTypeError(f"must be NAME=LOW,HIGH with LOW < HIGH; found {text!r}")
    return name, (numbers[0], numbers[1])
