"""Arrays of all rows in memory that the system gives page by page, where rows are written.

A rank numbers its rows as one rank would, and its arrays have room for all; but what it neither
owns nor has copies of takes addresses only, no memory.
"""

import contextlib
import mmap

import numpy as np

from quintet.interfaces.component import Array

PRIVATE = mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS
WIDE = 100  # bytes of a row; rows so wide are read at random, which is faster in pages of 2 MiB


class SparseArrays:
    """Arrays that are zero, and take no memory, where nothing is written."""

    def __init__(self) -> None:
        self._maps: list[tuple[mmap.mmap, int]] = []  # pages, and the bytes of a row

    def zeros(self, shape: tuple[int, ...], dtype: object = np.float64) -> Array:
        """Make one of a shape (n, ...)."""
        kind = np.dtype(dtype)  # type: ignore[call-overload]
        row = int(np.prod(shape[1:])) * kind.itemsize
        pages = mmap.mmap(-1, max(1, shape[0] * row), flags=PRIVATE)
        if row >= WIDE:
            with contextlib.suppress(OSError):  # a system without them
                pages.madvise(mmap.MADV_HUGEPAGE)
        self._maps.append((pages, row))
        count = int(np.prod(shape))
        numbers: Array = np.frombuffer(pages, kind, count).reshape(shape)
        return numbers

    def keep(self, first: int, last: int) -> None:
        """Give back the memory of rows that are not in [first, last]; they become zero."""
        for pages, row in self._maps:
            begin = first * row // mmap.PAGESIZE * mmap.PAGESIZE
            end = -(-(last + 1) * row // mmap.PAGESIZE) * mmap.PAGESIZE
            if begin > 0:
                pages.madvise(mmap.MADV_DONTNEED, 0, min(begin, len(pages)))
            if end < len(pages):
                pages.madvise(mmap.MADV_DONTNEED, end)
