"""What a scene says about a gas."""

import math
from typing import Annotated, Literal

from pydantic import Field

from quintet.components.meshless_gas.boundaries import (
    NO_SLIP,
    Boundary,
    Gas,
    GasState,
    unknown_boundaries,
    wrong_round_layers,
)
from quintet.components.meshless_gas.clouds.params import BoxCloud, PlateCloud, SphereCloud
from quintet.components.meshless_gas.directions import off_plane, through_walls
from quintet.components.meshless_gas.moving_bodies import Moving
from quintet.components.meshless_gas.particle_coupling import PointParticles
from quintet.components.meshless_gas.readings import Front, Steady, wrong_places
from quintet.components.meshless_gas.starts import Riemann, Vortex, Zone
from quintet.interfaces.params import NotNegative, Positive, Vector, parameters


@parameters
class MeshlessGasParams:
    """A gas on a cloud of nodes, and how it is computed.

    Parameters
    ----------
    gas
        Which gas: a table, or the name of a material.
    dimensions
        In 2 the gas lies in the plane of x and z, and is 1 m deep.
    axisymmetric
        In 2 dimensions: whether the plane is a meridional one, z the distance from the axis x, and
        sums are those of whole rings.
    box
        A box of nodes; this, a sphere or a plate.
    sphere
        Nodes round a sphere; in 2 dimensions axisymmetric.
    plate
        Nodes over a flat plate, in 2 dimensions.
    boundaries
        What is at the faces of a box, ``x-`` to ``z+``, periodic where nothing is said; or at the
        named boundaries of another cloud.
    viscous
        Whether friction and heat conduction are computed, as walls that hold the gas need.
    initial
        State at the start.
    zones
        Where it begins otherwise; later ones count.
    riemann
        In place of the initial state.
    vortex
        In the initial state.
    neighbours : 1
        Of each node of a box; the nearest. If not given, 8 (in 3 dimensions 18), and more of nodes
        that these do not surround evenly. If given, more of nodes of which all neighbours lie on
        one side, and all of one distance where nodes are not moved at random.
    order
        Of the scheme in space.
    limiter
        Of the slopes of density, velocity and pressure. Koren's serves shocks and smooth flows.
        Superbee keeps contacts sharp, and turns smooth slopes into steps.
    limiter_threshold : 1
        Of van Albada's limiter alone, 1e-6 if not given: squares of differences below this share of
        the square of what they are differences of are not limited. Smooth flows are computed best
        with 1e-2.
    courant : 1
        Share of 1/Σ_j (|v·c_ij| + a |c_ij|) that a step takes.
    local_steps
        Whether each node takes its own stable step, towards a steady flow: times are then those
        of the node of the shortest step, and what entered and drifts of `balance` say nothing.
    steady
        When the flow has settled; the force on the walls is then what is given.
    moving
        Bodies that carry clouds of nodes of their own; none if not said.
    probes : m
        Places; of the node that is nearest to each the state is given.
    fronts
        Lines on which shocks are looked for.
    particles
        How spheres of a partner are felt that are smaller than the spacing.
    """

    gas: Gas = Gas()
    dimensions: Literal[2, 3] = 2
    axisymmetric: bool = False
    box: BoxCloud | None = None
    sphere: SphereCloud | None = None
    plate: PlateCloud | None = None
    boundaries: dict[str, Boundary] = Field(default_factory=dict)
    initial: GasState | None = None
    zones: tuple[Zone, ...] = ()
    riemann: Riemann | None = None
    vortex: Vortex | None = None
    viscous: bool = False
    neighbours: Annotated[int, Field(ge=2, le=64)] | None = None
    order: Literal[1, 2] = 2
    limiter: Literal["van_albada", "minmod", "van_leer", "koren", "superbee"] = "koren"
    limiter_threshold: NotNegative | None = None
    courant: Positive = 0.7
    local_steps: bool = False
    steady: Steady | None = None
    moving: Moving | None = None
    probes: tuple[Vector, ...] = ()
    fronts: tuple[Front, ...] = ()
    particles: PointParticles | None = None

    def __post_init__(self) -> None:
        checks = [self._wrong_clouds, self._wrong_limiter, self._wrong_states, self._wrong_walls]
        checks.append(self._wrong_layers if self.box is None else self._wrong_faces)
        for check in (*checks, self._wrong_places):
            for sentence in check():
                raise ValueError(sentence)

    def _wrong_clouds(self) -> list[str]:
        """What does not fit between the cloud and the dimensions."""
        clouds = [name for name in ("box", "sphere", "plate") if getattr(self, name) is not None]
        rules = [
            (
                len(clouds) != 1,
                "a gas needs a box, a sphere or a plate of nodes, one of them; found "
                f"{' and '.join(clouds) or 'none'}. Correct it.",
            ),
            *self._rules_of_bodies(),
            (
                self.axisymmetric and (self.dimensions == 3 or self.sphere is None),
                "axisymmetric is for a sphere in 2 dimensions. Leave it out.",
            ),
            (
                self.sphere is not None and self.dimensions == 2 and not self.axisymmetric,
                "a sphere in 2 dimensions must be axisymmetric. Say axisymmetric = true.",
            ),
            (
                self.neighbours is not None and self.box is None,
                "neighbours is of the nodes of a box: layers know theirs, by line_stencils. Leave "
                "it out.",
            ),
            (
                self.vortex is not None and self.box is None,
                "a vortex drifts through a periodic box. Give a box.",
            ),
            (
                self.plate is not None and self.dimensions == 3,
                "a plate is of 2 dimensions. Leave dimensions out.",
            ),
        ]
        mistakes = [sentence for is_wrong, sentence in rules if is_wrong]
        layered = self.plate or self.sphere
        return mistakes + ([] if layered is None else layered.layers.wrong(self.axisymmetric))

    def _rules_of_bodies(self) -> list[tuple[bool, str]]:
        """What goes neither with bodies that carry clouds nor with point particles."""
        is_steady = self.local_steps or self.steady is not None
        return [
            (
                self.particles is not None and self.moving is not None,
                "particles that nodes do not resolve go with nodes that stand still; found moving. "
                "Leave out particles, or moving.",
            ),
            (
                (self.particles is not None or self.moving is not None) and is_steady,
                "local_steps and steady are for a flow round what stands still; found particles "
                "or moving. Leave out local_steps and steady.",
            ),
            (
                self.moving is not None and self.planar and self.moving.is_cut,
                "moving: clouds that end at a sector are those of spheres: on an axis of symmetry, "
                "or in 3 dimensions. Say axisymmetric = true or dimensions = 3, or leave it out.",
            ),
            (
                self.moving is not None and bool(self.probes or self.fronts),
                "probes and fronts are read at nodes that stand still; found moving. Leave out "
                "probes and fronts.",
            ),
        ]

    def _wrong_limiter(self) -> list[str]:
        """What does not fit between the limiter and its threshold."""
        if self.limiter == "van_albada" and self.limiter_threshold == 0.0:
            return ["limiter_threshold must be above 0 with van Albada's limiter. Raise it."]
        if self.limiter != "van_albada" and self.limiter_threshold:
            return [
                f"limiter_threshold is of van Albada's limiter; found {self.limiter}. Leave it "
                'out, or say limiter = "van_albada".'
            ]
        return []

    def _wrong_walls(self) -> list[str]:
        """What does not fit between walls and friction."""
        if self.viscous and self.order == 1:
            return [
                "viscous needs order = 2: the first order adds a viscosity of about half of "
                "density, speed of sound and spacing. Leave order out."
            ]
        no_slip = [n for n, boundary in self.boundaries.items() if boundary.kind in NO_SLIP]
        if no_slip and not self.viscous:
            return [f"boundaries.{no_slip[0]} holds the gas by friction. Say viscous = true."]
        layered = {"wall": "z" if self.sphere is None else "xyz", "ahead": "z"}
        return through_walls(
            self.boundaries, layered if self.box is None else {n: n[0] for n in self.boundaries}
        )

    def _wrong_layers(self) -> list[str]:
        """What does not fit among the boundaries of a cloud in layers."""
        cloud = self.sphere or self.plate
        assert cloud is not None
        mistakes = wrong_round_layers(self.boundaries, cloud.SIDES, self.sphere is not None)
        if mistakes or self.sphere is None:
            return mistakes
        far = self.boundaries["far"].state
        if far is None:
            return ["boundaries.far must be an inflow of a given state round a sphere."]
        return self.sphere.wrong(far.velocity, self.axisymmetric)

    def _wrong_states(self) -> list[str]:
        """What does not fit among the states at the start, and what would leave the plane."""
        mistakes = []
        if (self.initial is None) == (self.riemann is None):
            mistakes.append("the gas begins with initial or riemann, one of them. Correct it.")
        taken = [name for name in ("vortex", "zones", "moving") if getattr(self, name)]
        if self.riemann is not None and (taken or self.box is None):
            mistakes.append(
                "riemann is for a tube alone: it needs a box, and leave out vortex, zones and "
                "moving."
            )
        if self.local_steps and (self.riemann is not None or self.vortex is not None):
            mistakes.append(
                "local_steps is for flows that become steady: with riemann or vortex its times "
                "mean nothing. Leave it out."
            )
        if self.riemann is not None and self.box is not None:
            mistakes += self.riemann.wrong(self.box.lowest[0], self.box.highest[0])
        if self.vortex is not None:
            mistakes += self._wrong_vortex(self.vortex)
        if self.planar:
            starts = {"initial": self.initial}
            starts |= {f"zones.{k}.state": zone.state for k, zone in enumerate(self.zones)}
            mistakes += off_plane(starts, self.boundaries)
        return mistakes

    def _wrong_vortex(self, vortex: Vortex) -> list[str]:
        """What does not fit between a vortex and the gas through which it drifts."""
        mistakes = []
        walls = {n: b.kind for n, b in self.boundaries.items() if b.kind != "periodic"}
        if self.zones or self.moving is not None or walls:
            beside = ["zones"] * bool(self.zones) + ["moving"] * (self.moving is not None)
            beside += [f"boundaries.{name} of kind {kind}" for name, kind in walls.items()]
            mistakes.append(
                "a vortex drifts through a periodic box, in the initial state alone; found "
                f"{' and '.join(beside)}. Remove them."
            )
        if self.initial is not None:
            density, *_, pressure = self.initial.primitive(self.gas)
            mistakes += vortex.wrong(self.gas.gamma, pressure / density)
        return mistakes

    def _wrong_faces(self) -> list[str]:
        """What does not fit among the faces of the box."""
        assert self.box is not None
        names = [axis + side for axis in ("xz" if self.dimensions == 2 else "xyz") for side in "-+"]
        kinds = {name: self.kind_of(name) for name in names}
        return unknown_boundaries(self.boundaries, names) + self.box.wrong(kinds)

    def _wrong_places(self) -> list[str]:
        """Which places of probes and ends of fronts lie outside the nodes, or off their plane."""
        return wrong_places(self.probes, self.fronts, self.cloud.holds, self.dimensions)

    def kind_of(self, face: str) -> str:
        """Kind of the boundary at a face of the box."""
        return self.boundaries[face].kind if face in self.boundaries else "periodic"

    @property
    def neighbour_count(self) -> int:
        """Neighbours of most nodes of a box; by default those of a whole block of a lattice."""
        return self.neighbours or (8 if self.dimensions == 2 else 18)

    @property
    def has_rings(self) -> bool:
        """Whether sums are those of whole rings about the axis x."""
        return self.axisymmetric or (self.moving is not None and self.moving.axisymmetric)

    @property
    def planar(self) -> bool:
        """Whether nothing depends on y, nor moves along it."""
        return self.dimensions == 2 and not self.axisymmetric

    @property
    def cloud(self) -> BoxCloud | SphereCloud | PlateCloud:
        """The table that describes the nodes."""
        cloud = self.box or self.sphere or self.plate
        assert cloud is not None
        return cloud

    @property
    def expected_count(self) -> int:
        """About how many nodes there will be."""
        bodies = self.moving.expected_count(self.dimensions) if self.moving is not None else 0
        return self.cloud.expected_count(self.dimensions) + bodies

    @property
    def expected_step(self) -> float:
        """Stable step [s] of the states at the start and at the boundary."""
        states = [self.initial, *(zone.state for zone in self.zones)]
        states += [boundary.state for boundary in self.boundaries.values()]
        if self.riemann is not None:
            states += [self.riemann.left, self.riemann.right]
        fastest = max(state.fastest(self.gas) for state in states if state is not None)
        finest = self.cloud.finest_spacing
        if self.moving is not None:
            finest = min(finest, self.moving.finest_spacing)
            fastest += max(math.hypot(*body.velocity) for body in self.moving.bodies)
        return 0.5 * self.courant * finest / fastest


def has_walls(params: MeshlessGasParams) -> bool:
    """Whether what walls feel is given: of bodies, and of walls that hold the gas."""
    no_slip = any(boundary.kind in NO_SLIP for boundary in params.boundaries.values())
    return params.box is None or no_slip
