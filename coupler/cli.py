"""The command line."""

import argparse
import os
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from quintet.interfaces.errors import LineError, QuintetError, SceneError

if TYPE_CHECKING:
    from quintet.coupler.scene.scene import Scene

LONGEST = 2000  # characters of a sentence
BAD, INTERRUPTED = 2, 130  # exit status of bad input, with which nothing is started; of Ctrl-C


def main(arguments: Sequence[str] | None = None) -> None:
    """Run one command and exit with its status."""
    given = parser().parse_args(arguments)
    try:
        if isinstance(path := getattr(given, "json", None), Path):
            _require_writable(path)
        status = given.does(given)
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
        prog="quintet", description="Independent solvers, one interface, one coupler."
    )
    top.add_argument("--version", action=Version, nargs=0, help="of quintet")
    commands = top.add_subparsers(required=True, metavar="COMMAND")

    def command(name: str, does: object, text: str) -> argparse.ArgumentParser:
        one = commands.add_parser(name, help=text, description=text)
        one.set_defaults(does=does, command=name)
        return one

    _add_reference(command)
    _add_runs(command)
    _add_studies(command)
    _add_kinds(command)
    return top


Command = Callable[[str, object, str], argparse.ArgumentParser]


def _add_reference(command: Command) -> None:
    """Add what starts no solver."""
    one = command("list", list_scenes, "scenes: name, title, components, presets, run times")
    one.add_argument("--json", action="store_true", help="for programs")
    one = command("check", check, "read a scene, print its plan; start no solver")
    _scene(one)
    one.add_argument("--import", action="store_true", dest="imports", help=IMPORT)
    shape = one.add_mutually_exclusive_group()
    shape.add_argument("--graph", action="store_true", help=GRAPH)
    shape.add_argument("--mermaid", action="store_true", help=MERMAID)
    one = command("describe", describe, "every key of a scene, a kind or a link, with its unit")
    one.add_argument("subject", nargs="*", metavar="SUBJECT", help=SUBJECT)
    one.add_argument("--json", action="store_true", help="for programs")
    one.add_argument("--write", nargs="+", type=Path, default=[], metavar="FILE", help=WRITE)
    one = command("schema", schema, "keys of scene files as a JSON schema, for editors")
    one.add_argument("scene", nargs="?", help="whose module:Class kinds it is to know as well")
    one.add_argument("--import", action="store_true", dest="imports", help=IMPORT)


def _add_runs(command: Command) -> None:
    """Add what runs a scene, and what looks at runs."""
    one = command("run", run, "run a scene, compare it with what it must reproduce")
    _scene(one, nargs="?")
    one.add_argument("--out", type=Path, help=OUT)
    one.add_argument("--force", action="store_true", help=FORCE)
    one.add_argument("--resume", type=Path, metavar="DIR", help=RESUME)
    one.add_argument("--elsewhere", action="append", default=[], metavar="NAME", help=ELSEWHERE)
    one.add_argument("--inside-mpi", action="store_true", help=argparse.SUPPRESS)
    one = command("join", join, "start one component here and join it to a coupler elsewhere")
    _scene(one)
    one.add_argument("name", help="of the component in the scene")
    one.add_argument("--at", required=True, metavar="ENDPOINT", help="of the coupler")
    one = command("show", show, "what happened in a run")
    one.add_argument("folder", type=Path)
    one.add_argument("--json", action="store_true", help="for programs")
    one = command("diff", diff, "first difference between two runs; 0 if there is none")
    one.add_argument("folders", nargs=2, type=Path, metavar="DIR")


def _add_studies(command: Command) -> None:
    """Add what runs a scene many times."""
    one = command("study", series, "error against run time over the refinements of a scene")
    _scene(one)
    _report(one, "runs/SCENE-study")
    one.add_argument("--keep", action="store_true", help=KEEP)
    one = command("stability", series, "stability limits of a scene")
    _scene(one)
    _report(one, "runs/SCENE-stability")
    one = command("scan", series, "whether wrong results of absurd settings are reported")
    _scene(one, nargs="?")
    one.add_argument("--all", action="store_true", help=ALL)
    one.add_argument("--quick", action="store_true", help=QUICK)
    one.add_argument("--name", default="", metavar="SCAN", help="one of the scene's scans")
    _report(one, "runs/SCENE-scan")
    one.add_argument("--keep", action="store_true", help=KEEP)


