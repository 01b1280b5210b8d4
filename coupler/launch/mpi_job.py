"""MPI jobs: one mpiexec for the coupler and all components, watched and cleaned up.

A launcher that kills every rank when one fails leaves none to report it; one that does not
leaves ranks that wait for ever. So the launcher's own cleanup is switched off, the coupler runs in
a session of its own, watches and reports, and the process that started the launcher cleans up
after both. The coupler prints into files: a launcher that ends its job loses output that it has
not forwarded yet.
"""

import contextlib
import json
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterable, Iterator, Sequence
from functools import partial
from pathlib import Path
from types import FrameType
from typing import IO, NamedTuple

import psutil

from quintet.coupler.launch.companion import Companion, once_gone
from quintet.coupler.launch.process_probe import signal_text
from quintet.coupler.launch.processes import PYTHON, end_marked, environment, marked, tail
from quintet.coupler.launch.signal_handler import handled_by
from quintet.coupler.scene.scene import Scene
from quintet.interfaces.errors import SceneError
from quintet.interfaces.lines.process_status import running
from quintet.interfaces.serving.log_stream import print_into_logs
from quintet.interfaces.serving.process import LAUNCHER, STARTER, shared_files

JOB_FILE = "mpi.json"  # in the log folder: processes, and the exit status of the coupler
COUPLER_OUTPUT = ("coupler.out", "coupler.err")  # there too
LAUNCHER_LOG = "mpiexec.log"  # there too
LAUNCHER_FILE = (
    "hydra_hwloc_xmlfile_"  # how names of temporary files begin that a killed one leaves
)
# Starts a rank and writes how it ended: only its parent learns that, and mpiexec reports late.
RANK = f'{LAUNCHER}=$PPID; export {LAUNCHER}; "$@"; echo $? > "$0"'
# The same of several: the number of the rank in its job ends the name of the file.
RANKS = RANK.replace("$0", "$0.${PMI_RANK:-${PMIX_RANK:-${OMPI_COMM_WORLD_RANK:-$SLURM_PROCID}}}")
ENDING, AT_ONCE = 3.0, 0.5  # s for all ranks to end after the coupler has, if all is well or not
LOOKING = 0.2  # s between two looks at the ranks while they start
ORPHANED = 10.0  # s for the coupler to end in order after the process that started the job died


def command(arguments: list[str], scene: Scene, folder: Path) -> list[str]:
    """The MPMD command line: rank 0 couples, the others are components in the scene's order."""
    python = [*PYTHON, "-m", "mpi4py"]
    new_session = [*PYTHON, "-m", "quintet.coupler.launch.new_session"]
    new_session.append(str(folder / "log" / JOB_FILE))
    line = [*find_launcher(), "-n", "1", *new_session, *python]
    line += ["-m", "quintet.coupler.cli", *arguments, "--inside-mpi"]
    for name, plan in scene.components.items():
        line += [":", "-n", str(plan.ranks), *under_shell(folder, name, plan.ranks)]
        line += [*python, "-m", "quintet.interfaces.serving.process", plan.kind]
        line += ["--name", name, "--mpi", "--log", str(folder / "log" / f"{name}.log")]
        if plan.ranks > 1:
            line += ["--ranks", str(plan.ranks), "--first", str(scene.first_rank(name))]
        line += [word for place in scene.import_folders for word in ("--look-in", place)]
    return line


def under_shell(folder: Path, name: str, ranks: int) -> list[str]:
    """Words before the command of a component's ranks: their exit statuses are written."""
    return ["sh", "-c", RANK if ranks == 1 else RANKS, str(exit_file(folder, name))]


def exit_file(folder: Path, name: str) -> Path:
    """File in which the exit status of a component's rank is written when it has ended."""
    return folder / "log" / f"{name}.exit"


def exit_files(folder: Path, name: str, ranks: int, first: int) -> list[Path]:
    """Files of all ranks of a component, the first of which has this number in the MPI job."""
    path = exit_file(folder, name)
    if ranks == 1:
        return [path]
    return [path.with_name(f"{path.name}.{first + rank}") for rank in range(ranks)]


def find_launcher() -> list[str]:
    """Find mpiexec, first beside the Python interpreter, and its options."""
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


class Starter(NamedTuple):
    """The process that starts a job."""

    pid: int
    began: float  # s since the epoch

    def precedes(self, path: str) -> bool:
        """Whether a file was made after the job began."""
        try:
            return os.stat(path).st_ctime >= self.began
        except OSError:
            return False


