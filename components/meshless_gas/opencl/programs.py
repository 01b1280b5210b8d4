"""The program of a gas: its laws, printed for what a scene asks for, and loops over nodes."""

from pathlib import Path
from typing import NamedTuple

from quintet.components.meshless_gas.laws import boundaries, fluxes, outflows, states
from quintet.components.meshless_gas.laws.limiters import Limiter
from quintet.components.meshless_gas.opencl.printing import named
from quintet.components.shared.opencl.arrays import GROUP
from quintet.components.shared.opencl.program import Program
from quintet.components.shared.opencl.types import LANES

HERE = Path(__file__).parent
VECTOR, STATE, STATES = (0.0,) * 3, (0.0,) * 5, (LANES,) * 5
PATCH = (0.0,) * boundaries.PATCH_COLUMNS
SOURCES = ("rows", "lanes", "gradients", "fluxes", "boundaries", "stages")


class Physics(NamedTuple):
    """Optional physics of a scene; the laws of physics that it lacks are not printed."""

    planar: bool  # whether y is left out
    sloped: bool  # whether the scheme is of second order
    viscous: bool = False
    slides: bool = False  # whether a rarefied gas slides along walls
    moves: bool = False  # whether bodies carry clouds
    has_axis: bool = False  # whether these lie about an axis of symmetry
    is_shared: bool = False  # whether several ranks share the nodes out


def gas_program(limiter: Limiter, physics: Physics, lanes: int, by_rows: bool) -> str:
    """Print the laws and loops of a gas.

    Parameters
    ----------
    limiter : Limiter
    physics : Physics
    lanes : int
        Nodes whose fluxes are computed side by side.
    by_rows : bool
        How tables are stored, as in `Tables`.
    """
    program = Program("double", lanes)
    macros = {"PLANAR": physics.planar, "SLOPED": physics.sloped, "MOVING": physics.moves,
              "RAREFIED": physics.slides}  # fmt: skip
    names = [
        f"#define GROUP {GROUP}", f"#define LANES {lanes}", f"#define BY_ROWS {int(by_rows)}",
        f"#define BACK_PRESSURE {boundaries.BACK_PRESSURE}",
        *(f"#define {name}" for name, is_on in macros.items() if is_on),
        *_structs(program, limiter), *_laws(program, limiter),
    ]  # fmt: skip
    sources = [*SOURCES]
    if physics.viscous:
        # Left out of scenes without friction.
        from quintet.components.meshless_gas.opencl.friction_program import friction_laws

        names += friction_laws(program, physics.slides)
        sources += ["friction", "tractions", *(["slip"] if physics.slides else []), "wall_flows"]
    if physics.moves:
        # Left out of scenes without bodies that carry clouds.
        from quintet.components.meshless_gas.opencl.bodies_program import (
            bodies_laws,
            bodies_sources,
        )

        names += bodies_laws(program, physics.viscous, physics.has_axis)
        sources += bodies_sources(physics.viscous, physics.has_axis)
    if physics.moves or physics.is_shared:
        sources.append("changed_rows")
    texts = [(HERE / f"{name}.cl").read_text() for name in sources]
    return "\n".join([program.text, *names, *texts])


def _structs(program: Program, limiter: Limiter) -> list[str]:
    """Names of structs in kernels."""
    structs = {
        "Vector": VECTOR, "State": STATE, "Patch": PATCH, "TwoStates": (STATE, STATE),
        "Limiter": limiter, "PairOfLanes": (LANES,) * 2, "Thresholds": (LANES,) * 3,
        "Directions": (LANES,) * 4, "States": STATES,
    }  # fmt: skip
    named_structs = {name: program.struct(example) for name, example in structs.items()}
    return [f"#define {name} {struct}" for name, struct in named_structs.items() if name != struct]


def _laws(program: Program, limiter: Limiter) -> list[str]:
    """Print the laws that kernels call."""
    number = 0.0
    return [
        named(program, fluxes.pair_direction, *(LANES,) * 3),
        named(program, fluxes.kept_share, STATES, STATES, (LANES,) * 4, LANES, LANES),
        named(program, fluxes.thresholds, STATES, STATES, limiter),
        named(program, fluxes.half_steps, limiter, *(LANES,) * 4),
        named(program, fluxes.positive_share, LANES, STATES, STATES, *((LANES,) * 2,) * 2),
        named(program, fluxes.sides, *(LANES,) * 3, (LANES,) * 2),
        named(program, fluxes.pair_rates, *(STATES,) * 3, (LANES,) * 4, LANES, number),
        named(program, boundaries.boundary_state, 0, STATE, PATCH, VECTOR, VECTOR, number, number),
        named(program, boundaries.boundary_flow, STATE, VECTOR, number),
        named(program, boundaries.held_along, STATE, STATE, VECTOR),
        named(program, outflows.outward_speed, STATE, VECTOR),
        named(program, outflows.roughness, number, 0, number, number),
        named(program, outflows.continued, STATE, *(number,) * 2, VECTOR, *(STATE,) * 3, number),
        named(program, states.sound_speed, *VECTOR),
        named(program, states.staged, *(number,) * 6),
        named(program, states.primitive_state, *(number,) * 6),
        named(program, states.is_state, number, number),
        named(program, states.change_square, *VECTOR),
        named(program, states.crossing_rate, VECTOR, VECTOR, VECTOR, number, number),
    ]