def _add_kinds(command: Command) -> None:
    """Add what tries a kind of component by itself."""
    one = command("bench", bench, "throughput of one component, or of the exchange")
    one.add_argument("name", help="exchange, or a kind of component")
    one.add_argument("--case", default="", help="one of the component's cases; all if not given")
    one.add_argument("--threads", type=int, action="append", metavar="N", help=THREADS)
    one.add_argument("--json", type=Path, metavar="FILE")
    one.add_argument(
        "--transport", choices=["zenoh", "mpi"], help="of the exchange; both if not given"
    )
    one.add_argument("--inside-mpi", action="store_true", help=argparse.SUPPRESS)
    one = command("conform", conform, "try the laws of the contract on a kind of component")
    one.add_argument("kind", nargs="?", default="", help="an installed kind, or module:Class")
    one.add_argument("--case", default="", help="one of the kind's cases; all if not given")
    one.add_argument("--params", type=Path, metavar="FILE", help=PARAMS)
    one.add_argument("--scene", default="", help="a scene with such a component, in place of cases")
    one.add_argument("--component", default="", metavar="NAME", help="its name in the scene")
    one.add_argument("--preset", default="", help="a preset of the scene")
    one.add_argument("--set", action="append", default=[], metavar="PATH=VALUE", dest="settings")
    one.add_argument("--json", type=Path, metavar="FILE", help="what was found, for programs")


IMPORT = "import kinds that are code of the scene's own, module:Class, and check them too"
GRAPH = "draw components, ports and links instead of the plan"
MERMAID = "the same as a Mermaid flowchart, for texts that draw it"
SUBJECT = (
    "scene, a kind, or link and its kind; then one table or key of it; a list if none is given"
)
WRITE = "fill in the tables between <!-- describe SUBJECT --> and <!-- described --> of texts"
KEEP = "keep runs that were completed in DIR before, of the same scene on the same machine"
ALL = "scan all scenes that come with quintet and have scans"
QUICK = "with --all: the preset quick of scenes that have one"
OUT = "folder of the run, new or empty (default: runs/SCENE, or the next number that is free)"
FORCE = "replace a former one in that folder: only the files that it wrote"
RESUME = "go on with an interrupted or failed run, from its last snapshot"
THREADS = "of the component, may be repeated; 1, and 2 where there are two cores, if not given"
PARAMS = "its parameters in TOML, in place of cases; a table conform in it has what it takes"
ELSEWHERE = "do not start this component: it joins by hand, with quintet join"


class Version(argparse.Action):
    """Print the version that is installed, and end."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        """Read it from the package's metadata."""
        # Start-up: only this option needs it.
        from importlib.metadata import version

        print(f"quintet {version('quintet')}")
        parser.exit()


def _scene(one: argparse.ArgumentParser, **more: Any) -> None:
    one.add_argument("scene", help="a name from quintet list, or a TOML file", **more)
    one.add_argument("--preset", default="", help="a preset of the scene")
    one.add_argument("--set", action="append", default=[], metavar="PATH=VALUE", dest="settings")
    one.add_argument("--swap", action="append", default=[], metavar="NAME=KIND", help=SWAP)
    one.add_argument("--transport", choices=["memory", "zenoh", "mpi"], default="")


def _report(one: argparse.ArgumentParser, folder: str) -> None:
    one.add_argument("--json", type=Path, metavar="FILE", help="what was found, for programs")
    one.add_argument("--out", type=Path, metavar="DIR", help=f"of all runs (default: {folder})")
    one.add_argument("--force", action="store_true", help=FORCE)


SWAP = "replace a component: NAME=replay, NAME=replay@RUN, NAME=prescribed, NAME=module:Class"


def _load(given: argparse.Namespace) -> "Scene":
    # Start-up: only this command needs it.
    from quintet.coupler.scene.overrides import tell_repeated
    from quintet.coupler.scene.read import load

    tell_repeated(given.settings, given.swap)
    asked = (given.scene, given.preset, given.settings, given.swap, given.transport)
    return load(*asked, imports=getattr(given, "imports", True))


def list_scenes(given: argparse.Namespace) -> int:
    """List the scenes that come with quintet."""
    # Start-up: only this command needs it.
    from quintet.coupler.scene.listing import list_all

    list_all(given.json)
    return 0


def check(given: argparse.Namespace) -> int:
    """Print the plan of a scene, or draw who is linked to whom."""
    scene = _load(given)
    # Start-up: only this command needs it.
    from quintet.coupler.scene import graph
    from quintet.coupler.scene.listing import console, print_plan, tell_unread
    from quintet.coupler.scene.needs import require_memory

    require_memory(scene)
    if given.graph or given.mermaid:
        print(graph.mermaid(scene) if given.mermaid else graph.drawing(scene))
        tell_unread(scene)
    else:
        print_plan(scene, console())
    return 0


def describe(given: argparse.Namespace) -> int:
    """Print what a scene, a kind or a link may say."""
    # Start-up: only this command needs it.
    from quintet.coupler.reference.describe import run_describe

    return run_describe(given)


def schema(given: argparse.Namespace) -> int:
    """Print the JSON schema of scene files."""
    # Start-up: only this command needs it.
    from quintet.coupler.reference.schema import as_text, scene_schema
    from quintet.coupler.scene.listing import tell_unread
    from quintet.coupler.scene.read import load

    scene = load(given.scene, imports=given.imports) if given.scene else None
    plans = scene.components.values() if scene else ()
    kinds = [one.kind for one in plans if not one.unread]
    if scene:
        tell_unread(scene)
    print(as_text(scene_schema(kinds)))
    return 0