class JobEnd(NamedTuple):
    """How an MPI job ended: as its coupler says, or why the coupler could not say it."""

    status: int  # exit status of the coupler, or what it would have been
    cause: str = ""  # why there are no results; "" where the coupler wrote them


def run_under_mpi(arguments: list[str], scene: Scene, folder: Path) -> JobEnd:
    """Start the ranks, wait for the coupler among them, clean up; return how the job ended."""
    job_file = folder / "log" / JOB_FILE
    job_file.parent.mkdir(parents=True, exist_ok=True)
    job_file.unlink(missing_ok=True)
    starter = Starter(os.getpid(), time.time())
    exits = [
        path
        for name, plan in scene.components.items()
        for path in exit_files(folder, name, plan.ranks, scene.first_rank(name))
    ]
    for path in exits:
        path.unlink(missing_ok=True)
    threads = max(plan.threads for plan in scene.components.values())
    line = command(arguments, scene, folder)
    env = {**environment(threads), STARTER: str(os.getpid())}
    log = job_file.with_name(LAUNCHER_LOG)
    with contextlib.ExitStack() as stack:
        output = [
            stack.enter_context(open(job_file.with_name(name), "w+b")) for name in COUPLER_OUTPUT
        ]
        signals = stack.enter_context(_forward_signals(job_file))
        with open(log, "wb") as file:
            process = subprocess.Popen(
                line,
                stdin=subprocess.DEVNULL,
                stdout=file,
                stderr=file,
                start_new_session=True,
                env=env,
            )
        try:
            companion = Companion(once_gone(partial(_see_to_end, job_file, output, starter)))
            stack.callback(companion.close)
            reason = _await(process, job_file, output, signals)
        finally:  # nobody else ends what was started, whatever goes wrong here
            job = _read(job_file)
            end_ranks(job, starter)
            process.wait()
        _forward_output(output)
        for path in exits:
            path.unlink(missing_ok=True)
    if "status" in job:
        return JobEnd(int(str(job["status"])))
    if signals:
        return JobEnd(130, "interrupted before all components had joined")
    if number := int(str(_read(job_file).get("killed", 0))):
        reason = f"the coupler was killed by {signal_text(number)}"
    print(f"quintet: {reason}", file=sys.stderr)
    print("\n".join(f"    {line}" for line in tail(log)), file=sys.stderr)
    return JobEnd(3, reason)


def _await(
    process: "subprocess.Popen[bytes]",
    job_file: Path,
    output: Sequence[IO[bytes]],
    signals: list[int],
) -> str:
    """Forward the coupler's output until the job has ended; return what went wrong, or ""."""
    reason, limit, seen, looked_at = "", float("inf"), set[str](), 0.0
    while time.monotonic() < limit:
        _forward_output(output)
        ended, job = process.poll() is not None, _read(job_file)
        coupler = int(str(job.get("coupler", 0)))  # 0 until it has begun
        joined, over = job.get("pids") is not None, "status" in job
        if ended and (over or not running(coupler)):
            return reason or "the coupler ended"
        if not reason:
            if over or (coupler and not running(coupler)):
                reason = "the coupler ended"
            elif not joined and (ended or (signals and not coupler)):
                reason = "the MPI job ended before all components had joined"
            elif not coupler and time.monotonic() > looked_at + LOOKING:
                # MPI begins when all ranks are there: if one has died, the others wait for ever.
                ranks, looked_at = set(_ranks()), time.monotonic()
                reason = ", ".join(f"{name} ended before MPI began" for name in seen - ranks)
                seen |= ranks
            if reason:
                limit = time.monotonic() + (ENDING if job.get("status") in (0, 1) else AT_ONCE)
        time.sleep(0.02)
    return reason


def _forward_output(output: Sequence[IO[bytes]]) -> None:
    for file, stream in zip(output, (sys.stdout, sys.stderr), strict=True):
        if text := file.read():
            stream.write(text.decode(errors="replace"))
            stream.flush()


@contextlib.contextmanager
def _forward_signals(job_file: Path) -> Iterator[list[int]]:
    """Forward SIGINT, SIGTERM and SIGHUP to the coupler alone, which ends the others in order."""
    signals: list[int] = []

    def forward(number: int, _: FrameType | None) -> None:
        signals.append(number)
        pid = int(str(_read(job_file).get("coupler", 0)))
        if number == signal.SIGHUP:  # libraries of MPI use it for themselves
            number = signal.SIGTERM
        # Ranks in which MPI begins are ended by who waits for them, who sees first what they map.
        with contextlib.suppress(ProcessLookupError):
            if pid:
                os.kill(pid, number)

    with handled_by(forward):
        yield signals


