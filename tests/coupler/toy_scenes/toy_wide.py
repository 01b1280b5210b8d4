"""A wide interface: loads on many items, of which each rank needs those that it owns."""

import numpy as np

from quintet.interfaces.component import Component, Field, Port
from quintet.interfaces.params import Count, parameters

LOAD = Port("load", (Field("force", (3,), "N"), Field("velocity", (3,), "m/s")))
SUM = Port("sum", (Field("force", (3,), "N"),))


@parameters
class Width:
    items: Count = 1000
    all_rows: bool = False  # whether each rank gets the rows of all


class Loads(Component):
    """Gives a load on each item."""

    Params = Width
    takes, gives = (SUM,), (LOAD,)

    def __init__(self, params):
        self.rows, self.steps = np.arange(3.0 * params.items).reshape(-1, 3), 0

    def stable_dt(self):
        return 1e-3

    def take(self, fields):
        self.sum = np.array(fields["sum.force"])

    def step(self, dt):
        self.steps += 1

    def give(self, wanted):
        return {key: self.rows + self.steps for key in wanted}

    def save(self):
        return {"steps": np.array([self.steps])}

    def load(self, state):
        self.steps = int(state["steps"][0])


class Shared(Component):
    """Takes the loads on its items, and gives their sum on each of eight parts."""

    Params = Width
    ranks = True
    takes, gives = (LOAD,), (SUM,)
    parts = 8

    def __init__(self, params, resources):
        self.params, self.communicator = params, resources.communicator
        size = self.communicator.size if self.communicator else 1
        rank = self.communicator.rank if self.communicator else 0
        ends = np.linspace(0, params.items, self.parts + 1).astype(int)
        self.mine = range(rank * self.parts // size, (rank + 1) * self.parts // size)
        self.slices = [slice(ends[part], ends[part + 1]) for part in self.mine]
        self.sums = np.zeros((len(self.mine), 3))
        self.leads = rank == 0

    def rank_rows(self, port):
        if self.params.all_rows or port != "load":
            return None
        return np.arange(self.slices[0].start, self.slices[-1].stop)

    def prime(self, fields):
        if not self.leads and not self.params.all_rows:
            rows = self.rank_rows("load")
            assert fields["load.force"][rows].any()
            assert not np.delete(fields["load.force"], rows, axis=0).any()

    def stable_dt(self):
        return 1e-3

    def take(self, fields):
        arrays = fields["load.force"], fields["load.velocity"]
        self.sums = np.array(
            [sum(rows[part].sum(axis=0) for rows in arrays) for part in self.slices]
        )

    def step(self, dt):
        """Do nothing: the transfer of the loads is measured."""

    def whole(self):
        """Sums of all parts, on all ranks."""
        if self.communicator is None:
            return self.sums.copy()
        # Only several ranks load mpi4py.
        from quintet.components.shared.domain.exchange import share

        return np.concatenate(share(self.communicator, self.sums.reshape(-1))).reshape(-1, 3)

    def give(self, wanted):
        return {key: self.whole() for key in wanted}

    def save(self):
        return {"sums": self.whole()}

    def load(self, state):
        self.sums = np.array(state["sums"])[list(self.mine)]
