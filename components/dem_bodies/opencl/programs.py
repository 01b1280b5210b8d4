"""The program of spheres: what happens at one and at a pair, printed, and loops over rows."""

from pathlib import Path

from quintet.components.dem_bodies.kernels.ball_laws import (
    drifted,
    from_plane,
    half_kick,
    kinematics,
    relative_depth,
)
from quintet.components.dem_bodies.kernels.geometry import FAR
from quintet.components.dem_bodies.kernels.rolling_resistance import (
    inverse_surface_inertia,
    resistance,
)
from quintet.components.dem_bodies.laws import (
    LEAST,
    contact_force,
    damping_weight,
    pair_constants,
)
from quintet.components.shared.opencl.arrays import GROUP
from quintet.components.shared.opencl.kernels import kernels, named
from quintet.components.shared.opencl.program import Program
from quintet.components.shared.opencl.types import LANES
from quintet.components.shared.rotations import cross, dot
from quintet.components.shared.search.cells import LAYER, ROW, key_of

HERE = Path(__file__).parent
VECTOR, TURN = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0)
# Pairs that a work item of a processor computes together (SIMD lanes); 1 on other devices.
LANES_OF_PROCESSORS = 4
WIDTH = 3  # vectors of four numbers of a pair's constants
# Columns of the numbers that kernels reduce over all rows or pairs: sums first, then maxima.
# Works [J]; square of the way since pairs were listed [m²], and whether an orientation is not
# finite.
DRIFT_SUMS, DRIFT = 2, ("WORK", "LOAD_WORK", "TRAVEL", "BROKEN")
# Overlap [m], that over the smaller radius, and S_n/m* [(rad/s)²].
PAIR_SUMS, PAIRS = 0, ("OVERLAP", "RELATIVE", "STIFFNESS")
# Works, the load on the ground, and elastic energy [J] of the pairs of rows; what moves fast, as
# in `state.py`; contacts of a row.
GROUND = 2
KICK_SUMS = 9
KICK = (
    "WORK", "LOAD_WORK", *("",) * 6, "ENERGY", "VELOCITY2", "ROTATION2", "CENTRIPETAL",
    "ACCELERATION2", "SPIN_UP2", "CONTACTS",
)  # fmt: skip


def source(rolls: bool, lanes: int) -> str:
    """All kernels of a step, in double precision.

    `rolls` is whether any pair resists rolling; so many pairs are computed at once.
    """
    program = Program("double", lanes)
    numbers = {
        "GROUP": GROUP, "LANES": lanes, "WIDTH": WIDTH, "LEAST": repr(LEAST), "FAR": repr(FAR),
        "DRIFT_SUMS": DRIFT_SUMS, "DRIFT_COLUMNS": len(DRIFT), "PAIR_SUMS": PAIR_SUMS,
        "PAIR_COLUMNS": len(PAIRS), "KICK_SUMS": KICK_SUMS, "KICK_COLUMNS": len(KICK),
        "GROUND": GROUND,
        "LAYER": f"{LAYER}L", "ROW_OF_CELLS": f"{ROW}L",
    }  # fmt: skip
    for columns in (DRIFT, PAIRS, KICK):
        numbers |= {name: number for number, name in enumerate(columns) if name}
    defined = [f"#define {name} {number}" for name, number in numbers.items()]
    laws = [*_of_balls(program), *_of_pairs(program), *_of_lists(program)]
    laws += _of_rolling(program) if rolls else []
    names = ("tallies", "rows", "pairs", "search", *(("rolling",) if rolls else ()))
    return "\n".join([program.text, *defined, *laws, *kernels(*names, folder=HERE)])


def _of_balls(program: Program) -> list[str]:
    """What happens at one ball."""
    half_kicked = (*(VECTOR,) * 3, *(0.0,) * 3, *(VECTOR,) * 4)
    moving = (VECTOR, TURN, *(VECTOR,) * 4, 0.0)
    return [
        named(program, "half_kick", half_kick, *half_kicked, returns="Kicked"),
        named(program, "drifted", drifted, *moving, returns="Drifted"),
        named(program, "from_plane", from_plane, VECTOR, 0.0, VECTOR, 0.0),
        named(program, "inner", dot, VECTOR, VECTOR),
        named(program, "cross_of", cross, VECTOR, VECTOR),
    ]


def _of_pairs(program: Program) -> list[str]:
    """What happens at several pairs at once."""
    vector = (LANES,) * 3
    met = (vector, LANES, LANES, *(vector,) * 6)
    touching = (
        (LANES,) * 7, vector, LANES, vector, LANES, vector, LANES, vector, vector, 0.0
    )  # fmt: skip
    return [
        named(program, "kinematics", kinematics, *met, returns="Kinematics"),
        named(program, "contact_force", contact_force, *touching, returns="Acting"),
        named(program, "damping_weight", damping_weight, *(0.0,) * 4),
        named(program, "relative_depth", relative_depth, *(LANES,) * 3),
        named(program, "inner_of_lanes", dot, vector, vector),
        named(program, "cross_of_lanes", cross, vector, vector),
    ]


def _of_lists(program: Program) -> list[str]:
    """Cells of balls, and constants of new pairs."""
    return [
        named(program, "key_of", key_of, *(0.0,) * 4),
        named(program, "pair_constants", pair_constants, *(0.0,) * 6, returns="Constants"),
    ]


def _of_rolling(program: Program) -> list[str]:
    """Resistance against rolling."""
    rolling = (VECTOR, VECTOR, *(0.0,) * 4, *(VECTOR,) * 3, 0.0)
    return [
        "#define ROLLS",
        named(program, "resistance", resistance, *rolling, returns="Resisting"),
        named(program, "inverse_inertia", inverse_surface_inertia, *(0.0,) * 3),
    ]
