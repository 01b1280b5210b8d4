"""The folder of a run: new, or one that this program wrote; locked while it is in use.

Only files that the marker of a former run names are ever replaced, and only once the run that
replaces them has passed all checks: until then they lie in a folder beside the new ones.
"""

import contextlib
import itertools
import time
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from filelock import FileLock, Timeout

from quintet.coupler.coupling.iteration.convergence_log import log_file
from quintet.coupler.files import reached
from quintet.coupler.files.disk import PART
from quintet.coupler.files.plain_files import require_no_links, require_plain
from quintet.coupler.files.run_files import (
    LOCK,
    MARKER,
    RUN_FILES,
    RUN_LOG,
    Marker,
    failure_file,
    leftovers,
    may_write,
    new_marker,
    read_marker,
    view_file,
    walls_file,
    write_marker,
)
from quintet.coupler.launch.mpi_job import COUPLER_OUTPUT, JOB_FILE, LAUNCHER_LOG
from quintet.coupler.scene.scene import Scene
from quintet.interfaces.errors import DiskError, SceneError

BEGUN = (LOCK, MARKER + PART)  # all that is there of a run that begins just now
FORMER = "quintet-former"  # within the folder: the run that is being replaced
SHOWN = 3  # foreign files named in a message
SHARED = 10.0  # s for another process to begin a folder that both use


class InUse(SceneError):
    """The folder is locked by another run."""


def files_of(scene: Scene) -> list[str]:
    """Names of all files that a run of a scene may write, but for its snapshots."""
    logs = [f"{name}.{end}" for name in scene.components for end in ("log", "exit")]
    logs += [*COUPLER_OUTPUT, JOB_FILE, LAUNCHER_LOG, reached.NAME]
    kinds = (view_file, walls_file, failure_file)
    views = [file_of(name) for name in scene.components for file_of in kinds]
    convergence = [log_file(group) for group in scene.coupling.iterated()]
    return [*RUN_FILES, *views, *convergence, *(f"log/{name}" for name in logs)]


@dataclass(slots=True)
class RunFolder:
    """A folder in use."""

    path: Path
    marker: Marker
    replaces: bool = False  # a former run

    def check_runs(self, names: Iterable[str], kind: str = "run") -> None:
        """Refuse to begin where a run of a series would go into a folder that is not a run's."""
        for name in names:
            _former(self.path / name, kind, True)

    def undo(self) -> None:
        """Leave the folder as it was found: nothing was started."""
        for path in leftovers(self.path, self.marker):
            path.unlink()
        if self.replaces:
            _restore(self.path)
        else:
            _remove_empty(self.path / "log", self.path)


@contextlib.contextmanager
def begin(
    kind: str, name: str, files: Iterable[str], out: Path | None, force: bool = False
) -> Iterator[RunFolder]:
    """Use a folder for a new run, as given or of the next free number; lock it meanwhile.

    Parameters
    ----------
    kind : {"run", "study", "stability", "peer"}
    name : str
        Of the folder in ``runs`` where none is given.
    files : iterable of str
        That the run may write.
    out : path or None
        As given.
    force : bool
        Replace a former run of this kind in the folder.

    Raises
    ------
    SceneError
        The folder is no folder, cannot be written, is in use, or holds what must stay.
    """
    with contextlib.ExitStack() as stack:
        try:
            run_folder = _take(stack, kind, name, files, out, force)
        except OSError as error:
            where = error.filename or out or "runs"
            raise SceneError(
                f"--out {where}: it cannot be written ({error.strerror}). Name another folder."
            ) from error
        yield run_folder


def _take(
    stack: contextlib.ExitStack,
    kind: str,
    name: str,
    files: Iterable[str],
    out: Path | None,
    force: bool,
) -> RunFolder:
    base = out or Path("runs") / name
    folder = (_next_free(base) if out is None and not force else base).resolve()
    files = list(files)
    _require_own(folder, files, _former(folder, kind, force))
    folder.mkdir(parents=True, exist_ok=True)
    stack.enter_context(_locked(folder))
    former = _former(folder, kind, force)  # since then another may have begun
    _require_own(folder, files, former)
    still_there = [RUN_LOG] if former and RUN_LOG in former.files else []
    if former:
        _set_aside(folder, former)
    marker = new_marker(kind, name.removesuffix(f"-{kind}"), [*files, *still_there])
    run_folder = RunFolder(folder, marker, bool(former))
    try:
        write_marker(folder, run_folder.marker)
    except DiskError:
        run_folder.undo()
        raise
    return run_folder


def begin_series(
    kind: str, scene: str, files: Iterable[str], out: Path | None, force: bool, keep: bool = False
) -> contextlib.AbstractContextManager[RunFolder]:
    """Use a folder for a series of runs, or go on with a former series in it."""
    name = f"{scene}-{kind}"
    folder = (out or Path("runs") / name).resolve()
    if read_marker(folder):
        require_no_links(folder)  # neither in the place of its own files nor of its runs
        if keep and not force:
            return go_on(folder, kind)
    return begin(kind, name, files, folder if keep else out, force)


