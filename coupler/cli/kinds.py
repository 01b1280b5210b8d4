"""Commands that try one kind of component: bench, conform."""

import argparse
from pathlib import Path

from quintet.coupler.cli.options import FOR_PROGRAMS, PRESET, Command, add_settings
from quintet.coupler.cli.scaling import add_model

CASE = "one of the component's cases, may be repeated; all if not given"
THREADS = "of the component, may be repeated; 1, and 2 where there are two cores, if not given"
RANKS = "MPI ranks that share the component out, may be repeated; 1 if not given"
PARAMS = "its parameters in TOML, in place of cases; a table conform in it has what it takes"


def add_commands(command: Command) -> None:
    """Add what tries a kind of component by itself."""
    speed = command("bench", bench, "measure the throughput of a component, or of the exchange")
    speed.add_argument("name", help="the word exchange, or a kind of component")
    speed.add_argument("--case", action="append", default=[], metavar="NAME", help=CASE)
    speed.add_argument("--threads", type=int, action="append", metavar="N", help=THREADS)
    speed.add_argument("--ranks", type=int, action="append", metavar="N", help=RANKS)
    speed.add_argument("--json", type=Path, metavar="FILE", help=FOR_PROGRAMS)
    speed.add_argument(
        "--transport", choices=["zenoh", "mpi"], help="of the exchange; both if not given"
    )
    speed.add_argument("--inside-mpi", action="store_true", help=argparse.SUPPRESS)
    add_model(speed)
    laws = command("conform", conform, "check that a kind of component obeys the contract")
    laws.add_argument("kind", nargs="?", default="", help="an installed kind, or module:Class")
    laws.add_argument("--case", default="", help="one of the kind's cases; all if not given")
    laws.add_argument("--params", type=Path, metavar="FILE", help=PARAMS)
    laws.add_argument(
        "--scene", default="", help="take the parameters from this scene, in place of cases"
    )
    laws.add_argument(
        "--component", default="", metavar="NAME", help="name of the component in that scene"
    )
    laws.add_argument("--preset", default="", help=PRESET)
    add_settings(laws)
    laws.add_argument("--json", type=Path, metavar="FILE", help=FOR_PROGRAMS)


def bench(options: argparse.Namespace) -> int:
    """Measure throughput."""
    if options.name == "exchange":
        # Start-up: only this way of running needs it.
        from quintet.coupler.bench.exchange import run_bench

        return run_bench(options)
    # Start-up: only this command needs it.
    from quintet.coupler.bench.throughput import run_kind

    return run_kind(options)


def conform(options: argparse.Namespace) -> int:
    """Try the laws of the contract on a component."""
    # Start-up: only this command needs it.
    from quintet.coupler.conform.command import run_conform

    return run_conform(options)
