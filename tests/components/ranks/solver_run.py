"""A solver that advances step by step on one MPI rank or several, and all its outputs."""

from dataclasses import asdict

import numpy as np
from mpi4py import MPI

from quintet.interfaces.component import outputs_of

WORLD = MPI.COMM_WORLD
COMMUNICATOR = WORLD if WORLD.size > 1 else None


class SolverRun:
    """One case of a solver; a subclass builds it, and gives the inputs of its steps.

    All ranks call the same methods; the results are right on rank 0.
    """

    def __init__(self, name):
        self.name, self.steps, self.time = name, 0, 0.0
        self.solver = self.build()

    def build(self):
        """Return the solver, bound to its partners."""
        raise NotImplementedError

    def inputs(self):
        """Fields of the coming step."""
        return {}

    def step_length(self):
        """Length of the coming step [s]."""
        return self.solver.stable_dt()

    def failure(self):
        """Message of a step that must fail; the solver is of no use afterwards."""
        return ""

    def advance(self, steps):
        """Take some steps."""
        for _ in range(steps):
            self.solver.take(self.inputs())
            dt = self.step_length()
            self.solver.step(dt)
            self.steps, self.time = self.steps + 1, self.time + dt

    def save(self):
        """State of the solver, and how far it is."""
        state = {f"state {name}": array for name, array in self.solver.save().items()}
        return {**state, "steps": np.array(self.steps), "time": np.array(self.time)}

    def load(self, saved):
        """Go on from what `save` returned on any number of ranks."""
        self.steps, self.time = int(saved["steps"]), float(saved["time"])
        begin = "state "
        state = {name: array for name, array in saved.items() if name.startswith(begin)}
        self.solver.load({name.removeprefix(begin): array for name, array in state.items()})

    def results(self):
        """All that partners, files and pictures get, and its messages."""
        solver = self.solver
        view = dict(solver.view())
        ranks = view.pop("rank", np.zeros(0))  # differs, as it should
        if len(ranks) and WORLD.rank == 0:
            assert len(ranks) == len(view["points"])
            assert set(ranks) == set(range(WORLD.size))
        totals = asdict(solver.totals())
        masses = totals.pop("mass_balance")
        warnings = {**solver.warnings(), **solver.final_warnings()}
        return {
            **outputs_of(solver),
            **{f"view {name}": array for name, array in view.items()},
            **{f"walls {name}": array for name, array in solver.walls().items()},
            **{f"described {name}": array for name, array in solver.describe().items()},
            **{
                f"total {name}": np.array("unknown" if total is None else total)
                for name, total in totals.items()
            },
            **{f"mass {reason}": np.array(mass) for reason, mass in masses.items()},
            "warned": np.array(sorted(warnings.items()), dtype=str),
            "notes": np.array(solver.notes(), dtype=str),
            "stable step": np.array(solver.stable_dt()),
        }
