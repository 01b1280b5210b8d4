"""Commands that run a scene, and that read runs: run, join, compile, show, diff."""

import argparse
import json
import os
from pathlib import Path
from typing import TYPE_CHECKING

from quintet.coupler.cli.options import (
    BAD,
    FORCE,
    Command,
    add_scene,
    add_settings,
    load_scene,
    seconds,
    seed,
)
from quintet.interfaces.errors import LineError, SceneError
from quintet.interfaces.serving.log_stream import outlive_readers
from quintet.interfaces.serving.process import STARTER

if TYPE_CHECKING:
    from quintet.coupler.scene.scene import ComponentPlan, Scene

OUT = "folder of the run, new or empty (default: runs/SCENE, or the next number that is free)"
RESUME = "continue an interrupted or failed run from its last snapshot"
ELSEWHERE = "do not start this component: quintet join starts it, here or on another host"
GRACE = (
    "after Ctrl-C or SIGTERM, wait so much longer for the end of the window and the snapshot "
    "(default: 0, which is about a second in all)"
)
TLS = "files with which it connects over tls (default: tls of the scene)"
CHAOS = (
    "disturb the run on purpose at places that this seed chooses: kill, stop and slow down "
    "processes, delay, drop, duplicate and corrupt messages, fill the disk"
)
ERROR_BAR = (
    "estimate the error that the coupling makes in the watched quantities: --set error_bar.on=true"
)
TRACE = "write when each component computed and waited, for quintet trace (sets output.trace)"
COMPILED = "scenes, or kinds, which stand for all scenes that use them (default: all scenes)"


def add_commands(command: Command) -> None:
    """Add what runs a scene, and what reads runs."""
    running = command("run", run, "run a scene and compare it with its expectations")
    add_scene(running, nargs="?")
    running.add_argument("--out", type=Path, help=OUT)
    running.add_argument("--force", action="store_true", help=FORCE)
    running.add_argument("--resume", type=Path, metavar="DIR", help=RESUME)
    running.add_argument("--elsewhere", action="append", default=[], metavar="NAME", help=ELSEWHERE)
    running.add_argument("--grace", type=seconds, default=0.0, metavar="SECONDS", help=GRACE)
    running.add_argument("--error-bar", action="store_true", help=ERROR_BAR)
    running.add_argument("--chaos", type=seed, metavar="SEED", help=CHAOS)
    running.add_argument("--trace", action="store_true", help=TRACE)
    running.add_argument("--inside-mpi", action="store_true", help=argparse.SUPPRESS)
    joining = command("join", join, "start one component here and join it to a coupler elsewhere")
    add_scene(joining)
    joining.add_argument("name", help="name of the component in the scene")
    joining.add_argument("--at", required=True, metavar="ENDPOINT", help="endpoint of the coupler")
    joining.add_argument(
        "--tls", nargs=3, default=(), metavar=("AUTHORITY", "CERTIFICATE", "KEY"), help=TLS
    )
    compiling = command("compile", compile_kernels, "compile kernels ahead of the first run")
    compiling.add_argument("names", nargs="*", metavar="SCENE|KIND", help=COMPILED)
    compiling.add_argument("--preset", default="", help="a preset of the scene (default: quick)")
    add_settings(compiling)
    showing = command("show", show, "print the results of a run again")
    showing.add_argument("folder", type=Path)
    showing.add_argument("--json", action="store_true", help="print JSON")
    comparing = command(
        "diff", diff, "print the first difference between two runs; exit status 0 if none"
    )
    comparing.add_argument("folders", nargs=2, type=Path, metavar="DIR")


def run(options: argparse.Namespace) -> int:
    """Run a scene, from the start or from a snapshot."""
    outlive_readers()
    if options.trace:
        _ask_for_trace(options)
    scene, out, snapshot = _resumed(options) if options.resume else _begun(options)
    scene.elsewhere, scene.grace = set(options.elsewhere), options.grace
    scene.chaos = options.chaos
    unknown = scene.elsewhere - set(scene.components)
    if unknown or (scene.elsewhere and scene.transport != "zenoh"):
        raise SceneError("--elsewhere needs components of the scene, and the transport zenoh.")
    # Start-up: only this command needs it.
    from quintet.coupler.report import show as report
    from quintet.coupler.run.run_scene import resume_scene, run_scene

    rank = options.inside_mpi
    if rank and STARTER in os.environ:
        return _run_rank(scene, out or Path(), snapshot)
    if snapshot and out:
        folder, status = out, resume_scene(scene, out, snapshot, own_process=True, rank=rank)
    else:
        folder, status = run_scene(scene, out, options.force, own_process=True, rank=rank)
    if status != BAD and (folder / report.NAME).is_file():
        report.show(folder)
        print(f"left in {os.path.relpath(folder)}", flush=True)
    if rank:
        _leave_job(folder, status)
    return status


