"""Laws and loops of bodies with clouds of their own; only for a scene that has them."""

from quintet.components.meshless_gas.laws.fluxes import in_laboratory
from quintet.components.meshless_gas.moving import laws
from quintet.components.meshless_gas.opencl.printing import named
from quintet.components.shared.opencl.program import Program
from quintet.components.shared.opencl.types import LANES

VECTOR, STATE, STATES = (0.0,) * 3, (0.0,) * 5, (LANES,) * 5


def bodies_sources(is_viscous: bool, has_axis: bool) -> list[str]:
    """Names of files with loops."""
    return [
        "bodies", *(["held_bodies"] if is_viscous else []),
        *(["axis"] if has_axis else []), *(["axis_stresses"] if has_axis and is_viscous else []),
    ]  # fmt: skip


def bodies_laws(program: Program, is_viscous: bool, has_axis: bool) -> list[str]:
    """Print the laws of bodies' walls, of frames that move, and of an axis of symmetry."""
    number = 0.0
    names = [
        named(program, in_laboratory, STATES, *(LANES,) * 3),
        named(program, laws.slip_wall_state, STATE, STATE, number, number, VECTOR, VECTOR, number),
    ]
    if is_viscous:
        names.append(named(program, laws.level_temperature, *(number,) * 4))
    return names + (axis_laws(program, is_viscous) if has_axis else [])


def axis_laws(program: Program, is_viscous: bool) -> list[str]:
    """Print the laws of an axis of symmetry."""
    # Left out of scenes without such an axis.
    from quintet.components.meshless_gas.axis import laws as axis

    number, pair = 0.0, (0.0, 0.0)
    names = [
        f"#define Rates {program.struct((number,) * 4)}",
        named(program, axis.axis_rates, *(number,) * 6),
    ]
    if not is_viscous:
        return names
    return [
        *names,
        f"#define Slopes {program.struct(pair)}",
        named(program, axis.swelling_stress, *(number,) * 3),
        named(program, axis.axis_stresses, *(number,) * 8, pair, pair, number),
    ]
