"""Program that test_domain_rows.py runs on several ranks; rank 0 writes the results."""

import sys
from itertools import pairwise

import numpy as np
from mpi4py import MPI

from quintet.components.shared.domain.bisection import bisect
from quintet.components.shared.domain.borders import around, rows_near_others
from quintet.components.shared.domain.collection import Collection
from quintet.components.shared.domain.exchange import send_rows, share
from quintet.components.shared.domain.extremes import counted, greatest, least
from quintet.components.shared.domain.halo import Halo
from quintet.components.shared.domain.migration import migrate
from quintet.components.shared.domain.sums import sum_cells, sum_of_all
from quintet.components.shared.search.cells import keys_of

COUNT, REACH = 400, 0.15
WORLD = MPI.COMM_WORLD


def owners_of(points):
    cells, cell_of = np.unique(np.floor(points / REACH).astype(int), axis=0, return_inverse=True)
    cell_of = cell_of.reshape(-1)
    return bisect(cells, np.bincount(cell_of).astype(float), WORLD.size)[cell_of], cell_of


def halo_of(points, ids, width):
    """Ids of the halo of this rank's points, and the exchange into rows after its own rows."""
    keys = keys_of(points, np.arange(len(points)), REACH)
    sent_rows = rows_near_others(WORLD, keys, around(keys))
    incoming_ids = send_rows(WORLD, [ids[rows] for rows in sent_rows])
    cuts = len(ids) + np.cumsum([0, *map(len, incoming_ids)])
    received_rows = [np.arange(*pair) for pair in pairwise(cuts)]
    return np.concatenate(incoming_ids), Halo(WORLD, sent_rows, received_rows, width)


def near_sums(points, values, ids):
    """Sums of the values near each of this rank's points, added in the order of the ids."""
    halo_ids, halo = halo_of(points, ids, (3, 1))
    count = len(ids) + len(halo_ids)
    place, value = np.full((count, 3), np.nan), np.full((count, 1), np.nan)
    for step in range(3):  # with the same buffers
        place[: len(ids)], value[: len(ids)] = points, values + step
        halo.begin(place, value)
        place[len(ids) :] = np.nan
        halo.finish(place, value)
    order = np.argsort(np.concatenate([ids, halo_ids]))
    near = ((place[order] - points[:, None]) ** 2).sum(axis=2) < REACH**2
    return np.array([np.cumsum(value[order][row])[-1] for row in near])


def main(folder):
    random = np.random.default_rng(5)
    points, values = random.random((COUNT, 3)), random.normal(size=(COUNT, 1))
    owner, cell_of = owners_of(points)
    ids = np.flatnonzero(owner == WORLD.rank)
    collection = Collection(WORLD, ids)
    results = {"near": collection.gather(near_sums(points[ids], values[ids], ids))}
    results["points"] = collection.gather(points[ids])
    cells, sums = sum_cells(cell_of[ids], values[ids])
    results["sum"] = sum_of_all(WORLD, cells, sums)
    results["extremes"] = np.concatenate(
        [greatest(WORLD, values[ids].max(axis=0)), least(WORLD, values[ids].min(axis=0))]
    )
    results["count"] = counted(WORLD, np.array([len(ids)]))
    # Each rank takes the rows of the rank before it; some of the values are NaN.
    values_with_nan = np.where(ids % 7 == 0, np.nan, values[ids, 0])
    moved_ids, (place, number) = migrate(
        WORLD, (owner[ids] + 1) % WORLD.size, ids, (points[ids], values_with_nan)
    )
    assert (moved_ids == np.flatnonzero((owner + 1) % WORLD.size == WORLD.rank)).all()
    results["moved"] = Collection(WORLD, moved_ids).gather(place)
    results["odd"] = Collection(WORLD, moved_ids).gather(number).view(np.int64)
    assert [part.tolist() for part in share(WORLD, ids)] == [
        np.flatnonzero(owner == rank).tolist() for rank in range(WORLD.size)
    ]
    if WORLD.rank == 0:
        np.savez(f"{folder}/{WORLD.size}.npz", values=values, **results)


main(sys.argv[1])
