"""What a scene says about bodies that carry clouds of nodes."""

import math
from typing import Annotated, ClassVar, Literal

from pydantic import Field

from quintet.components.meshless_gas.clouds.cap import ARC
from quintet.interfaces.params import NotNegative, Number, Positive, Vector, parameters

ROUND = 8  # fewest nodes round a body
AT_SHOCK = 0.25  # of its height, on either side of a shock: where layers are finest
WIDENING = 0.5  # of layers with the distance from there
MOST_LAYERS = 10_000  # of nodes above the wall of a body
CLOSE = 1e-6  # rad, within which a sector is what it is meant to be


@parameters
class Body:
    """A sphere; in the plane of x and z a cylinder across it.

    Parameters
    ----------
    shape
        A cylinder is written as a sphere, too.
    centre, radius : m
        At the start. Leave out the centre of a driven body, and its radius unless it is smaller
        than its partner's: the gas takes both from the partner.
    velocity : m/s
        Of one that is not driven; of one that is, at the start.
    angular_velocity : rad/s
        About y, of a cylinder that holds the gas and is not driven; of one that is, at the start.
    is_driven
        Whether a partner moves it: it is then a row of the ports `motion`, `load` and `heat`. The
        partner's body is no smaller, and larger where bodies strike each other: contact cannot be
        computed, two layers of nodes on each must fit between. Its mass is the partner's as it is;
        loads are those on 1 m of a cylinder, whose mass a sphere has at 1.5 m over its diameter
        times the density.
    points_around : 1
        Nodes round the whole circle; of an axisymmetric flow half of them are computed. In space
        nodes of a geodesic grid are about as far apart.
    thickness : m
        Of its cloud. The bow shock should lie within it or far beyond it, not at its rim.
    spacing : m
        Between layers, at most; that of the nodes around the cloud.
    first_spacing : m
        Height of the first layer; if not said, 0.8 of the distance between nodes of the wall.
    growth : 1
        Of one layer over the one below it.
    shock_height : m
        Of the bow shock over the wall where the stream meets it; layers there are `shock_spacing`
        apart, from 0.75 to 1.25 times that height, and ever farther apart away from it.
    shock_spacing : m
        Of layers at the bow shock; if not said, as elsewhere.
    sector : rad
        Widest angle of its cloud from upstream, π for the whole. At π/2, of a body that stands
        still, the cloud ends in the plane across x through the centre, as the box must: gas leaves
        there, and what is behind the body is not computed.
    first_spacing_at_sector : m
        Height of the first layer at the sector's end; if not said, as on the axis. In between it
        grows with (1 - cos θ)², as a boundary layer does about.
    temperature : K
        Of a wall that holds a viscous gas; if not said, the gas slips along it.
    is_adiabatic
        Whether the wall, in place of having a temperature, holds a viscous gas and takes no heat.
    weight : 1
        Of the least squares: 0 for a truncated Gaussian over the distance, else the power p of
        1/dᵖ.
    """

    RENAMED: ClassVar = {
        "position": "centre",
        "diameter": "radius, half of it",
        "rays": "points_around",
        "first": "first_spacing",
        "first_at_sector": "first_spacing_at_sector",
    }
    shape: Literal["sphere"] = "sphere"
    centre: Vector = None  # type: ignore[assignment]  # one without is refused below
    radius: Positive = None  # type: ignore[assignment]
    velocity: Vector = (0.0, 0.0, 0.0)
    angular_velocity: Number = 0.0
    is_driven: bool = False
    points_around: Annotated[int, Field(ge=ROUND)]
    thickness: Positive
    spacing: Positive
    first_spacing: Positive | None = None
    growth: Annotated[float, Field(ge=1, le=2, allow_inf_nan=False)] = 1.08
    shock_height: Positive | None = None
    shock_spacing: Positive | None = None
    sector: Annotated[float, Field(gt=0, le=math.pi + 1e-9, allow_inf_nan=False)] = math.pi
    first_spacing_at_sector: Positive | None = None
    temperature: Positive | None = None
    is_adiabatic: bool = False
    weight: NotNegative = 0.0

    def __post_init__(self) -> None:
        lacking = [name for name in ("centre", "radius") if getattr(self, name) is None]
        if lacking:
            raise ValueError(
                f"a body must have {' and '.join(lacking)}, given here or, of a driven body, "
                "stated by its partner; found neither. Give it here."
            )
        rules = [*self._rules_of_walls(), *self._rules_of_layers()]
        for is_wrong, sentence in (*rules, *(self._rules_of_sectors() if self.is_cut else ())):
            if is_wrong:
                raise ValueError(sentence)

    def _rules_of_walls(self) -> list[tuple[bool, str]]:
        """What does not fit between walls and friction, and how to correct it."""
        return [
            (
                self.is_adiabatic and self.temperature is not None,
                "an adiabatic wall has the temperature of the gas; found both. Leave out "
                "temperature or is_adiabatic.",
            ),
            (
                bool(self.angular_velocity) and not self.is_no_slip,
                "angular_velocity is of a wall that holds the gas; found one that slips. Give a "
                "temperature, or leave out angular_velocity.",
            ),
        ]

    def _rules_of_layers(self) -> list[tuple[bool, str]]:
        """What does not fit among the heights of layers, and how to correct it."""
        at_sector = self.first_spacing_at_sector is not None
        return [
            (
                (self.shock_height is None) != (self.shock_spacing is None),
                "shock_height and shock_spacing belong together; found one of them. Give both, or "
                "neither.",
            ),
            (
                self.shock_spacing is not None and at_sector,
                "layers are as high at all angles where shock_spacing sets them; found "
                "first_spacing_at_sector beside it. Leave out one of them.",
            ),
            (
                at_sector and not self.is_cut,
                "first_spacing_at_sector is of a cloud that ends at a sector; found none. Give "
                "a sector of π/2, or leave out first_spacing_at_sector.",
            ),
            (
                self.heights[-1] < self.thickness,
                f"a body has at most {MOST_LAYERS} layers; found more over a thickness of "
                f"{self.thickness:g} m. Lower thickness, or raise first_spacing, growth, spacing "
                "or shock_spacing.",
            ),
        ]

    def _rules_of_sectors(self) -> list[tuple[bool, str]]:
        """What does not fit a cloud that ends at a sector, and how to correct it."""
        layers, first = len(self.heights) - 1, self.first_spacing_at_sector or 0.0
        thickest = self.heights[-1] / layers
        return [
            (
                abs(self.sector - 0.5 * math.pi) > CLOSE,
                f"a cloud ends at π/2 = 1.5707963 or is whole, π; found sector = {self.sector:g}. "
                "Correct sector.",
            ),
            (
                self.is_driven or any(self.velocity),
                "a body whose cloud ends at a sector must stand still, for its box ends there too; "
                "found one that moves. Leave out sector, or is_driven and velocity.",
            ),
            (
                first > thickest,
                f"first_spacing_at_sector: {layers} layers over {self.heights[-1]:g} m are "
                f"{thickest:.4g} m thick in the mean, and the first can be no thicker; found "
                f"{first:g} m. Lower it, or growth.",
            ),
        ]

    @property
    def is_no_slip(self) -> bool:
        """Whether its wall holds the gas by friction."""
        return self.is_adiabatic or self.temperature is not None

    @property
    def is_cut(self) -> bool:
        """Whether its cloud ends at a sector."""
        return self.sector < math.pi - CLOSE

    @property
    def frequency(self) -> int:
        """Parts of an icosahedron's edge in space."""
        return max(2, round(self.points_around * ARC / math.tau))

    @property
    def heights(self) -> list[float]:
        """Heights [m] of its layers above the wall; the last ends its cloud."""
        step = self.first_spacing or 0.8 * math.tau * self.radius / self.points_around
        heights = [0.0]
        while heights[-1] < self.thickness and len(heights) <= MOST_LAYERS:
            heights.append(heights[-1] + min(step, self._spacing_near_shock(heights[-1])))
            step = min(step * self.growth, max(self.spacing, step))
        return heights

    def _spacing_near_shock(self, height: float) -> float:
        """Greatest spacing [m] of layers at a height that the bow shock allows."""
        if self.shock_height is None or self.shock_spacing is None:
            return math.inf
        away = abs(height - self.shock_height) - AT_SHOCK * self.shock_height
        return self.shock_spacing + WIDENING * max(away, 0.0)


