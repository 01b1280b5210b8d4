"""Planes of symmetry: faces of the tank that act as a mirror; imported only by a scene that asks.

Each particle nearer to such a plane than the kernel reaches has an image behind it, whose place
and velocity are mirrored, and whose density and pressure are the particle's own:

    r' = r - 2 d n,   u' = u - 2 (u·n) n,   d = (r - r_plane)·n, with its sign

To the fluid and to walls the images of fluid are fluid, with all terms between its pairs, and those
of walls and samples are these: what is left of a symmetric whole moves as that does. Which
particles have images is found with the neighbour lists; where these are, before each pass over
pairs. Images stand behind all other rows of the state. Near an edge between two planes the images
in one have images in the other.

A particle that passes the plane meets its own image there. The two change their parts, which
changes nothing for any other, so that no fluid is lost through the plane.
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

from quintet.components.shared.cells import grid_around, sorted_into
from quintet.components.shared.neighbours import FAST, Neighbours, neighbours_within
from quintet.components.shared.team import Team
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.state import Array, State, Whole
from quintet.interfaces.errors import StepError


class Images:
    """The images of one fluid, from one list of neighbours to the next."""

    def __init__(self, params: SphFluidParams) -> None:
        self.planes: list[tuple[str, int, float, float]] = []  # face, axis, place [m], inward
        for face in sorted(set(params.symmetry)):
            assert params.walls is not None
            axis, upper = "xyz".index(face[0]), face[1] == "+"
            self.planes.append((face, axis, params.walls[upper][axis], -1.0 if upper else 1.0))
        self.origin: list[Whole] = []  # of each plane: rows whose images it adds

    def make(self, state: State, reach: float) -> tuple[Array, NDArray[np.bool_]]:
        """Make room in the state for images of what was nearer to planes than `reach` [m].

        Returns all places (n + images, 3) m at the time of the lists, and which are of fluid.
        """
        points = state.reference[: state.particles]
        wet = np.arange(len(points)) < state.fluid
        self.origin = []
        for _, axis, plane, inward in self.planes:
            near = np.flatnonzero(inward * (points[:, axis] - plane) < reach)
            image = points[near]
            image[:, axis] = 2.0 * plane - image[:, axis]
            points, wet = np.concatenate([points, image]), np.concatenate([wet, wet[near]])
            self.origin.append(near)
        for name in ("place", "motion"):
            old = getattr(state, name)[: state.particles]
            setattr(state, name, np.concatenate([old, np.zeros((len(points) - len(old), 4))]))
        self.fill(state)
        return points, wet

    def reflect(self, points: Array) -> Array:
        """Points (m, 3) m, or spots (m, 2) m, then their images in all planes and edges."""
        for _, axis, plane, _ in self.planes:
            if axis >= points.shape[1]:
                continue
            image = points.copy()
            image[:, axis] = 2.0 * plane - image[:, axis]
            points = np.concatenate([points, image])
        return points

    def fill(self, state: State) -> None:
        """Write the images of the state as it is."""
        first = state.particles
        for (_, axis, plane, _), origin in zip(self.planes, self.origin, strict=True):
            rows = slice(first, first + len(origin))
            state.place[rows] = state.place[origin]
            state.place[rows, axis] = 2.0 * plane - state.place[rows, axis]
            first = rows.stop
        self.turn(state.motion, state.particles)

    def turn(self, velocity: Array, first: int) -> None:
        """Write velocities (n + images, 4) of images, which begin with row `first`."""
        for (_, axis, _, _), origin in zip(self.planes, self.origin, strict=True):
            rows = slice(first, first + len(origin))
            velocity[rows] = velocity[origin]
            velocity[rows, axis] *= -1.0
            first = rows.stop

    def copy(self, first: int, *lists: NDArray[np.floating] | None) -> None:
        """Write values (n + images,) of images, from row `first` on: those of their origins."""
        for origin in self.origin:
            for values in lists:
                if values is not None:
                    values[first : first + len(origin)] = values[origin]
            first += len(origin)

    def turn_back(self, state: State) -> None:
        """Let fluid that passed a plane change places with its image."""
        for _, axis, plane, inward in self.planes:
            out = np.flatnonzero(inward * (state.place[: state.fluid, axis] - plane) < 0.0)
            state.place[out, axis] = 2.0 * plane - state.place[out, axis]
            state.motion[out, axis] *= -1.0
            if len(state.pull):
                state.pull[out, axis] *= -1.0

    def refuse(self, points: Array) -> None:
        """Raise where samples (samples, 3) m are behind a plane."""
        for face, axis, plane, inward in self.planes:
            depth = inward * (points[:, axis] - plane)
            worst = int(np.argmin(depth))
            if depth[worst] < 0.0:
                raise StepError(
                    f"surface: samples must stay before the plane of symmetry {face}, {face[0]} = "
                    f"{plane:g} m; sample {worst} is at {face[0]} = {points[worst, axis]:.4g} m. "
                    "Move the body, cut it there, or compute the whole."
                )


def neighbours(
    images: Images, state: State, reach: float, team: Team, seekers: Array | None,
    room: NDArray[np.int32],
) -> Neighbours:  # fmt: skip
    """Make images, and lists as those without: of the fluid, then of the boundary or `seekers`."""
    points, wet = images.make(state, reach)
    fluid, other = np.flatnonzero(wet), np.flatnonzero(~wet)
    grid = grid_around(points[fluid], reach)
    fluid, other = (rows[sorted_into(points[rows], grid)[2]] for rows in (fluid, other))
    row = np.concatenate([fluid, other])
    found = neighbours_within(reach, points[row], len(fluid), team, seekers, room)
    at = np.empty(len(row), np.int64)
    at[row] = np.arange(len(row))
    if seekers is None:
        wanted = at[: state.particles]
    else:
        wanted = np.concatenate([at[: state.fluid], len(fluid) + np.arange(len(seekers))])
    begin, middle, end = (one[wanted] for one in (found.begin, found.middle, found.end))
    team.run(rename, len(wanted), begin, end, row, found.list)
    return Neighbours(found.list, begin, middle, end)


@njit(**FAST)
def rename(
    first: int, last: int, begin: Whole, end: Whole, row: Whole, neighbour: NDArray[np.int32]
) -> None:
    """Write rows of the state over those of the search, in lists [first, last)."""
    for i in range(first, last):
        for k in range(begin[i], end[i]):
            neighbour[k] = row[neighbour[k]]
