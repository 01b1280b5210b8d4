"""The command that writes a starting point: new."""

import argparse
from pathlib import Path

from quintet.coupler.cli.options import Command

WHAT = ["scene", "component", "link"]  # one file, or an installable package with a scene and tests
NAME = "of the scene, or of the package and the kind: lower-case letters, digits and _"
OUT = "folder to be made (default: ./NAME); an existing one is refused"


def add_commands(command: Command) -> None:
    """Add what begins something new."""
    begin = command("new", new, "write a small scene, component or link to begin with")
    begin.add_argument("what", choices=WHAT, help="what to begin")
    begin.add_argument("name", help=NAME)
    begin.add_argument("--out", type=Path, metavar="DIR", help=OUT)


def new(options: argparse.Namespace) -> int:
    """Write a starting point and say how to go on."""
    # Start-up: only this command needs it.
    from quintet.coupler.reference.starting_points import next_commands, write_new

    folder = options.out or Path(options.name)
    for path in write_new(options.what, options.name, folder):
        print(f"wrote {path}")
    print("Go on with:")
    for line in next_commands(options.what, options.name, folder):
        print(f"  {line}")
    return 0
