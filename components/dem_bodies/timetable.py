"""Planes that vanish and bodies that are released at a time of the run, as gates and supports do.

A plane or lock is as it was until the first step that begins at its time or later. Steps end at
these times, to a thousandth of their length. The elastic energy of contacts with a plane that
vanishes is lost; it counts as dissipated.
"""

import numpy as np

from quintet.components.dem_bodies.build import free_motion
from quintet.components.dem_bodies.kernels.locked_motion import write_free_rotation
from quintet.components.dem_bodies.params import DemBodiesParams
from quintet.components.dem_bodies.shapes.copies import Bodies
from quintet.components.dem_bodies.state import GONE, Model, State, Whole
from quintet.interfaces.component import Array, Fields

ROUNDING = 1e-6  # of a step, by which it may begin too early
SHORTEST = 1e-3  # of a stable step: none is made shorter to end at the time of a change


class Timetable:
    """The changes of a run, of which each is made once.

    Parameters
    ----------
    params : DemBodiesParams
    bodies : Bodies
    model : Model
        Its planes and locks are changed.
    """

    def __init__(self, params: DemBodiesParams, bodies: Bodies, model: Model) -> None:
        self.model, kind = model, bodies.kind_of_each()
        self.planes: Whole = np.array(
            [k for k, plane in enumerate(params.planes) if plane.until is not None], np.int64
        )
        of_kinds = np.array(
            [np.inf if b.released_at is None else b.released_at for b in bodies.kinds]
        )
        self.bodies: Whole = np.flatnonzero(np.isfinite(of_kinds[kind]))
        times = [params.planes[k].until for k in self.planes.tolist()]
        self.times = np.concatenate([np.array(times, float), of_kinds[kind][self.bodies]])  # s
        self.done = np.zeros(len(self.times), np.bool_)
        self.offset = model.plane[self.planes, 3].copy()  # m
        free = np.array([free_motion(body) for body in bodies.kinds])
        self.free = free[kind[self.bodies]]  # (k, 6) as long as they are held

    def advance(self, state: State, time: float, dt: float) -> None:
        """Make the changes that are due at a time [s], when a step of length dt [s] begins."""
        due = ~self.done & (self.times <= time + ROUNDING * dt)
        if not due.any():
            return
        released = self.bodies[due[len(self.planes) :]]
        self.done |= due
        self._write(state)
        for row in state.row[released].tolist():
            write_free_rotation(self.model, state, row)

    def longest(self, time: float, stable: float) -> float:
        """Longest step [s] at a time [s] that ends at the next change, of at most a stable one."""
        left = self.times[~self.done] - time
        coming = left[left > ROUNDING * stable]
        return min(stable, max(float(coming.min(initial=np.inf)), SHORTEST * stable))

    def _write(self, state: State) -> None:
        """Write planes and locks as they are now into the model."""
        planes, bodies = np.split(self.done, [len(self.planes)])
        self.model.plane[self.planes, 3] = np.where(planes, GONE, self.offset)
        rows = state.row[self.bodies]
        self.model.free[rows] = np.where(bodies[:, None], 1.0, self.free)
        self.model.locked[rows] = ~bodies & (self.free == 0.0).any(axis=1)

    def save(self) -> dict[str, Array]:
        """Copy out which changes are made."""
        return {"timetable": self.done.astype(np.float64)}

    def load(self, saved: Fields, state: State) -> None:
        """Come back to the planes and locks of a saved state; `state` has been loaded."""
        self.done = np.asarray(saved["timetable"]) != 0.0
        self._write(state)

    def restart(self, state: State) -> None:
        """Begin again at a time of 0."""
        self.done[:] = False
        self._write(state)


def has_changes(params: DemBodiesParams, bodies: Bodies) -> bool:
    """Whether anything vanishes or is released."""
    planes = any(plane.until is not None for plane in params.planes)
    return planes or any(body.released_at is not None for body in bodies.kinds)