def _read(job_file: Path) -> dict[str, object]:
    try:
        return dict(json.loads(job_file.read_text()))
    except (OSError, ValueError):
        return {}


def begin_rank(folder: Path) -> None:
    """Begin the coupler's rank: write its process id, redirect its output to files."""
    for name, stream in zip(COUPLER_OUTPUT, (sys.stdout, sys.stderr), strict=True):
        stream.flush()
        with open(folder / "log" / name, "ab") as file:
            os.dup2(file.fileno(), stream.fileno())
    print_into_logs()
    write_processes(folder, None, [])


def write_processes(folder: Path, pids: list[int] | None, shared: list[str]) -> None:
    """Write the process ids (None until all have joined) and shared files of the run."""
    # The launcher is two processes up, and may be killed before anybody else looks.
    above = psutil.Process().parents()[:2]
    launcher = [path for process in above for path in _launcher_files(process.pid)]
    _write(folder, {"coupler": os.getpid(), "pids": pids, "shared": shared, "launcher": launcher})


def end_rank(folder: Path, status: int) -> None:
    """End the coupler's rank: in order when all is well, else with an abort of the job."""
    job = _read(folder / "log" / JOB_FILE)
    # All ranks have these open by now, and the process that started the job may have ended.
    _unlink(job.get("shared", []))  # type: ignore[arg-type]
    _write(folder, {**job, "status": status})
    sys.stdout.flush()
    sys.stderr.flush()
    pids: list[int] = job.get("pids") or []  # type: ignore[assignment]
    # Where a rank is dead, the others would wait for it as they leave.
    if status not in (0, 1, 130) or not all(running(pid) for pid in pids):
        # Only a rank has MPI: who starts the launcher must not load it.
        from quintet.interfaces.lines.mpi import abort

        abort(status)


def _write(folder: Path, content: dict[str, object]) -> None:
    path, text = folder / "log" / JOB_FILE, json.dumps(content)
    part = path.with_suffix(".part")
    try:
        part.write_text(text)
        part.replace(path)
    except OSError:
        part.unlink(missing_ok=True)
        if not path.exists():
            raise
        # On a full disk the file that is there still has room in its last block. Who reads it
        # half written reads it again.
        with open(path, "r+") as file:
            file.write(text)
            file.truncate()


def _see_to_end(job_file: Path, output: Sequence[IO[bytes]], starter: Starter) -> None:
    """Show the end of a job whose starter is gone: its coupler ends in order; then clean up."""
    limit = time.monotonic() + ORPHANED
    while "status" not in (job := _read(job_file)) and time.monotonic() < limit:
        _forward_output(output)
        if not running(int(str(job.get("coupler", 0)))):
            break
        time.sleep(0.02)
    _forward_output(output)
    end_ranks(job, starter)


def end_ranks(job: dict[str, object], starter: Starter) -> None:
    """End processes of a job that still run, and remove what they leave in shared memory.

    A rank that is killed as MPI begins has told nobody of the files that it maps.
    """
    pids = list(marked(STARTER, str(starter.pid)))
    used = {path for pid in pids for path in files_of(pid)}
    files = {path for path in used if starter.precedes(path)}
    end_marked(STARTER, str(starter.pid))
    _unlink({*job.get("shared", []), *job.get("launcher", []), *files})  # type: ignore[misc]


def files_of(pid: int) -> list[str]:
    """Files of an MPI job that a process of it, or of its launcher, leaves if it is killed."""
    return [*shared_files(pid), *_launcher_files(pid)]


def _launcher_files(pid: int) -> Iterator[str]:
    """Files in which a process of the launcher keeps the layout of the machine."""
    with contextlib.suppress(OSError):  # it may end meanwhile
        for link in os.scandir(f"/proc/{pid}/fd"):
            path = os.readlink(link.path)
            if os.path.basename(path).startswith(LAUNCHER_FILE):
                yield path


def _unlink(paths: Iterable[str]) -> None:
    for path in paths:
        with contextlib.suppress(OSError):
            os.unlink(path)


def _ranks() -> Iterator[str]:
    """Names of the components whose ranks run on this host."""
    for pid in marked(STARTER, str(os.getpid())):
        with contextlib.suppress(psutil.Error, ValueError, IndexError):
            words = psutil.Process(pid).cmdline()
            if words[0] == sys.executable and "--mpi" in words:
                yield words[words.index("--name") + 1]
