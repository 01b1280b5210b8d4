"""The neighbour lists of a fluid and its boundary: how far they reach, how long they hold."""

from quintet.components.shared.search.neighbours import Lists, NeighbourLists
from quintet.components.shared.search.verlet_list import longest, slack
from quintet.components.shared.smoothing.cubic_spline import SUPPORT
from quintet.components.shared.threads import Team
from quintet.components.sph_fluid.boundary.method import BoundaryMethod
from quintet.components.sph_fluid.boundary.samples import Samples
from quintet.components.sph_fluid.boundary.symmetry_planes import SymmetryPlanes
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.ranks.method import Ranks
from quintet.components.sph_fluid.state import State

# Of the kernel's support, how much further the neighbour lists reach: longer steps want more.
SKIN = {"extrapolated": 0.1, "symplectic": 0.2}


class FluidLists:
    """What is near every particle of one fluid, and its boundary."""

    def __init__(self, params: SphFluidParams, samples: Samples, ranks: Ranks) -> None:
        self.samples, self.ranks = samples, ranks
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

    def need_rebuild(
        self, state: State, boundary: BoundaryMethod, dt: float, speed: float | None = None
    ) -> bool:
        """Whether pairs may meet in a step of dt [s] that the lists lack.

        `speed` is that of the fastest fluid [m/s], if it is not to be found in the state.
        """
        if len(state.reference) == 0:
            return True
        row, moved = self.samples.row, 0.0
        if len(row):
            moved = longest(
                state.position_density.take(row, 0)[:, :3] - state.reference.take(row, 0)
            )
            moved = max(moved, boundary.displacement(state))
        # Each of two goes to the middle of the step at its speed.
        if self.middle and speed is None:
            speed = longest(state.velocity_pressure[: state.fluid])
        coming = dt * speed if self.middle and speed else 0.0
        if self.middle or len(self.samples.volume):
            moved, coming = self.ranks.greatest(moved, coming)
        return slack(self.reach - self.cutoff - coming, state.moved, moved) < 0.0

    def sort(self, state: State) -> None:
        """Bring particles that are near into near rows; drop those that left the domain."""
        self.ranks.sort(state, self.reach, self.walls)
        self.samples.find_rows(state)

    def make(
        self, state: State, boundary: BoundaryMethod, symmetry: SymmetryPlanes, team: Team
    ) -> None:
        """List what is near, from where all was when it was sorted."""
        query_points, self.samples.listed = boundary.query_points(state)
        self.near = symmetry.neighbours(state, self.reach, team, query_points, self.near.list)
