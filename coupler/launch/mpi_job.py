"""Running under MPI: one mpiexec for the coupler and all components, and its end.

MPI ends badly by itself: a launcher that kills every rank leaves nobody to report, one that
does not leaves ranks that wait for ever. So the launcher is told to do nothing, the coupler
steps out of its reach, watches and reports, and the process that started the launcher cleans
up after both. What the coupler prints goes through files: a launcher that ends its job forgets
the output that it has not passed on yet.
"""

import contextlib
import json
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from types import FrameType
from typing import IO

from quintet.coupler.launch.processes import environment, tail
from quintet.coupler.scene.scene import Scene
from quintet.interfaces.errors import SceneError
from quintet.interfaces.lines.process_status import running
from quintet.interfaces.serving.process import STARTER

NAME = "mpi.json"  # in the log folder: processes, and the status that the coupler ended with
SAID = ("coupler.out", "coupler.err")  # there too: what the coupler printed
LAUNCHER = "mpiexec.log"  # and what the launcher did
JOINING = 200.0  # s for all components to join; the coupler gives up on each one sooner
LEAVING = 3.0  # s for all ranks to leave after the coupler has its results


def command(arguments: list[str], scene: Scene, folder: Path) -> list[str]:
    """The MPMD command line: rank 0 couples, the others are components in the scene's order."""
    python = [sys.executable, "-m", "mpi4py"]
    apart = [sys.executable, "-m", "quintet.coupler.launch.new_session"]
    line = [*find_launcher(), "-n", "1", *apart, *python]
    line += ["-m", "quintet.coupler.cli", *arguments, "--inside-mpi"]
    for name, one in scene.components.items():
        log = str(folder / "log" / f"{name}.log")
        line += [":", "-n", "1", *python, "-m", "quintet.interfaces.serving.process", one.kind]
        line += ["--name", name, "--mpi", "--log", log]
    return line


def find_launcher() -> list[str]:
    """Begin a command line with mpiexec; that of our own environment belongs to our library."""
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", "")])
    launcher = shutil.which("mpiexec", path=path)
    if launcher is None:
        raise SceneError(
            "transport mpi needs an mpiexec; there is none on PATH. Install an MPI library, or "
            "the extra: pip install 'quintet[mpi]'."
        )
    return [launcher, *_options(launcher)]


def _options(launcher: str) -> list[str]:
    text = subprocess.run([launcher, "--version"], capture_output=True, text=True).stdout
    if "HYDRA" in text:
        return ["-disable-auto-cleanup"]
    open_mpi = "Open MPI" in text or "OpenRTE" in text  # the latter until version 4
    return ["--map-by", ":OVERSUBSCRIBE"] if open_mpi else []


def run_under_mpi(arguments: list[str], scene: Scene, folder: Path) -> int:
    """Start the ranks, wait for the coupler among them, clean up; return the exit status."""
    note = folder / "log" / NAME
    note.parent.mkdir(parents=True, exist_ok=True)
    note.unlink(missing_ok=True)
    threads = max(one.threads for one in scene.components.values())
    line = command(arguments, scene, folder)
    env = {**environment(threads, scene.import_folders), STARTER: str(os.getpid())}
    log = note.with_name(LAUNCHER)
    with open(log, "wb") as file:
        process = subprocess.Popen(
            line,
            stdin=subprocess.DEVNULL,
            stdout=file,
            stderr=file,
            start_new_session=True,
            env=env,
        )
    with contextlib.ExitStack() as stack:
        said = [stack.enter_context(open(note.with_name(name), "w+b")) for name in SAID]
        asked = stack.enter_context(_forwarding(note, process))
        reason = _await(process, note, said, asked)
        found = _read(note)
        _clean(process, found)
        _pass_on(said)
    if "status" in found:
        return int(str(found["status"]))
    if asked:
        return 130
    print(f"quintet: {reason}; there are no results", file=sys.stderr)
    print("\n".join(f"    {one}" for one in tail(log)), file=sys.stderr)
    return 3


