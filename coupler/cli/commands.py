"""Run one command and turn its errors into sentences and an exit status."""

import argparse
import os
import sys
import traceback
from collections.abc import Sequence
from pathlib import Path

from quintet.coupler.cli import (
    certificates,
    debugging,
    examples,
    kinds,
    launching,
    pictures,
    reference,
    runs,
    scaling,
    starting,
    studies,
)
from quintet.coupler.cli.options import BAD, Action
from quintet.interfaces.errors import QuintetError, SceneError

LONGEST = 2000  # characters of a sentence
FAILED = 3  # exit status of a run that failed, and of an error in quintet itself
INTERRUPTED = 130  # exit status after Ctrl-C


def main(arguments: Sequence[str] | None = None) -> None:
    """Run one command and exit with its status."""
    top = parser()
    if "_ARGCOMPLETE" in os.environ:  # a shell asks for words, by argcomplete
        # Start-up: no other command needs it.
        from quintet.coupler.cli.completion import answer

        answer(top)
    options = top.parse_args(arguments)
    try:
        if isinstance(path := getattr(options, "json", None), Path):
            _require_writable(path)
        status = options.action(options)
    except SceneError as error:
        for mistake in error.mistakes:
            print(f"quintet: {sentence(mistake)}", file=sys.stderr)
        status = BAD
    except QuintetError as error:
        print(f"quintet: {error}", file=sys.stderr)
        status = BAD
    except KeyboardInterrupt:  # before anything was started, or after all was written
        print("\nquintet: interrupted", file=sys.stderr)
        status = INTERRUPTED
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        status = 0
    except Exception:  # Python would end with 1, the status of expectations that are not met
        traceback.print_exc()
        status = FAILED
    sys.exit(status)


def sentence(mistake: str) -> str:
    """Write a mistake on one line, whatever names are in it; of a very long one both ends."""
    line = " ".join(mistake.splitlines())
    return line if len(line) <= LONGEST else f"{line[: LONGEST // 2]} ... {line[-LONGEST // 2 :]}"


def _require_writable(path: Path) -> None:
    # Start-up: only commands that leave a file need it.
    from quintet.coupler.files.json_file import require_writable

    require_writable(path)


def parser() -> argparse.ArgumentParser:
    """All commands and their options."""
    top = argparse.ArgumentParser(
        prog="quintet", description="Couple independent solvers that run as separate processes."
    )
    top.add_argument("--version", action=Version, nargs=0, help="print the version of quintet")
    commands = top.add_subparsers(required=True, metavar="COMMAND")

    def command(name: str, action: Action, text: str) -> argparse.ArgumentParser:
        added = commands.add_parser(
            name,
            help=text,
            description=text,
            epilog=examples.text_of(name),
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        added.set_defaults(action=action, command=name)
        return added

    for group in (
        reference, starting, runs, pictures, debugging, launching, certificates, studies, kinds,
        scaling,
    ):  # fmt: skip
        group.add_commands(command)
    return top


class Version(argparse.Action):
    """Print the version that is installed, and end."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        """Read it from the package's metadata."""
        # Start-up: only this option needs it.
        from importlib.metadata import version

        print(f"quintet {version('quintet')}")
        parser.exit()
