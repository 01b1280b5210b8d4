"""Laws of friction and heat conduction, printed; only for a scene that has them."""

from quintet.components.meshless_gas.laws.transport import Transport, sutherland
from quintet.components.meshless_gas.opencl.printing import named
from quintet.components.meshless_gas.viscous import laws
from quintet.components.shared.opencl.program import Program
from quintet.components.shared.opencl.types import LANES

LAW = Transport(0.0, 0.0, 0.0, 0.0, 0.0)
VECTOR, STATE, VECTORS = (0.0,) * 3, (0.0,) * 5, (LANES,) * 3
GRADIENTS = (VECTORS,) * 5


def friction_laws(program: Program) -> list[str]:
    """Print the laws of friction, and the names of their structs."""
    number = 0.0
    structs = {
        "Transport": LAW, "Vectors": VECTORS, "Gradients": GRADIENTS, "Traction": (number,) * 4,
    }  # fmt: skip
    named_structs = {name: program.struct(example) for name, example in structs.items()}
    pair = (VECTORS, VECTORS, GRADIENTS, GRADIENTS, VECTORS, VECTORS, LANES, VECTORS, LANES)
    return [
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