def _ask_for_trace(options: argparse.Namespace) -> None:
    """Set the key of the scene that asks for a trace."""
    if options.resume:
        raise SceneError(
            "--trace is for the start of a run: --resume goes on with the trace that the run has, "
            "or without. Remove --trace."
        )
    options.settings = [*options.settings, "output.trace=true"]


def _leave_job(folder: Path, status: int) -> None:
    """End the coupler's rank of a job whose launcher waits for all ranks, and starts no other."""
    # Start-up: only this way of running needs it.
    from quintet.coupler.launch.mpi_job import end_rank

    end_rank(folder, status)


def _run_rank(scene: "Scene", folder: Path, snapshot: Path | None) -> int:
    """Run as the coupler's rank of an MPI job."""
    # Start-up: only this way of running needs it.
    from quintet.coupler.launch.mpi_job import begin_rank, end_rank
    from quintet.coupler.run.simulate import simulate

    begin_rank(folder)
    status = simulate(scene, folder, snapshot, own_process=True)
    end_rank(folder, status)
    return 0  # who started the job reads the status; MPI takes any other for a failure


def _begun(options: argparse.Namespace) -> tuple["Scene", Path | None, None]:
    """Read the scene of a new run; return it with the folder that is given for the run."""
    if options.scene is None:
        raise SceneError("run needs a scene, or --resume DIR. Give one.")
    if options.error_bar:
        options.settings.append("error_bar.on=true")
    return load_scene(options), options.out, None


def _resumed(options: argparse.Namespace) -> tuple["Scene", Path, Path]:
    """Read the scene of a run to be resumed, as it was run or as it is given now."""
    # Start-up: only this command needs it.
    from quintet.coupler.run import snapshots
    from quintet.coupler.run.folder import check_ours

    if options.out:
        raise SceneError("--resume goes on in the folder of the run. Remove --out.")
    if options.force:
        raise SceneError("--resume replaces nothing. Remove --force.")
    if options.error_bar:
        raise SceneError("--resume goes on as the run began. Remove --error-bar.")
    folder = options.resume.resolve()
    check_ours(folder, "run")
    snapshot = snapshots.latest(folder, options.inside_mpi)
    changed = load_scene(options) if options.scene else None
    scene = changed or snapshots.scene_of(snapshot, options.transport)
    snapshots.check_same(scene, folder)
    return scene, folder, snapshot


def join(options: argparse.Namespace) -> int:
    """Start one component of a scene, joined to a coupler elsewhere."""
    # Start-up: only this command needs it.
    from quintet.interfaces.lines.endpoint import check_endpoint
    from quintet.interfaces.params import unknown
    from quintet.interfaces.serving.process import main as serve_component

    if options.tls:
        others = [text for text in options.settings if not text.startswith("tls=")]
        options.settings = [*others, f"tls={json.dumps(list(options.tls))}"]
    scene = load_scene(options)
    if options.name not in scene.components:
        raise SceneError(unknown(f"component {options.name}", options.name, scene.components))
    try:
        check_endpoint(options.at, scene.security)
    except LineError as error:
        raise SceneError(f"--at {error}") from error
    arguments = ["--name", options.name, "--at", options.at]
    if scene.tls:
        arguments += ["--tls", *scene.tls]
    plan = scene.components[options.name]
    if plan.ranks > 1:
        _join_ranks(plan, arguments, scene.import_folders)
    serve_component(plan.manifest, arguments)
    return 0


def _join_ranks(plan: "ComponentPlan", arguments: list[str], folders: list[str]) -> None:
    """Become the launcher of the ranks of a component."""
    # Start-up: only a component of several ranks needs it.
    from quintet.coupler.launch.mpi_job import find_launcher
    from quintet.coupler.launch.processes import PYTHON, environment

    line = [*find_launcher(), "-n", str(plan.ranks), *PYTHON, "-m", "mpi4py"]
    line += ["-m", "quintet.interfaces.serving.process", plan.kind, *arguments]
    line += ["--ranks", str(plan.ranks)]
    line += [word for folder in folders for word in ("--look-in", folder)]
    os.execvpe(line[0], line, environment(plan.threads))


def compile_kernels(options: argparse.Namespace) -> int:
    """Compile the kernels of scenes, as after an installation or in a container's build."""
    # Start-up: only this command needs it.
    from quintet.coupler.run.compilation import run_compile

    return run_compile(options)


def show(options: argparse.Namespace) -> int:
    """Print the summary of a run."""
    # Start-up: only this command needs it.
    from quintet.coupler.report.show import show as print_run

    print_run(options.folder, options.json)
    return 0


def diff(options: argparse.Namespace) -> int:
    """Compare two runs bit by bit."""
    # Start-up: only this command needs it.
    from quintet.coupler.report.diff import compare, only_in_one, sentence

    difference = compare(*options.folders)
    print(sentence(difference))
    for folder, names in zip(options.folders, only_in_one(*options.folders), strict=True):
        if names and difference and difference.kind != "names":
            print(f"Only {folder} has: {', '.join(names)}.")
    return 0 if difference is None else 1
