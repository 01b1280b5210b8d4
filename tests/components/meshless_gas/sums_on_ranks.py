"""Program of test_gas_ranks.py for several ranks: sums of rows that lie on all of them."""

import numpy as np
from mpi4py import MPI

from quintet.components.meshless_gas.ranks.ordered_sums import ordered_sums

WORLD = MPI.COMM_WORLD


def main():
    random = np.random.default_rng(5)
    for count in (1, 7, 100, 128, 129, 1000, 4099, 100_003):
        columns = random.normal(size=(3, count)) * 10.0 ** random.uniform(-9, 9, (3, count))
        cuts = np.sort(random.integers(0, count + 1, WORLD.size - 1)).tolist()
        cuts = [0, *cuts, count]
        first, last = cuts[WORLD.rank : WORLD.rank + 2]
        sums = ordered_sums(WORLD, list(columns[:, first:last]), np.diff(cuts).tolist())
        assert sums.tolist() == [column.sum() for column in columns], count


if __name__ == "__main__":
    main()
