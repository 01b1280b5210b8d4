"""Parameters of a lattice of mass points."""

import math
from typing import Annotated, ClassVar, Literal

from pydantic import Field

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
CutOff = Annotated[float, Field(ge=0.5, lt=1.0)]
HIGHEST_EXPONENT = 12


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
class SevenRootForce:
    """F = c Π(x - x_i) e(x) STEP(x, 2s, 1, 2, 0), with x = r/a; positive is attraction.

    Stable roots stand at the neighbours of the lattice: 1, √2, √3, 2. Arinchev's envelope e is
    (x - 1)^p, ``power``; with p above 0 the bonds to the nearest have no linear stiffness.

    Parameters
    ----------
    envelope
        e(x): x^p (ratio) or, to the letter of the paper, (x - 1)^p (power).
    exponent : 1
        p: a whole number for ratio, an even one for power.
    unstable_roots : 1
        x₂, x₄, x₆, between the stable ones.
    cut_off : 1
        s: the cut-off begins at 2s spacings and ends at 2.
    top_frequency : Hz
        Highest frequency of the lattice with its frozen points (above 2000 points: of the infinite
        lattice), from which c follows; this or `amplitude`.
    amplitude : N
        c: of power A a^(7+p), of ratio A a^7.
    """

    envelope: Literal["ratio", "power"] = "ratio"
    exponent: NotNegative = 6.0
    unstable_roots: tuple[Positive, Positive, Positive] = (
        0.5 * (1.0 + math.sqrt(2.0)),
        0.5 * (math.sqrt(2.0) + math.sqrt(3.0)),
        0.5 * (math.sqrt(3.0) + 2.0),
    )
    cut_off: CutOff = 0.9
    top_frequency: Positive | None = None
    amplitude: Positive | None = None

    def __post_init__(self) -> None:
        p = self.exponent
        if p != math.floor(p) or p > HIGHEST_EXPONENT:
            raise ValueError(
                f"seven_roots: exponent must be whole and at most {HIGHEST_EXPONENT}; found {p:g}: "
                "a power with a fraction has no value where points are nearer than a spacing. "
                "Take 0, 2, 4 or 6."
            )
        if self.envelope == "power" and p % 2 == 1:
            raise ValueError(
                f"seven_roots: exponent of the envelope power must be even; found {p:g}: with an "
                "odd one the force does not change its sign at r = a, so that nothing brings a "
                "point back. Take 0 or 2, or the envelope ratio."
            )
        if (self.top_frequency is None) == (self.amplitude is None):
            raise ValueError(
                "seven_roots: its strength must be given once; give either top_frequency or "
                "amplitude."
            )
        first, second, third = self.unstable_roots
        inside = 1.0 < first < math.sqrt(2.0) < second < math.sqrt(3.0) < third < 2.0
        if not inside:
            raise ValueError(
                "seven_roots: unstable_roots must stand between 1, √2, √3 and 2; found "
                f"{self.unstable_roots}. Correct them."
            )


@parameters
class Damping:
    """A force δ ṙ along pairs.

    Parameters
    ----------
    coefficient : N s/m
        δ.
    range
        Which pairs: all, at any distance, as the paper's formula has it (up to 2000 points);
        those within two spacings (cut-off); or with the weight of the force's STEP (step).
    cut_off : 1
        s of that weight.
    """

    coefficient: NotNegative
    range: Literal["all", "cut-off", "step"] = "cut-off"
    cut_off: CutOff = 0.9


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
        Step over the greatest stable one of the highest frequency: 2/ω, of Yoshida's 1.573/ω.
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
                amplitude >= spacing,
                f"drive: amplitude must be below the spacing of {spacing:g} m, as its points would "
                f"meet; found {amplitude:g} m. Make it smaller.",
            ),
            (
                sum(bath.coupled for bath in self.baths) > 1,
                "baths: only one may be coupled, as there is one wall. Couple one.",
            ),
        ]
