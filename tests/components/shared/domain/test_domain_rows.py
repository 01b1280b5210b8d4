"""Rows on several MPI ranks: halos, gathering, migration; the same bits on any number of ranks."""

import json
from pathlib import Path

import numpy as np
import pytest

pytestmark = pytest.mark.mpi
PROGRAM = Path(__file__).with_name("rows_on_ranks.py")


@pytest.fixture(scope="module")
def results(tmp_path_factory, on_ranks):
    folder = tmp_path_factory.mktemp("ranks")
    for ranks in (1, 3, 4):
        on_ranks(PROGRAM, ranks, folder)
    return [dict(np.load(folder / f"{ranks}.npz")) for ranks in (1, 3, 4)]


@pytest.mark.parametrize("name", ["near", "points", "sum", "extremes", "count", "moved", "odd"])
def test_the_number_of_ranks_changes_no_bit(results, name):
    on_one_rank, *on_more_ranks = (result[name] for result in results)
    assert all(values.tobytes() == on_one_rank.tobytes() for values in on_more_ranks)


def test_rows_come_back_in_the_order_of_their_ids(results):
    on_one_rank, *on_more_ranks = results
    random = np.random.default_rng(5)
    points, values = random.random((400, 3)), random.normal(size=(400, 1))
    assert (on_one_rank["points"] == points).all()
    assert (on_one_rank["moved"] == points).all()
    near = ((points - points[:, None]) ** 2).sum(axis=2) < 0.15**2
    assert on_more_ranks[0]["near"] == pytest.approx(near @ (values[:, 0] + 2.0), abs=1e-12)


def test_sums_extremes_and_counts_are_those_of_all_rows(results):
    for result in results:
        values = result["values"]
        assert result["sum"] == pytest.approx(values.sum(axis=0), abs=1e-12)
        assert result["extremes"].tolist() == [values.max(), values.min()]
        assert result["count"] == len(values)


COUNTING = """
import json, sys, time
import numpy as np
from mpi4py import MPI
from quintet.components.shared.domain.exchange import send_rows, share
from quintet.components.shared.domain.extremes import least
from quintet.components.shared.domain.halo import Halo
from quintet.interfaces.waited import TRAFFIC, WAITED

def counts():
    return [TRAFFIC.messages, TRAFFIC.message_bytes, TRAFFIC.collectives, TRAFFIC.gathered_bytes]

rank, rows = MPI.COMM_WORLD.rank, [np.arange(4), np.arange(4)]
rows[rank] = np.arange(0)
counted = [counts()]
halo = Halo(MPI.COMM_WORLD, rows, rows, (3, 1))
for _ in range(5):
    halo.exchange(np.zeros((4, 3)), np.zeros((4, 1)))
counted.append(counts())
least(MPI.COMM_WORLD, np.zeros(7))
counted.append(counts())
share(MPI.COMM_WORLD, np.zeros(10 + 5 * rank))
counted.append(counts())
send_rows(MPI.COMM_WORLD, [np.zeros((3 - rank, 2)), np.zeros((6, 2))])
counted.append(counts())
if rank:
    time.sleep(0.5)
least(MPI.COMM_WORLD, np.zeros(7))
counted = MPI.COMM_WORLD.gather((counted, WAITED.seconds, WAITED.processor))
if rank == 0:
    print(json.dumps(counted))
"""


def test_what_a_rank_sends_and_waits_for_is_counted(tmp_path, on_ranks):
    program = tmp_path / "counting.py"
    program.write_text(COUNTING)
    (counts_of_0, waited, polled), (counts_of_1, *_) = json.loads(on_ranks(program, 2))
    at_start, after_halo = [0, 0, 0, 0], [5, 5 * 4 * 4 * 8, 0, 0]
    assert counts_of_0[:3] == counts_of_1[:3] == [at_start, after_halo, [5, 640, 1, 0]]
    assert (counts_of_0[3], counts_of_1[3]) == ([5, 640, 3, 15 * 8], [5, 640, 3, 10 * 8])
    # Rank 0 sends 6 rows of two numbers, rank 1 the 2 that go to rank 0.
    assert (counts_of_0[4], counts_of_1[4]) == ([6, 640 + 96, 5, 120], [6, 640 + 32, 5, 80])
    assert 0.4 <= waited and 0.0 < polled <= waited + 0.01


WAITING = """
import os, signal, sys, time
import numpy as np
from mpi4py import MPI
from quintet.components.shared.domain.halo import Halo

rank, rows = MPI.COMM_WORLD.rank, [np.arange(4), np.arange(4)]
rows[rank] = np.arange(0)
halo = Halo(MPI.COMM_WORLD, rows, rows, (3,))
halo.exchange(np.zeros((4, 3)))
MPI.COMM_WORLD.Barrier()
if rank == 1:
    time.sleep(0.5)  # the other rank waits by then
    if sys.argv[1] == "raises":
        raise RuntimeError("no further")
    os.kill(os.getpid(), signal.SIGKILL)
halo.exchange(np.zeros((4, 3)))
"""


@pytest.mark.parametrize("end", ["raises", "is killed"])
def test_waiting_for_a_halo_ends_with_the_rank_that_sends_it(end, tmp_path, on_ranks):
    program = tmp_path / "waiting.py"
    program.write_text(WAITING)
    with pytest.raises(AssertionError, match="no further" if end == "raises" else "EXIT CODE: 9"):
        on_ranks(program, 2, end, seconds=30)