def share(kind: str, scene: str, files: Iterable[str], out: Path | None) -> Path:
    """Use a folder for a series of runs, as may others at the same time: each run has its lock."""
    name, limit = f"{scene}-{kind}", time.monotonic() + SHARED
    folder = (out or Path("runs") / name).resolve()
    while not read_marker(folder):
        try:
            with begin(kind, name, files, folder):
                pass
        except SceneError as error:  # another may have begun it meanwhile, or begins it just now
            begins = isinstance(error, InUse) and time.monotonic() < limit
            if not (begins or read_marker(folder)):
                raise
            time.sleep(0.05)
    check_ours(folder, kind)
    require_no_links(folder)
    return folder


def wait_until_free(folder: Path, seconds: float) -> None:
    """Wait for the end of a run in a folder, as of one whose starter was killed."""
    if folder.is_dir():
        with _locked(folder, seconds):
            pass


@contextlib.contextmanager
def go_on(folder: Path, kind: str) -> Iterator[RunFolder]:
    """Use the folder of a former run again, as it is; lock it meanwhile."""
    marker = check_ours(folder, kind)
    with _locked(folder):
        yield RunFolder(folder, marker)


def _require_own(folder: Path, files: Iterable[str], former: Marker | None) -> None:
    """Refuse links in the place of what will be written, removed or moved aside."""
    names = [*files, *(former.files if former else ())]
    aside = folder / FORMER
    require_plain(folder, [*may_write(folder, names), *may_write(aside, names)])


def check_ours(folder: Path, kind: str) -> Marker:
    """Read the marker of a folder that must be a run's, its files plain ones."""
    marker = read_marker(folder)
    if marker is None or marker.kind != kind:
        description = f"that of a {marker.kind}" if marker else "not that of a run"
        raise SceneError(f"{folder}: it must be the folder of a {kind}; it is {description}.")
    _require_own(folder, (), marker)
    return marker


def discard_former(folder: Path) -> None:
    """Remove the run that another has replaced."""
    former = folder / FORMER
    if marker := read_marker(former):
        for path in leftovers(former, marker):
            path.unlink()
        _remove_empty(former / "log", former)


def _next_free(base: Path) -> Path:
    """Make a new folder: of this name, or of the first number that nobody has."""
    for number in itertools.count(1):
        folder = base if number == 1 else base.with_name(f"{base.name}-{number}")
        with contextlib.suppress(FileExistsError):
            folder.parent.mkdir(parents=True, exist_ok=True)
            folder.mkdir()
            if number > 1:
                print(f"{base} is there already: what is new goes to {folder}", flush=True)
            return folder
        if not folder.parent.is_dir():
            raise NotADirectoryError(20, "it must be a folder", str(folder.parent))
    raise AssertionError


def _former(folder: Path, kind: str, force: bool) -> Marker | None:
    """Find the run that may be replaced in a folder; refuse to touch anything else."""
    if not folder.exists():
        return None
    if not folder.is_dir():
        raise SceneError(f"--out {folder}: it must be a folder; it is a file. Name another.")
    marker = read_marker(folder)
    if marker is None:
        names = sorted(path.name for path in folder.iterdir() if path.name not in BEGUN)
        if names:
            shown = ", ".join(names[:SHOWN]) + (", ..." if len(names) > SHOWN else "")
            raise SceneError(
                f"--out {folder}: it holds files that no run left ({shown}). Name a new or an "
                "empty folder."
            )
        return None
    if not force or marker.kind != kind:
        ways = "Name another folder"
        if marker.kind == kind:
            ways += ", or replace it with --force"
        raise SceneError(f"--out {folder}: it holds a {marker.kind} of {marker.scene}. {ways}.")
    return marker


@contextlib.contextmanager
def _locked(folder: Path, seconds: float = 0.0) -> Iterator[None]:
    """Lock a folder; the lock of a process that died is free."""
    lock = FileLock(folder / LOCK, timeout=seconds)
    try:
        lock.acquire()
    except Timeout as error:
        raise InUse(
            f"{folder}: another run is using it. Wait for its end, or name another folder."
        ) from error
    try:
        yield
    finally:
        lock.release()


def _set_aside(folder: Path, marker: Marker) -> None:
    """Move a former run aside; one that lies there was to be replaced by one that never began."""
    if read_marker(folder / FORMER):
        for path in leftovers(folder, marker):
            path.unlink()
        _restore(folder)
        marker = read_marker(folder) or marker
    _move(folder, folder / FORMER, marker)


def _restore(folder: Path) -> None:
    """Put a former run back."""
    if marker := read_marker(folder / FORMER):
        _move(folder / FORMER, folder, marker)
        _remove_empty(folder / FORMER / "log", folder / FORMER)


def _move(source: Path, target: Path, marker: Marker) -> None:
    target.mkdir(exist_ok=True)
    for path in leftovers(source, marker):
        place = target / path.relative_to(source)
        place.parent.mkdir(exist_ok=True)
        path.replace(place)


def _remove_empty(*folders: Path) -> None:
    for folder in folders:
        with contextlib.suppress(OSError):
            if folder.is_dir() and [path.name for path in folder.iterdir()] == [LOCK]:
                (folder / LOCK).unlink()
            folder.rmdir()