def _await(
    process: "subprocess.Popen[bytes]", note: Path, said: Sequence[IO[bytes]], asked: list[int]
) -> str:
    """Pass on what the coupler prints until all have left; tell what went wrong, if it did."""
    reason, limit = "", time.monotonic() + JOINING
    while time.monotonic() < limit:
        _pass_on(said)
        ended, found = process.poll() is not None, _read(note)
        coupler = int(str(found.get("coupler", 0)))  # 0 until it has begun
        joined, over = found.get("pids") is not None, "status" in found
        if ended and (over or not running(coupler)):
            return reason or "the coupler ended"
        if not reason:
            if over or (coupler and not running(coupler)):
                reason = "the coupler ended"
            elif not joined and (ended or asked):
                reason = "the MPI job ended before all components had joined"
            elif joined:
                limit = float("inf")
            if reason:
                limit = time.monotonic() + LEAVING
        time.sleep(0.02)
    return reason or f"not all components joined within {JOINING:.0f} s"


def _pass_on(said: Sequence[IO[bytes]]) -> None:
    for file, stream in zip(said, (sys.stdout, sys.stderr), strict=True):
        if text := file.read():
            stream.write(text.decode(errors="replace"))
            stream.flush()


@contextlib.contextmanager
def _forwarding(note: Path, process: "subprocess.Popen[bytes]") -> Iterator[list[int]]:
    """Pass Ctrl-C and SIGTERM on to the coupler alone, which ends the others in order."""
    asked: list[int] = []

    def forward(number: int, _: FrameType | None) -> None:
        asked.append(number)
        pid = int(str(_read(note).get("coupler", 0)))
        with contextlib.suppress(ProcessLookupError):
            os.kill(pid, number) if pid else os.killpg(process.pid, signal.SIGTERM)

    old = {one: signal.signal(one, forward) for one in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield asked
    finally:
        for one, handler in old.items():
            signal.signal(one, handler)


def _read(note: Path) -> dict[str, object]:
    try:
        return dict(json.loads(note.read_text()))
    except (OSError, ValueError):
        return {}


def enter(folder: Path) -> None:
    """Begin as the coupler's rank: tell who it is, print into files."""
    for name, stream in zip(SAID, (sys.stdout, sys.stderr), strict=True):
        stream.flush()
        with open(folder / "log" / name, "ab") as file:
            os.dup2(file.fileno(), stream.fileno())
    announce(folder, None, [])


def announce(folder: Path, pids: list[int] | None, shared: list[str]) -> None:
    """Note which processes (None until all have joined) and shared files the run has."""
    _write(folder, {"coupler": os.getpid(), "pids": pids, "shared": shared})


def leave(folder: Path, status: int) -> None:
    """End the coupler's rank: in order when all is well, else the whole job at once."""
    found = _read(folder / "log" / NAME)
    _unlink(found)  # all ranks have it open by now; who started the job may be gone
    _write(folder, {**found, "status": status})
    sys.stdout.flush()
    sys.stderr.flush()
    if status not in (0, 1, 130):
        # Only a rank has MPI: who starts the launcher must not load it.
        from quintet.interfaces.lines.mpi import abort

        abort(status)


def _write(folder: Path, content: dict[str, object]) -> None:
    path = folder / "log" / NAME
    part = path.with_suffix(".part")
    part.write_text(json.dumps(content))
    part.replace(path)


def _clean(process: "subprocess.Popen[bytes]", found: dict[str, object]) -> None:
    """End what still runs and remove what killed ranks left in shared memory."""
    for pid in _mine():
        with contextlib.suppress(ProcessLookupError):
            os.kill(pid, signal.SIGKILL)
    process.wait()
    _unlink(found)


def _unlink(found: dict[str, object]) -> None:
    for path in found.get("shared", []):  # type: ignore[attr-defined]
        with contextlib.suppress(OSError):
            os.unlink(path)


def _mine() -> Iterator[int]:
    """Processes of the job on this host: they were all given the same mark."""
    mark = f"{STARTER}={os.getpid()}".encode()
    for entry in Path("/proc").glob("[0-9]*/environ"):
        with contextlib.suppress(OSError):
            if mark in entry.read_bytes().split(b"\0"):
                yield int(entry.parent.name)
