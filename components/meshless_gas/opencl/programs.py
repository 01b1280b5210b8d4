"""The program of a gas: its laws, printed for what a scene asks for, and loops over nodes."""

from pathlib import Path

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


def gas_program(
    limiter: Limiter, planar: bool, sloped: bool, viscous: bool, lanes: int, by_rows: bool
) -> str:
    """Print the laws and loops of a gas.

    Parameters
    ----------
    limiter : Limiter
    planar : bool
        Whether y is left out.
    sloped : bool
        Whether the scheme is of second order.
    viscous : bool
    lanes : int
        Nodes whose fluxes are computed side by side.
    by_rows : bool
        How tables are stored, as in `Tables`.
    """
    program = Program("double", lanes)
    names = [
        f"#define GROUP {GROUP}", f"#define LANES {lanes}", f"#define BY_ROWS {int(by_rows)}",
        f"#define BACK_PRESSURE {boundaries.BACK_PRESSURE}",
        *(["#define PLANAR"] if planar else []), *(["#define SLOPED"] if sloped else []),
        *_structs(program, limiter), *_laws(program, limiter),
    ]  # fmt: skip
    sources = [*SOURCES]
    if viscous:
        # Left out of scenes without friction.
        from quintet.components.meshless_gas.opencl.friction_program import friction_laws

        names += friction_laws(program)
        sources.append("friction")
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
