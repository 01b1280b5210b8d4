"""Laws of friction and heat conduction, printed; only for a scene that has them."""

from quintet.components.meshless_gas.laws.transport import Transport, sutherland
from quintet.components.meshless_gas.opencl.printing import named
from quintet.components.meshless_gas.viscous import laws
from quintet.components.shared.opencl.program import Program
from quintet.components.shared.opencl.types import LANES

LAW = Transport(0.0, 0.0, 0.0, 0.0, 0.0)
VECTOR, STATE, VECTORS = (0.0,) * 3, (0.0,) * 5, (LANES,) * 3
GRADIENTS = (VECTORS,) * 5


def friction_laws(program: Program, slides: bool) -> list[str]:
    """Print the laws of friction, also of a gas that slides, and the names of their structs."""
    number = 0.0
    structs = {
        "Transport": LAW, "Vectors": VECTORS, "Gradients": GRADIENTS, "Traction": (number,) * 4,
    }  # fmt: skip
    named_structs = {name: program.struct(example) for name, example in structs.items()}
    pair = (VECTORS, VECTORS, GRADIENTS, GRADIENTS, VECTORS, VECTORS, LANES, VECTORS, LANES)
    names = [
        *(f"#define {name} {text}" for name, text in named_structs.items() if name != text),
        named(program, sutherland, number, LAW),
        named(program, laws.gas_temperature, number, number, number),
        named(program, laws.pair_transfer, *pair, VECTORS, LANES, LAW),
        named(program, laws.own_transfer, VECTORS, GRADIENTS, VECTORS, VECTORS, LANES, LAW),
        named(program, laws.diffusion_rate, *(number,) * 4, LAW),
        named(program, laws.wall_state, *(number,) * 3, VECTOR, number, number, LAW),
        named(
            program, laws.wall_traction, STATE, STATE, STATE, number, number, VECTOR, VECTOR, LAW
        ),
    ]
    return names + (slip_laws(program) if slides else [])


def slip_laws(program: Program) -> list[str]:
    """Print the laws of a rarefied gas at walls."""
    # Left out of scenes without accommodation coefficients.
    from quintet.components.meshless_gas.viscous.kernels import slip_laws as slip

    number, pair, above = 0.0, (0.0, 0.0), (STATE, STATE, VECTOR, VECTOR, VECTOR)
    return [
        f"#define Shares {program.struct(VECTOR)}",
        f"#define Pair {program.struct(pair)}",
        named(program, laws.slope_shares, number, number),
        named(program, slip.temperature_at_wall, number, *above, number, pair, number, LAW),
        named(program, slip.velocity_at_wall, STATE, *above, VECTOR, number, number, LAW),
        named(program, slip.spread, *(VECTOR,) * 3),
        named(program, slip.slip_traction, STATE, *above, number, number, LAW),
    ]
