"""Program that test_given_rows.py runs on several ranks: rows that rank 0 gives, by their ids.

Argument: which ranks have no memory in common with rank 0, "none", "all" or "rank 1".
"""

import json
import sys
from pathlib import Path

import numpy as np
from mpi4py import MPI

from quintet.components.shared.domain import shared_memory
from quintet.components.shared.domain.given_rows import GivenRows, Giving
from quintet.interfaces.waited import TRAFFIC

WORLD = MPI.COMM_WORLD
COUNT, TIMES = 1000, 6  # rows, and how often they are given
KEPT = (1, 2, 3)  # times whose arrays stay in use


def rows_of(ids, time):
    """Rows of three numbers, among them NaN and -0, and whole numbers."""
    numbers = ids[:, None] / 3.0 + np.array([0.1, 0.2, 0.3]) + time
    numbers[ids % 7 == 0, 1], numbers[ids % 11 == 0, 2] = np.nan, -0.0
    return numbers, ids * 10**12 + time


def is_right(arrays, rows, time):
    expected = (part[rows] for part in rows_of(np.arange(COUNT), time))
    return all(a.tobytes() == b.tobytes() for a, b in zip(arrays, expected, strict=True))


def mapped():
    """How many pieces of memory are shared."""
    return Path("/proc/self/maps").read_text().count("memfd:quintet")


def count_messages():
    """Note the rows in each message of this rank."""
    send, sent = GivenRows._send, []

    def noted(rows_given, arrays):
        sent.append(len(arrays[0]))
        send(rows_given, arrays)

    GivenRows._send = noted
    return sent


def main(far):
    sent = count_messages()
    if far == "all" or (far == "rank 1" and WORLD.rank == 1):
        shared_memory._mapped = lambda *address: None
    giving, random = Giving(WORLD, COUNT), np.random.default_rng(3)
    right, arrays_in_use, written = [], [], []
    for time in range(TIMES):
        ids = np.flatnonzero(random.integers(0, WORLD.size, COUNT) == WORLD.rank)
        arrays = giving.give(ids, rows_of(ids, time))
        right.append(is_right(arrays, slice(None), time) if WORLD.rank == 0 else True)
        if time in KEPT:
            arrays_in_use.append(([array[3:7] for array in arrays], time))
        written.append(len(ids))
        del arrays
    if WORLD.rank == 0:
        right += [is_right(arrays, slice(3, 7), time) for arrays, time in arrays_in_use]
    used = mapped()
    del giving, arrays_in_use
    counts = [right, used, mapped(), sent, written, TRAFFIC.gathered_bytes]
    counts_of_all = WORLD.gather(counts)
    if WORLD.rank == 0:
        print(json.dumps(counts_of_all))


main(sys.argv[1])