def run(given: argparse.Namespace) -> int:
    """Run a scene, from the start or from a snapshot."""
    scene, out, snapshot = _resumed(given) if given.resume else _begun(given)
    scene.elsewhere = set(given.elsewhere)
    unknown = scene.elsewhere - set(scene.components)
    if unknown or (scene.elsewhere and scene.transport != "zenoh"):
        raise SceneError("--elsewhere needs components of the scene, and the transport zenoh.")
    # Start-up: only this command needs it.
    from quintet.coupler.report import show as report
    from quintet.coupler.run.run_scene import resume_scene, run_scene

    if given.inside_mpi:
        return _run_rank(scene, out or Path(), snapshot)
    if snapshot and out:
        folder, status = out, resume_scene(scene, out, snapshot, own_process=True)
    else:
        folder, status = run_scene(scene, out, given.force, own_process=True)
    if status != BAD and (folder / report.NAME).is_file():
        report.show(folder)
        print(f"left in {os.path.relpath(folder)}", flush=True)
    return status


def _run_rank(scene: "Scene", folder: Path, snapshot: Path | None) -> int:
    """Run as the coupler's rank of an MPI job."""
    # Start-up: only this way of running needs it.
    from quintet.coupler.launch.mpi_job import begin_rank, end_rank
    from quintet.coupler.run.simulate import simulate

    begin_rank(folder)
    status = simulate(scene, folder, snapshot, own_process=True)
    end_rank(folder, status)
    return 0  # who started the job reads the status; MPI takes any other for a failure


def _begun(given: argparse.Namespace) -> tuple["Scene", Path | None, None]:
    """Read the scene of a new run; return it with the folder that is given for the run."""
    if given.scene is None:
        raise SceneError("run needs a scene, or --resume DIR. Give one.")
    return _load(given), given.out, None


def _resumed(given: argparse.Namespace) -> tuple["Scene", Path, Path]:
    """Read the scene of a run to be resumed, as it was run or as it is given now."""
    # Start-up: only this command needs it.
    from quintet.coupler.run import snapshots
    from quintet.coupler.run.folder import check_ours

    if given.out:
        raise SceneError("--resume goes on in the folder of the run. Remove --out.")
    if given.force:
        raise SceneError("--resume replaces nothing. Remove --force.")
    folder = given.resume.resolve()
    check_ours(folder, "run")
    snapshot = snapshots.latest(folder, given.inside_mpi)
    scene = _load(given) if given.scene else snapshots.scene_of(snapshot, given.transport)
    snapshots.check_same(scene, folder)
    return scene, folder, snapshot


def join(given: argparse.Namespace) -> int:
    """Start one component of a scene, joined to a coupler elsewhere."""
    # Start-up: only this command needs it.
    from quintet.interfaces.lines.endpoint import check_endpoint
    from quintet.interfaces.params import unknown
    from quintet.interfaces.serving.process import main as component

    scene = _load(given)
    if given.name not in scene.components:
        raise SceneError(unknown(f"component {given.name}", given.name, scene.components))
    try:
        check_endpoint(given.at, scene.security)
    except LineError as error:
        raise SceneError(f"--at {error}") from error
    one = scene.components[given.name]
    arguments = ["--name", given.name, "--at", given.at]
    if scene.tls:
        arguments += ["--tls", *scene.tls]
    component(one.manifest, arguments)
    return 0


def show(given: argparse.Namespace) -> int:
    """Print the summary of a run."""
    # Start-up: only this command needs it.
    from quintet.coupler.report.show import show as print_run

    print_run(given.folder, given.json)
    return 0


def diff(given: argparse.Namespace) -> int:
    """Compare two runs bit by bit."""
    # Start-up: only this command needs it.
    from quintet.coupler.report.diff import compare, sentence

    found = compare(*given.folders)
    print(sentence(found))
    return 0 if found is None else 1


def series(given: argparse.Namespace) -> int:
    """Run a scene many times: a study, stability limits, or scans."""
    # Start-up: only these commands need them.
    from quintet.coupler.study.scan import run_scan
    from quintet.coupler.study.stability import run_stability
    from quintet.coupler.study.study import run_study

    runs = {"study": run_study, "stability": run_stability, "scan": run_scan}
    return runs[given.command](given)


def bench(given: argparse.Namespace) -> int:
    """Measure throughput."""
    if given.name == "exchange":
        # Start-up: only this way of running needs it.
        from quintet.coupler.bench.exchange import run_bench

        return run_bench(given)
    # Start-up: only this command needs it.
    from quintet.coupler.bench.throughput import run_kind

    return run_kind(given)


def conform(given: argparse.Namespace) -> int:
    """Try the laws of the contract on a component."""
    # Start-up: only this command needs it.
    from quintet.coupler.conform.command import run_conform

    return run_conform(given)


if __name__ == "__main__":
    main()
