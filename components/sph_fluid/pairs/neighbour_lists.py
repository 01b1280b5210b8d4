"""The neighbour lists of a fluid and its boundary: how far they reach, how long they hold."""

import numpy as np

from quintet.components.shared.geometry.bounds import Bounds
from quintet.components.shared.search.cells import grid_around, sorted_into
from quintet.components.shared.search.neighbours import Lists, NeighbourLists
from quintet.components.shared.search.verlet_list import longest, slack
from quintet.components.shared.smoothing.cubic_spline import SUPPORT
from quintet.components.shared.threads import Team
from quintet.components.sph_fluid.boundary.method import BoundaryMethod
from quintet.components.sph_fluid.boundary.samples import Samples
from quintet.components.sph_fluid.boundary.symmetry_planes import SymmetryPlanes
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.state import Array, State, Whole
from quintet.interfaces.errors import StepError

# Of the kernel's support, how much further the neighbour lists reach: longer steps want more.
SKIN = {"extrapolated": 0.1, "symplectic": 0.2}
STRAY = 0.5  # of the tank's longest edge: how far outside of it a particle is lost


class FluidLists:
    """What is near every particle of one fluid, and its boundary."""

    def __init__(self, params: SphFluidParams, samples: Samples) -> None:
        self.samples = samples
        self.walls = params.boundary.tank
        self.cutoff = SUPPORT * params.smoothing_length  # m
        self.reach = (1.0 + SKIN[params.integration]) * self.cutoff  # m
        # In the middle of a step of position Verlet pairs meet too.
        self.middle = params.integration == "symplectic"
        self.near = NeighbourLists()

    @property
    def arrays(self) -> Lists:
        """What kernels take."""
        return self.near.arrays

    def need_rebuild(self, state: State, boundary: BoundaryMethod, dt: float) -> bool:
        """Whether pairs may meet in a step of dt [s] that the lists lack."""
        if len(state.reference) == 0:
            return True
        row, moved = self.samples.row, 0.0
        if len(row):
            moved = longest(
                state.position_density.take(row, 0)[:, :3] - state.reference.take(row, 0)
            )
            moved = max(moved, boundary.displacement(state))
        # Each of two goes to the middle of the step at its speed.
        coming = dt * longest(state.velocity_pressure[: state.fluid]) if self.middle else 0.0
        return slack(self.reach - self.cutoff - coming, state.moved, moved) < 0.0

    def sort(self, state: State) -> None:
        """Bring particles that are near into near rows; drop those that left the domain."""
        split = state.fluid
        inside = in_domain(state.position_density[:split], self.walls)
        if not len(inside):
            raise StepError("step: all fluid has left the domain. Check the walls and gravity.")
        fluid = state.position_density.take(inside, axis=0)
        boundary = state.position_density[split : state.particles]
        grid = grid_around(fluid, self.reach)
        state.lost += split - len(inside)
        state.keep(inside[sorted_into(fluid, grid)[2]], sorted_into(boundary, grid)[2])
        places = [state.position_density[:, :3], state.mirror_point]
        state.reference, state.moved = np.concatenate(places), 0.0
        self.samples.find_rows(state)

    def make(
        self, state: State, boundary: BoundaryMethod, symmetry: SymmetryPlanes, team: Team
    ) -> None:
        """List what is near, from where all was when it was sorted."""
        query_points, self.samples.listed = boundary.query_points(state)
        self.near = symmetry.neighbours(state, self.reach, team, query_points, self.near.list)


def in_domain(points: Array, walls: Bounds | None) -> Whole:
    """Rows (k,) of points (n, 3 or more) m that are in the tank or not far outside of it."""
    inside = np.ones(len(points), bool)
    if walls is not None:
        low, high = np.array(walls)
        stray = STRAY * float((high - low).max())
        for axis in range(3):
            along = points[:, axis]
            inside &= (along > low[axis] - stray) & (along < high[axis] + stray)
    return np.flatnonzero(inside)
