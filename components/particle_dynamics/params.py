"""Parameters of a lattice of mass points."""

import math
from typing import Annotated, ClassVar, Literal

from pydantic import Field

from quintet.components.particle_dynamics.force_params import Damping, SevenRootForce
from quintet.components.shared.geometry.selections import ByBox
from quintet.interfaces.params import (
    Count,
    DataFile,
    NotNegative,
    Positive,
    Vector,
    parameters,
)

Direction = Literal["x", "y", "z"]
Towards = Literal["-x", "+x", "-y", "+y", "-z", "+z"]


@parameters
class Lattice:
    """A simple cubic lattice of equal mass points, at rest or in thermal motion.

    Parameters
    ----------
    cells : 1
        Spacings along x, y and z: open sides have one point more, periodic ones as many.
    spacing : m
        a, between nearest points.
    mass : kg
        Of each point.
    lowest : m
        Its lowest corner.
    periodic
        Axes along which it repeats; at least six points each.
    temperature : K
        At the start: velocities are drawn at random, twice the equipartition of what will move,
        as half of it goes into the bonds.
    """

    cells: tuple[Count, Count, Count]
    spacing: Positive
    mass: Positive
    lowest: Vector = (0.0, 0.0, 0.0)
    periodic: tuple[Direction, ...] = ()
    temperature: NotNegative = 0.0

    def __post_init__(self) -> None:
        for axis, count in zip("xyz", self.cells, strict=True):
            if axis in self.periodic and count < 6:
                raise ValueError(
                    f"lattice: a periodic axis must have at least 6 cells, so that no pair meets "
                    f"itself; {axis} has {count}. Make it longer."
                )

    @property
    def points(self) -> tuple[int, int, int]:
        """Number of points along x, y and z."""
        sides = zip("xyz", self.cells, strict=True)
        x, y, z = (n if axis in self.periodic else n + 1 for axis, n in sides)
        return x, y, z

    @property
    def count(self) -> int:
        """Number of points."""
        return math.prod(self.points)


@parameters
class Drive:
    """Two nearest points at a prescribed distance along their axis: a + D sin 2πft.

    Parameters
    ----------
    point : m
        The point of the lattice nearest to here is one of them.
    partner
        In which direction the other one lies.
    frequency : Hz
        f.
    amplitude : m
        D.
    mode
        Their mean place along the axis is free (relative), or it rests and both move by D/2
        (symmetric), or but one of them moves by D (point, partner).
    """

    point: Vector
    partner: Towards
    frequency: Positive
    amplitude: Positive
    mode: Literal["relative", "symmetric", "point", "partner"] = "relative"


@parameters
class Bath(ByBox):
    """Langevin's bath of the points in a box: friction and random kicks that keep a temperature.

    Parameters
    ----------
    temperature : K
        Of the bath, until a partner sets another.
    rate : 1/s
        γ, at which velocities decay towards it.
    tether : N/m
        Of springs that hold its points at their places.
    coupled
        Whether its points are the wall of a link `heat`; of one bath.
    """

    temperature: NotNegative
    rate: Positive
    tether: NotNegative = 0.0
    coupled: bool = False


@parameters
class Averages:
    """What temperatures, hotness and heat flows are means of.

    Parameters
    ----------
    begin : s
        From when.
    block : s
        Length of the blocks from which their standard errors follow; longer than what they
        remember.
    """

    begin: NotNegative = 0.0
    block: Positive = 1.0


@parameters
class ParticleLatticeParams:
    """A lattice of mass points, its pair force, and what holds, drives and heats it.

    Parameters
    ----------
    lattice
        The points.
    seven_roots
        Their pair force, of seven roots; this or `force_table`.
    force_table
        File of distance [m] and force [N], attraction positive, the last 0.
    damping
        Along pairs.
    frozen : m
        The points nearest to these places do not move.
    drive
        Two points whose distance oscillates.
    baths
        Of points that are kept at temperatures.
    collision_rate : 1/s
        Of each pair of nearest points: their relative velocity turns into a random direction, which
        conserves momentum and energy.
    seed : 1
        Of all random numbers.
    boltzmann : J/K
        k: a point has 3/2 k T of kinetic energy.
    integrator
        Of second order, or Yoshida's of fourth; with damping both are of second.
    courant : 1
        Step over the greatest stable one of the highest frequency, be it that of the drive: 2/ω, of
        Yoshida's 1.573/ω. Strong damping makes it shorter.
    substeps : 1
        Steps that are computed in one call of the coupler.
    averages
        Of temperatures, hotness and heat flows.
    if_point_lost
        What happens when a point has left all others behind, or when a twentieth of the bonds to
        the nearest is broken: the run stops, or continues with a warning.
    """

    RENAMED: ClassVar = {"on_loss": "if_point_lost", "steps_at_once": "substeps"}

    lattice: Lattice
    seven_roots: SevenRootForce | None = None
    force_table: DataFile | None = None
    damping: Damping | None = None
    frozen: tuple[Vector, ...] = ()
    drive: Drive | None = None
    baths: tuple[Bath, ...] = ()
    collision_rate: NotNegative = 0.0
    seed: Annotated[int, Field(ge=0)] = 1
    boltzmann: Positive = 1.380649e-23
    integrator: Literal["velocity_verlet", "yoshida"] = "velocity_verlet"
    courant: Annotated[float, Field(gt=0.0, le=1.0)] = 0.03
    substeps: Count = 1
    averages: Averages = Averages()
    if_point_lost: Literal["stop", "report"] = "stop"

    def __post_init__(self) -> None:
        wrong = [sentence for is_wrong, sentence in self._rules() if is_wrong]
        if wrong:
            raise ValueError(" ".join(wrong))

    def _rules(self) -> list[tuple[bool, str]]:
        table, roots = self.force_table is not None, self.seven_roots is not None
        is_random = bool(self.baths) or self.collision_rate > 0.0
        is_literal = self.damping is not None and self.damping.range == "all"
        amplitude = 0.0 if self.drive is None else self.drive.amplitude
        spacing = self.lattice.spacing
        return [
            (table == roots, "one pair force is needed; give seven_roots or force_table."),
            (
                is_random and self.integrator == "yoshida",
                "baths and collisions need the integrator velocity_verlet, as Yoshida's steps "
                "backwards in time; change the integrator.",
            ),
            (
                is_literal and self.lattice.count > 2000,
                f"damping of all pairs is for at most 2000 points; found {self.lattice.count}. "
                "Give damping the range cut-off.",
            ),
            (
                is_literal and bool(self.lattice.periodic),
                "damping of all pairs needs open sides, for a pair and its images are at several "
                "distances; found periodic ones. Give damping the range cut-off.",
            ),
            (
                amplitude >= spacing,
                f"drive: amplitude must be below the spacing of {spacing:g} m, as its points would "
                f"meet; found {amplitude:g} m. Make it smaller.",
            ),
            (
                sum(bath.coupled for bath in self.baths) > 1,
                "baths: only one may be coupled, as there is one wall. Couple one.",
            ),
        ]