@parameters
class Moving:
    """Bodies that carry clouds of nodes, and how clouds are joined at their overlaps.

    Nodes of other clouds are left out where a body's cloud covers them.

    Parameters
    ----------
    bodies
        One or more.
    axisymmetric
        Whether x is an axis of symmetry and z the radius; bodies are then spheres on it.
    threshold : 1
        Way of a body, over its spacing, after which holes are cut and neighbours found again.
    hysteresis : 1
        Spacings by which a body must be farther from a node for it to come back than it was when
        the node was left out.
    fringe_distance : 1
        Nodes that are nearer than this to one of a body's cloud are left out, in spacings.
    overlap : 1
        By how many spacings clouds overlap.
    fringe_order
        Of the scheme at nodes that reach over an overlap; 1 where a strong shock crosses it.
    line_stencils
        In space: whether nodes that reach over no overlap have neighbours along lines alone, 6 in a
        lattice and 8 in shells; else those of a whole block.
    """

    RENAMED: ClassVar = {
        "cross": "line_stencils",
        "seam_distance": "fringe_distance",
        "seam_order": "fringe_order",
    }
    bodies: Annotated[tuple[Body, ...], Field(min_length=1)]
    axisymmetric: bool = False
    threshold: Positive = 0.25
    hysteresis: NotNegative = 0.3
    fringe_distance: NotNegative = 0.5
    overlap: Positive = 0.9
    fringe_order: Literal[1, 2] = 2
    line_stencils: bool = False

    def __post_init__(self) -> None:
        if self.axisymmetric:
            for body in self.bodies:
                if any(body.centre[1:]) or any(body.velocity[1:]):
                    raise ValueError(
                        "bodies of an axisymmetric flow lie and move on the axis; found centre "
                        f"{list(body.centre)} m, velocity {list(body.velocity)} m/s. Leave y and "
                        "z at 0."
                    )
                if body.angular_velocity:
                    raise ValueError(
                        "spheres of an axisymmetric flow do not turn about y; found "
                        f"{body.angular_velocity:g} rad/s. Leave out angular_velocity."
                    )

    @property
    def is_cut(self) -> bool:
        """Whether a cloud ends at a sector, and about no axis of symmetry."""
        return not self.axisymmetric and any(body.is_cut for body in self.bodies)

    def expected_count(self, dimensions: int) -> int:
        """Nodes of all bodies' clouds."""
        if dimensions == 3:
            return sum(
                round((5 * body.frequency**2 + 1) * (1.0 - math.cos(body.sector)))
                * len(body.heights)
                for body in self.bodies
            )
        whole = sum(
            round(body.points_around * body.sector / math.pi) * len(body.heights)
            for body in self.bodies
        )
        return whole // 2 if self.axisymmetric else whole

    @property
    def finest_spacing(self) -> float:
        """Least distance [m] of nodes in bodies' clouds."""
        return min(
            min(
                body.heights[1],
                body.shock_spacing or math.inf,
                math.tau * body.radius / body.points_around,
            )
            for body in self.bodies
        )
