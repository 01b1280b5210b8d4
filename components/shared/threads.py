"""Threads that share the rows of a kernel out among them.

Each row is computed wholly by one thread and results are combined by the caller, so the
number of threads changes no bit. Kernels release Python's lock; unlike numba's own pool, several
components of one process may run at once, and kernels compile in a fraction of the time.
"""

from collections import deque
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise
from typing import Any

FEWEST = 1000  # rows that are worth handing to another thread
SHARES = 16  # of each thread, for rows differ in cost: walls and spray take less than half


class Team:
    """A fixed number of threads, and what they are given: at least `fewest` rows, in `shares`."""

    def __init__(self, size: int, fewest: int = FEWEST, shares: int = SHARES) -> None:
        self.size, self.fewest, self.shares = size, fewest, shares
        self._pool = ThreadPoolExecutor(size - 1) if size > 1 else None  # and who calls `run`

    def ends(self, rows: int, fewest: int | None = None) -> list[int]:
        """Where the shares of some rows begin and end, from 0 on."""
        shares = min(self.shares * self.size, rows // (fewest or self.fewest))
        shares -= shares % self.size if shares > self.size else 0  # as many for each
        if self._pool is None or shares < 2:
            return [0, rows]
        return [rows * share // shares for share in range(shares + 1)]

    def run(
        self, kernel: Callable[..., Any], rows: int, *arguments: Any, fewest: int | None = None
    ) -> list[Any]:
        """Call ``kernel(first, last, *arguments)`` on shares of the rows; return every result.

        Kernels that do less or more for a row than others say how many are the fewest themselves.
        """
        ends = self.ends(rows, fewest)
        shares = len(ends) - 1
        if self._pool is None or shares < 2:
            return [kernel(0, rows, *arguments)]
        results: list[Any] = [None] * shares
        cuts = [shares * thread // self.size for thread in range(self.size + 1)]
        left = [deque(range(*pair)) for pair in pairwise(cuts)]

        def work(thread: int) -> None:
            # Each begins with shares beside each other, which stay in its caches from one kernel
            # to the next; then it helps others, from the ends that they come to last.
            for owner in (thread, *range(thread), *range(thread + 1, self.size)):
                take = left[owner].popleft if owner == thread else left[owner].pop
                while left[owner]:
                    try:
                        share = take()
                    except IndexError:  # another was faster
                        break
                    results[share] = kernel(ends[share], ends[share + 1], *arguments)

        others = [self._pool.submit(work, thread) for thread in range(1, self.size)]
        work(0)
        for other in others:
            other.result()
        return results
