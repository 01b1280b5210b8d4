"""What a scene says about a gas."""

import math
from typing import Annotated, Literal

from pydantic import Field

from quintet.components.meshless_gas.clouds.params import Box
from quintet.interfaces.params import (
    NotNegative,
    Number,
    Positive,
    Vector,
    parameters,
)


@parameters
class Gas:
    """A perfect gas.

    Parameters
    ----------
    gamma : 1
        Ratio of the specific heats.
    gas_constant : J/(kg K)
        p = ρ R T.
    """

    gamma: Annotated[float, Field(gt=1, allow_inf_nan=False)] = 1.4
    gas_constant: Positive = 287.05


@parameters
class GasState:
    """A state of the gas.

    Parameters
    ----------
    density : kg/m3
        This or the temperature.
    temperature : K
        This or the density.
    velocity : m/s
        In two dimensions along x and z.
    pressure : Pa
        Of nothing it would have no temperature.
    """

    density: Positive | None = None
    temperature: Positive | None = None
    velocity: Vector = (0.0, 0.0, 0.0)
    pressure: Positive

    def __post_init__(self) -> None:
        if (self.density is None) == (self.temperature is None):
            raise ValueError("a state of the gas needs density or temperature, one of them.")

    def primitive(self, gas: Gas) -> tuple[float, float, float, float, float]:
        """Density, velocity and pressure."""
        density = self.density
        if density is None:
            assert self.temperature is not None
            density = self.pressure / (gas.gas_constant * self.temperature)
        return density, *self.velocity, self.pressure

    def fastest(self, gas: Gas) -> float:
        """Speed [m/s] of its fastest wave."""
        density, u, v, w, pressure = self.primitive(gas)
        return math.hypot(u, v, w) + math.sqrt(gas.gamma * pressure / density)


