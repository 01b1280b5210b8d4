"""Command that debugs one component of a run."""

import argparse
from pathlib import Path

from quintet.coupler.cli.options import Command

WINDOW = "window to stop in, from 0 (default: that in which it failed, else its last)"
COMMANDS = "commands of pdb, in the place of a terminal, separated by ;"
STOP = "method at whose first line the debugger stops (default: step)"
DEBUGGER = (
    "run the repetition under another program, which gets its command line as arguments, as in "
    "--debugger 'gdb --args'; pdb is left out"
)


def add_commands(command: Command) -> None:
    """Add what debugs runs."""
    debugging = command(
        "debug", debug, "compute one component of a run again, and stop in a window with pdb"
    )
    debugging.add_argument("folder", type=Path, metavar="DIR", help="folder of the run")
    debugging.add_argument("--component", required=True, metavar="NAME", help="which component")
    debugging.add_argument("--window", type=int, help=WINDOW)
    debugging.add_argument("--stop", choices=["take", "step", "give"], default="step", help=STOP)
    debugging.add_argument("--commands", metavar="TEXT", help=COMMANDS)
    debugging.add_argument("--debugger", metavar="COMMAND", help=DEBUGGER)
    debugging.add_argument("--no-stop", action="store_true", help=argparse.SUPPRESS)


def debug(options: argparse.Namespace) -> int:
    """Repeat a component of a run up to a window, and stop there."""
    # Start-up: only this command needs it.
    from quintet.coupler.debug import command

    name, window = options.component, options.window
    if options.debugger:
        arguments = [str(options.folder), "--component", name]
        arguments += [] if window is None else ["--window", str(window)]
        command.under(options.debugger, arguments)
    text = options.commands
    commands = None if text is None else [line.strip() for line in text.split(";")]
    stops = not options.no_stop
    return command.debug(options.folder, name, window, commands, options.stop, stops)
