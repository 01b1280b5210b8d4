"""Rows on several real ranks: halos, gathering, moving; the same bits on any number of ranks."""

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
    alone, *several = (result[name] for result in results)
    assert all(several_ranks.tobytes() == alone.tobytes() for several_ranks in several)


def test_rows_come_back_in_the_order_of_their_ids(results):
    alone, *several = results
    random = np.random.default_rng(5)
    points, values = random.random((400, 3)), random.normal(size=(400, 1))
    assert (alone["points"] == points).all()
    assert (alone["moved"] == points).all()
    near = ((points - points[:, None]) ** 2).sum(axis=2) < 0.15**2
    assert several[0]["near"] == pytest.approx(near @ (values[:, 0] + 2.0), abs=1e-12)


def test_sums_extremes_and_counts_are_those_of_all_rows(results):
    for result in results:
        values = result["values"]
        assert result["sum"] == pytest.approx(values.sum(axis=0), abs=1e-12)
        assert result["extremes"].tolist() == [values.max(), values.min()]
        assert result["count"] == len(values)


WAITING = """
import os, signal, sys
import numpy as np
from mpi4py import MPI
from quintet.components.shared.domain.halo import Halo

rank, rows = MPI.COMM_WORLD.rank, [np.arange(4), np.arange(4)]
rows[rank] = np.arange(0)
halo = Halo(MPI.COMM_WORLD, rows, rows, (3,))
halo.exchange(np.zeros((4, 3)))
if rank == 1:
    if sys.argv[1] == "raises":
        raise RuntimeError("no further")
    os.kill(os.getpid(), signal.SIGKILL)
print("waiting", flush=True)
halo.exchange(np.zeros((4, 3)))
"""


@pytest.mark.parametrize("end", ["raises", "is killed"])
def test_waiting_for_a_halo_ends_with_the_rank_that_sends_it(end, tmp_path, on_ranks):
    program = tmp_path / "waiting.py"
    program.write_text(WAITING)
    with pytest.raises(AssertionError, match="no further" if end == "raises" else "waiting"):
        on_ranks(program, 2, end, seconds=30)
