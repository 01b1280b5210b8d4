"""HDF5 files on a disk that may be full: room is made sure of before anything is written.

HDF5 cannot take a write back: one that fails leaves a file that cannot be opened, and a library
that ends the process when it closes the file. So the room for a piece is allocated first, on which
a full disk is found, with the file still as it was when it was whole last.
"""

import contextlib
import os
import resource
from collections.abc import Iterator
from pathlib import Path

import h5py

from quintet.coupler.files.disk import Writing, disk_error

OF_DATASET = 1 << 14  # bytes of HDF5's own, at most, that a piece adds to a data set
OF_FILE = 1 << 16  # and to the file
METADATA = 1 << 14  # bytes of a data set's own description that are kept in memory
# Measured on noisy doubles: 200 MB/s and 0.97 of the size, against 60 MB/s and 0.89 of gzip 1,
# and 1.3 GB/s unpacked. Forces of which four in five are zero shrink to 0.43.
PACKED = {"shuffle": True, "compression": "lzf"}


def create(path: Path | str, cache: int | None = None) -> h5py.File:
    """Make a file, in the default format version: newer ones refuse a file after a kill.

    `cache` is the size [bytes] of what HDF5 keeps of each data set in memory, if not its default.
    """
    try:
        return h5py.File(path, "w", locking=False, rdcc_nbytes=cache)
    except OSError as error:
        raise disk_error(Path(path), error) from error


def bound_metadata(file: h5py.File) -> None:
    """Keep no more of the lists of chunks in memory than appending to all data sets needs.

    By default HDF5 keeps at least a megabyte of them, as on the disk, which take six in memory: the
    memory of a run would grow for a hundred thousand windows.
    """
    count = 0

    def add(_: str, entry: object) -> None:
        nonlocal count
        count += isinstance(entry, h5py.Dataset)

    file.visititems(add)
    config = file.id.get_mdc_config()
    config.set_initial_size = True
    config.initial_size = config.min_size = config.max_size = METADATA * max(4, count)
    config.incr_mode = config.flash_incr_mode = config.decr_mode = 0
    file.id.set_mdc_config(config)


@contextlib.contextmanager
def room(file: h5py.File, size: int) -> Iterator[None]:
    """Write a piece of so many bytes to a file, whole and flushed, or close the file without it."""
    handle, before, size = file.id.get_vfd_handle(), file.id.get_filesize(), size + OF_FILE
    try:
        Writing.begin(Path(file.filename))
        os.posix_fallocate(handle, before, size)
        yield
        file.flush()
        os.ftruncate(handle, file.id.get_filesize())
    except (OSError, RuntimeError) as error:  # both are raised where HDF5 cannot write
        path = Path(file.filename)
        with contextlib.suppress(OSError):
            os.ftruncate(handle, before)
        abandon(file)
        raise disk_error(path, error, size) from error


def abandon(file: h5py.File) -> None:
    """Close a file as it is on the disk; what HDF5 still has to write is lost in memory."""
    sink = os.memfd_create("abandoned")
    os.dup2(sink, file.id.get_vfd_handle())
    os.close(sink)
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (hard, hard))  # it holds for memory as well
    try:
        file.close()
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
