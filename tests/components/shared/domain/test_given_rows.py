"""Rows that rank 0 gives for all ranks, through shared memory or by messages."""

import json
from pathlib import Path

import pytest

pytestmark = pytest.mark.mpi
PROGRAM = Path(__file__).with_name("giving_on_ranks.py")
RANKS = 3


@pytest.fixture(scope="module", params=["none", "all", "rank 1"])
def run(request, on_ranks):
    """Which ranks share no memory with rank 0, and what each rank counted."""
    return request.param, json.loads(on_ranks(PROGRAM, RANKS, request.param))


def test_rank_0_gets_all_rows_by_their_ids_to_the_bit_and_may_keep_them(run):
    _, counts = run
    assert all(all(right) for right, *_ in counts)
    assert len(counts[0][0]) == 6 + 3  # times, and those kept


def test_only_ranks_of_other_hosts_send_rows(run):
    far, counts = run
    senders = {"none": [], "all": [1, 2], "rank 1": [1]}[far]
    for rank, (*_, sent, written, _) in enumerate(counts):
        assert sent == (written if rank in senders else [])


def test_rows_of_other_ranks_are_counted_as_the_cost_model_needs_them(run):
    """Also those in shared memory: they are sent where ranks are on several hosts."""
    _, counts = run
    of_others = sum(sum(written) for *_, written, _ in counts[1:])
    assert [count[-1] for count in counts] == [of_others * 4 * 8, 0, 0]  # of two arrays


def test_memory_is_shared_while_rows_are_given_and_no_longer(run):
    far, counts = run
    # A second piece for the times at which arrays of the first were still in use.
    used = {"none": [2, 2, 2], "all": [0, 0, 0], "rank 1": [2, 0, 2]}[far]
    assert [count[1] for count in counts] == used
    assert [count[2] for count in counts] == [0, 0, 0]


DYING = """
import os, signal, sys, time
import numpy as np
from mpi4py import MPI
from quintet.components.shared.domain.given_rows import Giving

rank = MPI.COMM_WORLD.rank
giving = Giving(MPI.COMM_WORLD, 8)
ids = np.arange(4 * rank, 4 * rank + 4)
giving.give(ids, [np.ones((4, 3))])
MPI.COMM_WORLD.Barrier()
if rank == 1:
    time.sleep(0.5)  # the other rank waits by then
    if sys.argv[1] == "raises":
        raise RuntimeError("no further")
    os.kill(os.getpid(), signal.SIGKILL)
giving.give(ids, [np.ones((4, 3))])
"""


@pytest.mark.parametrize("end", ["raises", "is killed"])
def test_waiting_for_the_rows_of_a_rank_ends_with_it(end, tmp_path, on_ranks):
    program = tmp_path / "dying.py"
    program.write_text(DYING)
    with pytest.raises(AssertionError, match="no further" if end == "raises" else "EXIT CODE: 9"):
        on_ranks(program, 2, end, seconds=30)