@parameters
class TotalState:
    """Gas at rest, from which an inflow comes without losses.

    Parameters
    ----------
    pressure : Pa
        At rest.
    temperature : K
        At rest.
    direction : 1
        Of the flow; of any length above 0.
    """

    pressure: Positive
    temperature: Positive
    direction: Vector = (1.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        if not any(self.direction):
            raise ValueError("total: direction must not be 0. Say where the gas flows.")


@parameters
class Boundary:
    """What is at a part of the boundary.

    Parameters
    ----------
    kind
        "periodic" and "symmetry" have images of what is within beyond them; a "slip" wall lets the
        gas pass along it; "inflow" has the state that is given, "outflow" that of the gas which
        leaves.
    state
        Of an inflow: all of it, as of what flows faster than sound.
    total
        Of an inflow, in place of the state: it then has the pressure of the gas that it meets.
    pressure : Pa
        Beyond an outflow, where it is slower than sound; if not given nothing comes from there.
    """

    kind: Literal["periodic", "symmetry", "slip", "inflow", "outflow"]
    state: GasState | None = None
    total: TotalState | None = None
    pressure: Positive | None = None

    def __post_init__(self) -> None:
        said = [one for one in ("state", "total", "pressure") if getattr(self, one) is not None]
        wrong = {
            "inflow": len(said) != 1 or "pressure" in said,
            "outflow": bool(set(said) - {"pressure"}),
        }
        if wrong.get(self.kind, bool(said)):
            need = {"inflow": "state or total", "outflow": "pressure or nothing"}
            raise ValueError(
                f"a boundary of kind {self.kind} takes {need.get(self.kind, 'nothing')}; found "
                f"{' and '.join(said) or 'nothing'}. Correct it."
            )


@parameters
class Zone:
    """A box in which the gas begins otherwise.

    Parameters
    ----------
    lowest, highest : m
        Its corners.
    state
        At the start.
    """

    lowest: Vector
    highest: Vector
    state: GasState


@parameters
class Riemann:
    """Two states on either side of a diaphragm across x that is taken away at the start.

    Its exact solution is known: the component then gives its error.

    Parameters
    ----------
    position : m
        Of the diaphragm.
    left, right
        States; their velocities are along x.
    """

    position: Number
    left: GasState
    right: GasState


@parameters
class Vortex:
    """An isentropic vortex about y that drifts with the initial state of the gas.

    Its exact solution is known: the component then gives its error. Shu, ICASE 97-65 (1997).

    Parameters
    ----------
    centre : m
        At the start; images are as far away as the box is wide.
    strength : m/s
        β: its greatest speed is β/2π, at one radius.
    radius : m
        Over which it fades as exp((1 - r²)/2).
    """

    centre: Vector
    strength: Positive
    radius: Positive = 1.0


@parameters
class MeshlessGasParams:
    """A gas on a cloud of nodes, and how it is computed.

    Parameters
    ----------
    gas
        Which gas.
    dimensions
        In 2 the gas lies in the plane of x and z, and is 1 m deep.
    box
        A box of nodes.
    boundaries
        What is at the faces of a box, ``x-`` to ``z+``; periodic where nothing is said.
    initial
        State at the start.
    zones
        Where it begins otherwise; later ones count.
    riemann
        In place of the initial state.
    vortex
        In the initial state.
    neighbours : 1
        Of each node; the nearest.
    order
        Of the scheme in space.
    limiter_threshold : 1
        Squares of differences below this share of the square of what they are differences of are
        not limited. Smooth flows are computed best with 1e-2.
    courant : 1
        Share of 1/Σ_j (|v·c_ij| + a |c_ij|) that a step takes.
    local_steps
        Whether each node takes the step that it bears, towards a steady flow: times are then those
        of the node of the shortest step.
    probes : m
        Places; of the node that is nearest to each the state is given.
    """

    gas: Gas = Gas()
    dimensions: Literal[2, 3] = 2
    box: Box
    boundaries: dict[str, Boundary] = Field(default_factory=dict)
    initial: GasState | None = None
    zones: tuple[Zone, ...] = ()
    riemann: Riemann | None = None
    vortex: Vortex | None = None
    neighbours: Annotated[int, Field(ge=2, le=64)] = 9
    order: Literal[1, 2] = 2
    limiter_threshold: NotNegative = 1e-6
    courant: Positive = 0.7
    local_steps: bool = False
    probes: tuple[Vector, ...] = ()

    def __post_init__(self) -> None:
        for sentence in (*self._wrong_states(), *self._wrong_faces()):
            raise ValueError(sentence)

    def _wrong_states(self) -> list[str]:
        """What does not fit among the states at the start."""
        found = []
        if (self.initial is None) == (self.riemann is None):
            found.append("the gas begins with initial or riemann, one of them. Correct it.")
        if self.riemann is not None and (self.vortex is not None or self.zones):
            found.append("riemann is all that the gas begins with: leave out vortex and zones.")
        if self.vortex is not None and self.initial is not None:
            share = (self.gas.gamma - 1.0) / (2.0 * self.gas.gamma) * math.e
            density, *_, pressure = self.initial.primitive(self.gas)
            coldest = 1.0 - share * density / pressure * (self.vortex.strength / math.tau) ** 2
            if coldest <= 0.0:
                found.append(
                    f"vortex: strength must leave gas in its middle; found "
                    f"{self.vortex.strength:g} m/s. Make it weaker, or the pressure higher."
                )
        return found

    def _wrong_faces(self) -> list[str]:
        """What does not fit among the faces of the box."""
        found, axes = [], ("xz" if self.dimensions == 2 else "xyz")
        names = [axis + side for axis in axes for side in "-+"]
        for name in self.boundaries:
            if name not in names:
                found.append(f"boundaries.{name} is not known. Known here: {', '.join(names)}.")
        for axis in axes:
            ends = [self.kind_of(axis + side) for side in "-+"]
            if ends.count("periodic") == 1:
                found.append(
                    f"boundaries: both faces across {axis} must be periodic or none; found "
                    f"{' and '.join(ends)}. Say the other."
                )
            k = "xyz".index(axis)
            length = self.box.highest[k] - self.box.lowest[k]
            if length < 2.0 * self.box.spacing:
                found.append(
                    f"box: along {axis} it must be two spacings long at least; found "
                    f"{length:g} m. Correct lowest and highest, or spacing."
                )
        return found

    def kind_of(self, face: str) -> str:
        """Kind of the boundary at a face of the box."""
        return self.boundaries[face].kind if face in self.boundaries else "periodic"

    @property
    def planar(self) -> bool:
        """Whether nothing depends on y, nor moves along it."""
        return self.dimensions == 2

    @property
    def expected_count(self) -> int:
        """About how many nodes there will be."""
        return self.box.expected_count(self.dimensions)

    @property
    def expected_step(self) -> float:
        """Step [s] that the states at the start and at the boundary bear."""
        states = [self.initial, *(zone.state for zone in self.zones)]
        states += [one.state for one in self.boundaries.values()]
        if self.riemann is not None:
            states += [self.riemann.left, self.riemann.right]
        fastest = max(one.fastest(self.gas) for one in states if one is not None)
        return 0.5 * self.courant * self.box.spacing / fastest
