"""Threads that share the rows of a kernel out among them.

Each row is computed wholly by one thread and results are combined by the caller, so the
number of threads changes no bit. Kernels release Python's lock; unlike numba's own pool, several
components of one process may run at once, and kernels compile in a fraction of the time.
"""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

FEWEST = 1000  # rows that are worth handing to another thread
SHARES = 16  # of each thread, for rows differ in cost: walls and spray take less than half


class Team:
    """A fixed number of threads, and what they are given: at least `fewest` rows, in `shares`."""

    def __init__(self, size: int, fewest: int = FEWEST, shares: int = SHARES) -> None:
        self.size, self.fewest, self.shares = size, fewest, shares
        self._pool = ThreadPoolExecutor(size - 1) if size > 1 else None  # and who calls `run`

    def ends(self, rows: int) -> list[int]:
        """Where the shares of some rows begin and end, from 0 on."""
        shares = min(self.shares * self.size, rows // self.fewest)
        if self._pool is None or shares < 2:
            return [0, rows]
        return [rows * share // shares for share in range(shares + 1)]

    def run(self, kernel: Callable[..., Any], rows: int, *arguments: Any) -> list[Any]:
        """Call ``kernel(first, last, *arguments)`` on shares of the rows; return every result."""
        ends = self.ends(rows)
        shares = len(ends) - 1
        if self._pool is None or shares < 2:
            return [kernel(0, rows, *arguments)]
        found: list[Any] = [None] * shares
        left = iter(range(shares))

        def work() -> None:
            # Each thread takes the next share when it is done with one.
            for share in left:
                found[share] = kernel(ends[share], ends[share + 1], *arguments)

        others = [self._pool.submit(work) for _ in range(self.size - 1)]
        work()
        for other in others:
            other.result()
        return found
