"""Freed memory is used again rather than given back to the system."""

import ctypes
import functools

TRIM, MAP = -1, -3  # M_TRIM_THRESHOLD and M_MMAP_THRESHOLD of the GNU C library
KEPT = 1 << 28  # bytes that may lie free before any are given back
LARGE = 1 << 25  # bytes; larger blocks are mapped by themselves, as large as the library allows


@functools.cache
def keep_freed_memory() -> None:
    """Ask the C library to keep what is freed, where it knows how.

    The arrays of a window come and go with it. Given back and asked for again, each of their
    pages is cleared by the system, which takes several times as long as sending them.
    """
    adjust = getattr(ctypes.CDLL(None), "mallopt", None)
    if adjust is not None:
        adjust(TRIM, KEPT)
        adjust(MAP, LARGE)
