"""Components that say hello to the coupler: who they are, and the processes to be watched."""

import signal
import socket
from functools import partial
from pathlib import Path
from typing import Any

from quintet.coupler.coupling.participant import ComponentFailed, Participant
from quintet.coupler.launch import stack
from quintet.coupler.launch.mpi_job import exit_files
from quintet.coupler.launch.process_probe import ProcessProbe
from quintet.coupler.launch.ranks_probe import RanksProbe
from quintet.coupler.scene.scene import Scene
from quintet.interfaces.lines.message import Message
from quintet.interfaces.lines.process_status import numbering
from quintet.interfaces.serving.failing import sendable
from quintet.interfaces.serving.process import log_of_rank


def settings(scene: Scene, name: str) -> dict[str, Any]:
    """What a component is told before it is built."""
    plan = scene.components[name]
    return {
        "params": plan.params,
        "threads": plan.threads,
        "folder": str(scene.folder.resolve()),
        **({"starts": False} if plan.begun else {}),
        **({"device": plan.device} if plan.device != "cpu" else {}),
    }


def probe_of(
    scene: Scene, name: str, folder: Path | None = None, awaited: bool = False
) -> ProcessProbe:
    """Make what watches a component; with a folder, its exit status is written there."""
    plan = scene.components[name]
    if plan.ranks > 1:
        return RanksProbe(name, awaited=awaited, by_hand=awaited)
    exits = exit_files(folder, name, 1, 0)[0] if folder else None
    return ProcessProbe(name, awaited=awaited, by_hand=awaited, exit_file=exits)


def accept(
    scene: Scene,
    participant: Participant,
    hello: Message,
    probe: ProcessProbe,
    folder: Path,
    first: int,
) -> None:
    """Accept a component: check its kind, find its processes, send its parameters.

    `first` is the number of its first rank in its MPI job.
    """
    identify(scene, participant.name, hello, probe, folder, first)
    participant.send_order("go", **settings(scene, participant.name))


def identify(
    scene: Scene, name: str, hello: Message, probe: ProcessProbe, folder: Path, first: int
) -> None:
    """Check who a component says that it is, and let its probe find its processes."""
    expected = scene.components[name].manifest.kind
    header = hello.header
    if hello.order != "hello" or header.get("kind") != expected:
        raise ComponentFailed(
            name,
            0,
            f"{expected} must say hello; found {header.get('kind')!r}. Start that.",
        )
    probe.awaited = False
    others = header.get("ranks", [])
    count = scene.components[name].ranks
    if not isinstance(others, list) or len(others) != count - 1:
        cause = f"its hello must tell of {count - 1} further ranks; found {others!r:.80}."
        raise ComponentFailed(name, 0, cause)
    for about in (header, *others):
        _check_process(name, about)
    log = log_of(folder, name)
    find_process(probe, header, log)
    if probe.host:
        probe.host.name = sendable(str(header.get("host")))[:80]
    if isinstance(probe, RanksProbe):
        exits = exit_files(folder, name, count, first)
        for rank, (about, path) in enumerate(zip([header, *others], exits, strict=True)):
            place = f"rank {rank} on {str(about.get('host'))[:80]}"
            process = ProcessProbe(place, exit_file=path)
            find_process(process, about, Path(log_of_rank(str(log), rank)))
            probe.ranks.append(process)
        probe.where = probe.calls


def _check_process(name: str, about: Any) -> None:
    """Refuse what names no process: it is watched, sent a signal for its stack, and killed."""
    about = about if isinstance(about, dict) else {}
    pid, number, shared = (about.get(key) for key in ("pid", "stack", "shared"))
    if type(pid) is not int or pid < 1:
        wrong = f"pid, a whole number above 0; found {pid!r:.80}"
    elif type(number) is not int or number not in signal.valid_signals():
        wrong = f"stack, the signal upon which it writes its stack; found {number!r:.80}"
    elif not isinstance(shared, list):
        wrong = f"shared, a list of files in shared memory; found {shared!r:.80}"
    else:
        return
    raise ComponentFailed(name, 0, f"its hello must tell of its process: {wrong}. Correct it.")


def find_process(probe: ProcessProbe, about: dict[str, Any], log: Path) -> None:
    """Let a probe watch the process that has told about itself, if it runs on this host.

    In a container of this host its id may be that of another process here.
    """
    known = numbering()
    if about.get("host") == socket.gethostname() and about.get("numbering", known) == known:
        probe.pid = int(about["pid"])
        paths = map(Path, map(str, about["shared"]))
        probe.shared = [str(path) for path in paths if path.parent == Path("/dev/shm")]
        probe.where = partial(stack.of_process, probe.pid, int(about["stack"]), log)


def log_of(folder: Path, name: str) -> Path:
    """Log of a component in the folder of a run."""
    return folder / "log" / f"{name}.log"
