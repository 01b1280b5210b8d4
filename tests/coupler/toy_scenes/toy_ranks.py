"""A chain of masses and springs that several ranks share."""

import time

import numpy as np

from quintet.interfaces.component import Component, Field, Port, Totals
from quintet.interfaces.params import Count, parameters

MOTION = (Field("position", (3,), "m", rate="velocity"), Field("velocity", (3,), "m/s"))
LOAD = (Field("load", (3,), "N", "impulse"),)


class Chain(Component):
    """Masses in a row, each pulled by its neighbours; a rank owns some in a row."""

    @parameters
    class Params:
        items: Count = 7
        pause: float = 0.0  # s, of every step

    ranks = True
    takes = (Port("push", LOAD),)
    gives = (Port("motion", MOTION),)

    def __init__(self, params, resources):
        self.params, self.ranks_of_it = params, resources.communicator
        self.rank = self.ranks_of_it.rank if self.ranks_of_it else 0
        size = self.ranks_of_it.size if self.ranks_of_it else 1
        self.cuts = [params.items * rank // size for rank in range(size + 1)]
        self.mine = slice(self.cuts[self.rank], self.cuts[self.rank + 1])
        places = np.zeros((params.items, 3))
        places[:, 0] = np.arange(params.items) ** 1.1
        self.position, self.velocity = places[self.mine], np.zeros_like(places[self.mine])
        self.push, self.steps = np.zeros_like(self.position), 0

    def whole(self, rows):
        """Rows of all ranks, on all ranks."""
        if self.ranks_of_it is None:
            return rows.copy()
        # Only a chain of several ranks loads mpi4py.
        from quintet.components.shared.domain.exchange import share

        return np.concatenate(share(self.ranks_of_it, rows.reshape(-1))).reshape(-1, 3)

    def rank_rows(self, port):
        return np.arange(self.params.items)[self.mine]

    def stable_dt(self):
        return 1e-3

    def take(self, fields):
        self.push = np.array(fields["push.load"])[self.mine] if "push.load" in fields else self.push

    def step(self, dt):
        self.steps += 1
        time.sleep(self.params.pause)
        places = self.whole(self.position)
        force = np.zeros_like(places)
        force[:-1] += 50.0 * (places[1:] - places[:-1])
        force[1:] -= 50.0 * (places[1:] - places[:-1])
        self.velocity = self.velocity + dt * (force[self.mine] + self.push)
        self.position = self.position + dt * self.velocity

    def give(self, wanted):
        rows = {"motion.position": self.position, "motion.velocity": self.velocity}
        return {key: self.whole(rows[key]) for key in sorted(wanted)}

    def save(self):
        return {
            "position": self.whole(self.position),
            "velocity": self.whole(self.velocity),
            "push": self.whole(self.push),
            "steps": np.array([self.steps]),
        }

    def load(self, state):
        self.position, self.velocity = state["position"][self.mine], state["velocity"][self.mine]
        self.push, self.steps = state["push"][self.mine], int(state["steps"][0])

    def totals(self):
        momentum = self.whole(self.velocity).sum(axis=0)
        return Totals(mass=float(self.params.items), momentum=momentum)

    def items(self):
        return self.params.items


class Pusher(Component):
    """Pushes the masses to where they were at the start; one rank."""

    takes = (Port("motion", MOTION),)
    gives = (Port("push", LOAD),)

    @parameters
    class Params:
        items: Count = 7

    def __init__(self, params):
        self.start, self.place = None, np.zeros((params.items, 3))

    def stable_dt(self):
        return 1e-3

    def take(self, fields):
        self.place = np.array(fields["motion.position"])
        self.start = self.place if self.start is None else self.start

    def step(self, dt):
        pass

    def give(self, wanted):
        start = self.place if self.start is None else self.start
        return {"push.load": 3.0 * (start - self.place)}

    def save(self):
        start = np.full_like(self.place, np.nan) if self.start is None else self.start
        return {"place": self.place.copy(), "start": start.copy()}

    def load(self, state):
        self.place, start = np.array(state["place"]), np.array(state["start"])
        self.start = None if np.isnan(start).any() else start
