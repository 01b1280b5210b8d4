"""Command that predicts a component on more ranks than were measured: scaling."""

import argparse
import math
from pathlib import Path

from quintet.coupler.cli.options import FOR_PROGRAMS, Command

FILE = "what quintet bench KIND --ranks 1 --ranks 2 --ranks 4 --json FILE has written"
LATENCY = "s, of a message on the network that is assumed (default: as measured on the host)"
BANDWIDTH = "bytes/s, of the same"
ITEMS = "of all ranks, for strong scaling (default: those of the largest case)"
EACH = "of each rank, for weak scaling (default: the same)"
DIMENSIONS = "in which the ranks part space (default: 3)"
SERIES = "one of the series of cases; all if not given"
PLOT = "draw efficiency over ranks, measured and extrapolated, beside published figures"
STEP = "s, that a step of a run of --items took; with the next three: what it takes on other ranks"


def add_commands(command: Command) -> None:
    """Add what predicts from measurements."""
    more = command("scaling", scaling, "predict a component on more ranks than were measured")
    more.add_argument("file", type=Path, help=FILE)
    add_model(more)
    more.add_argument("--json", type=Path, metavar="FILE", help=FOR_PROGRAMS)


def add_model(command: argparse.ArgumentParser) -> None:
    """Add what a model of cost is asked with."""
    command.add_argument("--latency", type=_positive, metavar="SECONDS", help=LATENCY)
    command.add_argument("--bandwidth", type=_positive, metavar="RATE", help=BANDWIDTH)
    command.add_argument("--items", type=_positive, metavar="N", help=ITEMS)
    command.add_argument("--items-per-rank", type=_positive, metavar="N", help=EACH)
    command.add_argument("--dimensions", type=int, choices=(1, 2, 3), default=3, help=DIMENSIONS)
    command.add_argument("--series", default="", metavar="NAME", help=SERIES)
    command.add_argument("--plot", type=Path, metavar="FILE", help=PLOT)
    command.add_argument("--step", type=_positive, metavar="SECONDS", help=STEP)
    command.add_argument("--measured-on", type=_whole, metavar="RANKS", help="that --step took")
    command.add_argument("--steps", type=_whole, metavar="N", help="of the run")
    command.add_argument("--on", type=_whole, metavar="RANKS", help="for which a run is predicted")


def _positive(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0.0 < value < math.inf:
        raise argparse.ArgumentTypeError(f"must be a number above 0; found {text!r}")
    return value


def _whole(text: str) -> int:
    value = int(text) if text.isdecimal() else 0
    if value < 1:
        raise argparse.ArgumentTypeError(f"must be a whole number from 1; found {text!r}")
    return value


def scaling(options: argparse.Namespace) -> int:
    """Predict from a file of measurements."""
    # Start-up: only this command needs it.
    from quintet.coupler.bench.scaling_command import run_scaling

    return run_scaling(options)
