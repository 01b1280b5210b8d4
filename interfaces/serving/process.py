"""A component as a process of its own: join the coupler, be told the parameters, serve."""

import argparse
import contextlib
import faulthandler
import os
import signal
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import psutil

from quintet.interfaces.component import Component, Resources, make
from quintet.interfaces.errors import LineError, QuintetError, SceneError
from quintet.interfaces.libraries import require
from quintet.interfaces.lines.endpoint import Security, on_loopback
from quintet.interfaces.lines.process_status import numbering
from quintet.interfaces.lines.transport import Line
from quintet.interfaces.manifest import Manifest, find, look_in
from quintet.interfaces.params import read
from quintet.interfaces.serving.failing import failure
from quintet.interfaces.serving.log_stream import print_into_logs
from quintet.interfaces.serving.malloc import keep_freed_memory
from quintet.interfaces.serving.notices import listen, notice
from quintet.interfaces.serving.orders import check_order
from quintet.interfaces.serving.serve import LONGEST_WAIT, Server, serve

if TYPE_CHECKING:
    from quintet.interfaces.serving.ranks import Ranks

LINGERING = 10.0  # s
PREPARING = 60.0  # s for the coupler to make the folder of the logs
# Asks a component where in its code it is: one of the signals that no library uses for itself.
STACK_SIGNAL = signal.SIGRTMIN + 7
LOOK_IN = "look for module:Class here too, after all that is installed; may be repeated"
SECRET = "QUINTET_SECRET"  # set where the coupler has started the component: that of its messages
STARTER = "QUINTET_STARTER"  # set where a run was started by another process here: which one

LAUNCHER = "QUINTET_LAUNCHER"  # set where a shell lies between the launcher of ranks and this one


def main(manifest: Manifest | None = None, arguments: list[str] | None = None) -> None:
    """Run one component; ``python -m quintet.components.KIND`` comes here."""
    parser = argparse.ArgumentParser(description="One component of a coupled run.")
    if manifest is None:
        parser.add_argument("kind", help="an installed kind, or module:Class")
    parser.add_argument("--name", required=True, help="its name in the scene")
    where = parser.add_mutually_exclusive_group(required=True)
    where.add_argument("--at", metavar="ENDPOINT", help="the coupler's zenoh endpoint")
    where.add_argument("--mpi", action="store_true", help="started by mpiexec; rank 0 couples")
    parser.add_argument("--tls", nargs=3, metavar=("AUTHORITY", "CERTIFICATE", "KEY"))
    parser.add_argument("--log", help="file for all that it prints")
    parser.add_argument("--ranks", type=int, default=1, help="MPI ranks of the component")
    parser.add_argument("--first", type=int, default=0, help="number of its first in the MPI job")
    parser.add_argument("--look-in", action="append", default=[], metavar="DIR", help=LOOK_IN)
    options = parser.parse_args(arguments)
    if options.log:
        redirect(options.log if options.ranks == 1 else own_log(options))
    print_into_logs()
    look_in(options.look_in)
    sys.exit(run(manifest or find(options.kind), options))


def own_log(options: argparse.Namespace) -> str:
    """File for what this rank of a component prints."""
    # Only a component of several ranks loads MPI here.
    from quintet.interfaces.serving.ranks import rank_in_job

    return log_of_rank(options.log, rank_in_job() - options.first)


def log_of_rank(path: str, rank: int) -> str:
    """File for what a rank of a component prints: ``water.log``, ``water.rank1.log``."""
    return str(Path(path).with_suffix(f".rank{rank}.log")) if rank else path


def redirect(path: str) -> None:
    """Send all output of the process, and of the libraries in it, to a file.

    Whoever prepares its folder may start at the same time, as in an MPI job.
    """
    limit = time.monotonic() + PREPARING
    while not os.path.isdir(os.path.dirname(path) or ".") and time.monotonic() < limit:
        time.sleep(0.05)
    file = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o644)
    os.dup2(file, 1)
    os.dup2(file, 2)
    os.close(file)


def run(manifest: Manifest, options: argparse.Namespace) -> int:
    """Join, build, serve; return the exit status."""
    # Ctrl-C reaches the whole terminal; the coupler answers it and tells the components.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    # Both work while a solver computes, and while it holds the interpreter's lock.
    faulthandler.enable()
    faulthandler.register(STACK_SIGNAL, all_threads=False)
    keep_freed_memory()
    listen(say)
    say(f"{options.name}: {manifest.title}, process {os.getpid()}")
    try:
        hello = {"order": "hello", "kind": manifest.kind, **about_me()}
        ranks = join_ranks(options) if options.ranks > 1 else None
        line = join_coupler(options, hello, ranks)
        line.send(hello, {})
        order = line.receive(LONGEST_WAIT)  # others may join later, or be started by hand
    except QuintetError as error:
        say(f"{options.name}: {error}")
        return 3
    if order.order != "go":
        return 0
    status, lost = 3, False
    try:
        start = time.perf_counter()
        component = build(manifest, order.header, ranks.communicator if ranks else None)
        seconds = time.perf_counter() - start
        say(f"built in {seconds:.1f} s: {component.items()} items")
        server = make_server(component, options.name, seconds, line, ranks)
        if serve(server, line):
            status = 0
    except LineError as error:
        say(f"{options.name}: the coupler: {error}")
        end_children()  # nobody else does
        lost = not options.mpi  # the coupler is told by the end of this process
    except (Exception, SystemExit) as error:
        report = failure(error)
        say(str(report["traceback"]) or str(error))
        line.send(report, {})
    if status and not lost:
        linger(line)
    line.close()
    say(f"{options.name}: " + ("stopped" if status else "finished"))
    return status


