"""Options that several commands share."""

import argparse
import math
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from quintet.coupler.scene.scene import Scene

BAD = 2  # exit status of bad input, with which nothing is started

Action = Callable[[argparse.Namespace], int]
Command = Callable[[str, Action, str], argparse.ArgumentParser]

PRESET = "a preset of the scene"
SET = "set a key of the scene, as in components.plate.thickness=0.002; may be repeated"
SWAP = "replace a component: NAME=replay, NAME=replay@RUN, NAME=prescribed, NAME=module:Class"
TRANSPORT = "how messages travel (default: key transport of the scene)"
TRANSPORTS = ["memory", "zenoh", "mpi"]
FORCE = "replace a former run in that folder; only files that it wrote are removed"
IMPORT = "also import and check kinds module:Class, which are code beside the scene"
FOR_PROGRAMS = "write the results as JSON to this file"


def seconds(text: str) -> float:
    """Read a time of an option [s]."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0.0 <= value < math.inf:
        raise argparse.ArgumentTypeError(f"must be seconds, 0 or more; found {text!r}")
    return value


def seed(text: str) -> int:
    """Read a seed."""
    if not text.isdecimal():
        raise argparse.ArgumentTypeError(f"must be a whole number, 0 or more; found {text!r}")
    return int(text)


def add_scene(command: argparse.ArgumentParser, **more: Any) -> None:
    """Add a scene and everything that changes it."""
    command.add_argument("scene", help="a name from quintet list, or a TOML file", **more)
    command.add_argument("--preset", default="", help=PRESET)
    add_settings(command)
    command.add_argument("--swap", action="append", default=[], metavar="NAME=KIND", help=SWAP)
    command.add_argument("--transport", choices=TRANSPORTS, default="", help=TRANSPORT)


def add_settings(command: argparse.ArgumentParser) -> None:
    """Add keys of a scene that are set on the command line."""
    command.add_argument(
        "--set", action="append", default=[], metavar="PATH=VALUE", dest="settings", help=SET
    )


def add_report(command: argparse.ArgumentParser, folder: str) -> None:
    """Add where a command that runs a scene many times writes."""
    command.add_argument("--json", type=Path, metavar="FILE", help=FOR_PROGRAMS)
    command.add_argument(
        "--out", type=Path, metavar="DIR", help=f"folder of all runs (default: {folder})"
    )
    command.add_argument("--force", action="store_true", help=FORCE)


def load_scene(options: argparse.Namespace) -> "Scene":
    """Read the scene that the options name and change."""
    # Start-up: only commands that read a scene need it.
    from quintet.coupler.scene.overrides import tell_repeated
    from quintet.coupler.scene.read import load

    tell_repeated(options.settings, options.swap)
    changes = (options.preset, options.settings, options.swap, options.transport)
    return load(options.scene, *changes, imports=getattr(options, "imports", True))
