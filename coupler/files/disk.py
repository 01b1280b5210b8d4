"""Files on a disk that may be full: told in a sentence, never cut in two.

What a run must be able to say when its disk is full finds room in a file that is laid down at the
start and given up then.
"""

import contextlib
import errno
import hashlib
import os
import re
import shutil
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from quintet.interfaces.errors import DiskError, SceneError

RESERVE = "quintet-reserve"  # in the folder of a run
PART = ".part"  # after the name of a file that is being written
RESERVED = 1 << 20  # bytes, for logs and the note of an MPI job
OF_RESULTS = 1 << 18  # bytes
DIGEST = 32  # bytes of the checksum at the end of a sealed file
MARK = b"quintet blake2b\n"  # before it
BLOCK = 1 << 20  # bytes read at once
REASONS = {
    errno.ENOSPC: "is full",
    errno.EDQUOT: "allows this user no more",
    errno.EFBIG: "allows no file so large",
    errno.EROFS: "may only be read",
}


class Writing:
    """Told of every piece that is about to be written to a file of a run."""

    begin: Callable[[Path], Any] = staticmethod(lambda path: None)  # may raise OSError


def disk_error(path: Path, error: Exception, needed: int = 0) -> DiskError:
    """Say why a file could not be written, on which disk it lies, and what it needs [bytes]."""
    number, path = number_of(error), path.with_name(path.name.removesuffix(PART))
    disk = disk_of(path)
    if number not in REASONS:
        reason = os.strerror(number) if number else str(error)
        return DiskError(f"{path}: it cannot be written ({reason}), on the disk at {disk}.")
    left = ""
    with contextlib.suppress(OSError):
        usage = shutil.disk_usage(disk)
        more = f", {needed / 1e6:.1f} MB needed" if needed else ""
        left = f" ({usage.free / 1e6:.1f} of {usage.total / 1e6:.1f} MB are free{more})"
    return DiskError(
        f"{path}: it cannot be written, as the disk at {disk} {REASONS[number]}{left}. Make room "
        "there."
    )


def number_of(error: BaseException | None) -> int | None:
    """Number of the system's error; HDF5 has it in its text alone."""
    match = re.search(r"errno = (\d+)", str(error))
    return int(match[1]) if match else getattr(error, "errno", None)


def disk_of(path: Path) -> Path:
    """Where the disk of a file is mounted."""
    place = Path(os.path.realpath(path))
    while not (os.path.ismount(place) or place == place.parent):
        place = place.parent
    return place


@contextlib.contextmanager
def reporting_disk(path: Path) -> Iterator[None]:
    """Convert an OSError during writing into a DiskError."""
    try:
        Writing.begin(path)
        yield
    except OSError as error:
        raise disk_error(path, error) from error


def write_whole(path: Path, content: str | bytes) -> None:
    """Write a file that is there whole, on the disk, or as it was before."""
    part = path.with_name(path.name + PART)
    data = content.encode() if isinstance(content, str) else content
    with reporting_disk(path), removed_on_failure(part):
        part.write_bytes(data)
        put_in_place(part, path)


@contextlib.contextmanager
def removed_on_failure(part: Path) -> Iterator[None]:
    """Remove an unfinished file if it does not come to its end."""
    try:
        yield
    except BaseException:
        with contextlib.suppress(OSError):
            part.unlink(missing_ok=True)
        raise


def put_in_place(part: Path, path: Path) -> None:
    """Bring a finished file to the disk, then to its name."""
    sync(part)
    part.replace(path)
    sync(path.parent)


def sync(path: Path) -> None:
    """Bring what was written to a file or folder from memory to the disk."""
    number = os.open(path, os.O_RDONLY)
    try:
        os.fsync(number)
    finally:
        os.close(number)


def reserve(folder: Path, results: str) -> None:
    """Lay room aside for what a run must be able to write on a full disk: its results, and more."""
    for path, size in ((folder / RESERVE, RESERVED), (folder / (results + PART), OF_RESULTS)):
        with reporting_disk(path), removed_on_failure(path), open(path, "wb") as file:
            os.posix_fallocate(file.fileno(), 0, size)


def give_up_reserve(folder: Path) -> None:
    """Make the room free that was laid aside, but for that of the results.

    A disk that may only be read by now keeps it; a run must end in order there too.
    """
    with contextlib.suppress(OSError):
        (folder / RESERVE).unlink()


def write_at_last(path: Path, content: str) -> Path:
    """Write results into the room laid aside for them, or elsewhere; return where.

    Others may fill a disk faster than it is made free: the room of the results is never given up.
    """
    give_up_reserve(path.parent)
    part = path.with_name(path.name + PART)
    try:
        with removed_on_failure(part):
            with open(part, "r+b" if part.exists() else "wb") as file:
                file.write(content.encode())
                file.truncate()
            put_in_place(part, path)
    except OSError as cause:
        error = disk_error(path, cause)
        try:
            elsewhere = Path(tempfile.mkdtemp(prefix="quintet-")) / path.name
            elsewhere.write_text(content)
        except OSError:
            raise error from cause
        print(f"quintet: {error} It is kept as {elsewhere}.", file=sys.stderr, flush=True)
        return elsewhere
    return path


def seal(path: Path) -> None:
    """Add its checksum at the end of a file."""
    digest, _ = _digest(path, path.stat().st_size)
    with open(path, "ab") as file:
        file.write(MARK + digest)


def is_sound(path: Path) -> bool:
    """Whether a sealed file is as it was written, bit for bit."""
    content = path.stat().st_size - len(MARK) - DIGEST
    if content < 0:
        return False
    digest, rest = _digest(path, content)
    return rest == MARK + digest


def _digest(path: Path, size: int) -> tuple[bytes, bytes]:
    """Checksum of the first bytes of a file, and the bytes after them."""
    digest = hashlib.blake2b(digest_size=DIGEST)
    with open(path, "rb") as file:
        while size:
            block = file.read(min(BLOCK, size))
            if not block:
                break
            digest.update(block)
            size -= len(block)
        return digest.digest(), file.read()


def check_length(path: Path, size: int) -> None:
    """Refuse to go on with a file that is shorter than it was."""
    length = path.stat().st_size if path.is_file() else 0
    if length < size:
        raise SceneError(
            f"{path}: it must have {size} bytes to go on; found {length}. Run the scene again."
        )