def join_ranks(options: argparse.Namespace) -> "Ranks":
    """Meet the other ranks of the component."""
    require("mpi4py", "a component of several ranks")
    # Only a component of several ranks loads MPI here.
    from quintet.interfaces.lines.mpi import self_check
    from quintet.interfaces.serving.ranks import Ranks

    if not options.mpi:
        self_check(options.ranks)
    return Ranks(options.name, options.first, options.ranks, about_me())


def join_coupler(options: argparse.Namespace, hello: dict[str, Any], ranks: "Ranks | None") -> Any:
    """Connect to the coupler, or to the rank of this component that does."""
    if ranks and ranks.rank:
        os.environ.pop(SECRET, "")
        return ranks.follow()
    if ranks:
        hello["ranks"] = ranks.about_others()
    line = over_mpi(options.name) if options.mpi else over_zenoh(options, hello)
    return ranks.lead(line) if ranks else line


def make_server(
    component: Component, name: str, seconds: float, line: Any, ranks: "Ranks | None"
) -> Server:
    """Make what carries out the coupler's orders."""
    if ranks is None:
        return Server(component, name, seconds)
    # Only a component of several ranks loads MPI here.
    from quintet.interfaces.serving.following import FollowingServer

    server = FollowingServer if ranks.rank else Server
    return server(component, name, seconds, line.spread)


def linger(line: Line) -> None:
    """Stay until the coupler has read what went wrong: leaving would end an MPI job at once."""
    limit = time.monotonic() + LINGERING
    with contextlib.suppress(QuintetError):
        while (left := limit - time.monotonic()) > 0.0:
            line.receive(left)  # orders that were on their way


def build(manifest: Manifest, header: dict[str, Any], communicator: Any = None) -> Component:
    """Check the parameters, then import the solver and make the component."""
    check_order("go", header)
    folder = Path(header.get("folder", ""))
    device = str(header.get("device", "cpu"))
    resources = Resources(int(header["threads"]), folder, communicator, device)
    starts = bool(header.get("starts", True))
    params, mistakes = read(
        manifest.params, header["params"], manifest.kind, resources.folder, starts
    )
    if mistakes:
        raise SceneError(mistakes)
    notice("importing the solver")
    solver = manifest.load(device)
    notice("building")
    return make(solver, params, resources)


def over_zenoh(options: argparse.Namespace, hello: dict[str, Any]) -> Line:
    """Connect over zenoh; only a process that does so imports it."""
    require("zenoh", "a component that joins over zenoh")
    # What a run does not use is not loaded: zenoh starts threads.
    from quintet.interfaces.lines.zenoh import connect, join

    security = Security(*options.tls) if options.tls else None
    secret = os.environ.pop(SECRET, "")  # processes that the solver starts need not have it
    if secret:
        line = connect(options.at, options.name, security, secret)
    else:
        line = join(
            options.at, options.name, hello, security, lambda text: say(f"{options.name}: {text}")
        )
        if not on_loopback(options.at):
            # Only components on other hosts give signs of life.
            from quintet.interfaces.lines.signs import Signs

            line.session.signs = Signs(options.at, security, line.session.root, options.name)
    line.session.dropped.tell = lambda text: say(f"{options.name}: {text}")
    return line


def over_mpi(name: str) -> Line:
    """Connect over MPI to rank 0, which couples."""
    # What a run does not use is not loaded: mpi4py starts MPI.
    from quintet.interfaces.lines.mpi import MpiLine

    launcher = int(os.environ.get(LAUNCHER, os.getppid()))
    return MpiLine("", name, "coupler", 0, launcher if launched_here() else 0)


def launched_here() -> bool:
    """Whether the launcher of the ranks runs on this host and ends with the run."""
    return STARTER in os.environ


def about_me() -> dict[str, Any]:
    """What the coupler needs to watch this process, and to clean up after it."""
    return {
        "pid": os.getpid(),
        "host": os.uname().nodename,
        "numbering": numbering(),
        "shared": shared_files(),
        "stack": int(STACK_SIGNAL),
    }


def end_children() -> None:
    """Kill all processes that this one has started and that still run."""
    for child in psutil.Process().children(recursive=True):
        with contextlib.suppress(psutil.NoSuchProcess):
            child.kill()


def shared_files(pid: int | str = "self") -> list[str]:
    """Files in shared memory that a process maps; a killed process leaves them behind."""
    try:
        lines = Path(f"/proc/{pid}/maps").read_text(errors="replace").splitlines()
    except OSError:  # it has ended meanwhile
        return []
    return sorted({line.split(maxsplit=5)[5].strip() for line in lines if "/dev/shm/" in line})


def say(text: str) -> None:
    """Print one line to the component's log."""
    print(text, flush=True)


if __name__ == "__main__":
    main()
