"""Programs of bodies of particles: their laws, printed for a scene, and loops over them."""

from pathlib import Path

from quintet.components.shared.materials.equation_of_state import (
    place_in_table,
    temperature_between,
)
from quintet.components.shared.materials.solid import Solid
from quintet.components.shared.opencl import cells
from quintet.components.shared.opencl.kernels import kernels, named
from quintet.components.shared.opencl.program import Program
from quintet.components.shared.opencl.types import LANES
from quintet.components.shared.smoothing.smoothing import gradient
from quintet.components.sph_solid.kernels import point as laws
from quintet.components.sph_solid.kernels.motion import meets
from quintet.components.sph_solid.kernels.sums import corrected
from quintet.components.sph_solid.laws import (
    PairLaw,
    add_force,
    add_moments,
    add_outer,
    inverses,
    repelled,
    stable_step,
    viscous_pressure,
)
from quintet.components.sph_solid.neighbours import WIDER

HERE = Path(__file__).parent
TWO, THREE, NINE = ((0.0,) * count for count in (2, 3, 9))
SIX = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


def has_nine(law: PairLaw, keeps: bool) -> bool:
    """Whether the tensors of particles have nine numbers, and not the six of symmetric ones."""
    return keeps or law.corrected is not None


def width(law: PairLaw, keeps: bool) -> int:
    """How many rows of four numbers the stress of a particle has."""
    if law.artificial is not None:
        return 4
    return 3 if has_nine(law, keeps) else 2


def source(law: PairLaw, solid: Solid, lanes: int, rings: bool = False, keeps: bool = False) -> str:
    """All kernels of a step, in double precision.

    Parameters
    ----------
    law : PairLaw
    solid : Solid
        Law of any of the materials.
    lanes : int
        How many pairs are summed at once.
    rings : bool
        Whether the bodies are axisymmetric.
    keeps : bool
        Whether neighbours are those of the start.
    """
    program = Program("double", lanes)
    search = cells.source(program)
    names = [
        f"#define LANES {lanes}",
        f"#define WIDTH {width(law, keeps)}",
        *(["#define NINE_NUMBERS"] if has_nine(law, keeps) else []),
        *(["#define CORRECTED"] if law.corrected is not None else []),
        *_of_pairs(program, law),
        *(_of_start(program, law) if keeps else []),
        *(_of_tension(program, law) if law.artificial is not None else []),
        *_of_points(program, solid._replace(isentrope=None)),  # type: ignore[arg-type]
        *(_of_rings(program) if rings else []),
        named(program, "meets", meets, THREE, THREE, 0.0, 0.0),
    ]
    shared = kernels("lanes", "gather", "sums")
    sums = ("reference", "touching") if keeps else ("pairs", "rings") if rings else ("pairs",)
    of_solid = kernels("rows", "images", "motion", "material", *sums, folder=HERE)
    return "\n".join([program.text, *names, search, *shared, *of_solid])


def _of_pairs(program: Program, law: PairLaw) -> list[str]:
    """Laws of a pair, each for several neighbours at once, and of their sums."""
    four, vector, matrix = (LANES,) * 4, (LANES,) * 3, (LANES,) * 9
    force = (four, vector, vector, LANES, LANES, matrix, LANES, vector, law)
    return [
        f"#define PairLaw {program.struct(law)}",
        named(program, "gradient", gradient, LANES, LANES, law.smoothing),
        named(program, "inverses", inverses, LANES, LANES, law),
        named(program, "viscous_pressure", viscous_pressure, *(LANES,) * 4, law),
        named(program, "add_outer", add_outer, matrix, vector, vector),
        named(program, "add_moments", add_moments, (LANES,) * 6, vector, vector),
        named(program, "add_force", add_force, *force),
        named(program, "stable_step", stable_step, 0.0, 0.0, law),
        named(program, "corrected", corrected, NINE, SIX, True, law, returns="Corrected"),
    ]


def _of_points(program: Program, solid: Solid) -> list[str]:
    """Laws of one particle's material."""
    point = laws.Point(SIX, *(0.0,) * 7)
    rate = NINE, NINE, 0.0
    return [
        f"#define Solid {program.struct(solid)}",
        f"#define Point {program.struct(point)}",
        named(program, "trace_of", laws.trace_of, NINE),
        named(program, "corrected_scales", laws.corrected_scales, 0.0, 0.0, 0.0),
        named(program, "plain_scales", laws.plain_scales, 0.0, 0.0, 0.0),
        named(program, "rates", laws.rates, NINE, TWO, 0.0, 0.0, returns="Rates"),
        named(program, "advanced", laws.advanced, point, rate, 0.0, 0.0, solid),
        named(program, "stretch_of_heat", laws.stretch_of_heat, 0.0, 0.0),
        named(program, "place_in_table", place_in_table, 0.0, 0, solid, returns="InTable"),
        named(program, "temperature_between", temperature_between, *(0.0,) * 3, TWO, TWO, solid),
        named(program, "sound_speed", laws.sound_speed, point, solid),
        named(program, "divided_stress", laws.divided_stress, SIX, 0.0, 0.0),
        named(program, "corrected_stress", laws.corrected_stress, SIX, 0.0, SIX),
    ]


def _of_start(program: Program, law: PairLaw) -> list[str]:
    """Laws of neighbours of the start, and of contact."""
    # Left out of scenes whose neighbours change.
    from quintet.components.sph_solid.kernels import reference_laws as start
    from quintet.components.sph_solid.kernels import touching

    lanes, of_two = (LANES,) * 3, (0.0, 0.0)
    push = (*(LANES,) * 7, 0.0, law)
    return [
        "#define REFERENCE",
        named(program, "deformation", start.deformation, NINE, SIX, law, returns="Deformation"),
        named(program, "rate_of_deformation", start.rate_of_deformation, NINE, SIX, NINE),
        named(program, "nominal_stress", start.nominal_stress, SIX, 0.0, NINE, SIX),
        named(program, "along", start.along, (LANES,) * 9, lanes),
        named(program, "approach", start.approach, LANES, LANES, law),
        named(program, "push_less_drag", start.push_less_drag, *push),
        named(program, "is_touching", touching.is_touching, *of_two),
        named(program, "stiffness", touching.stiffness, *of_two),
        named(program, "contact_force", touching.contact_force, THREE, *(0.0,) * 4),
        named(program, "plane_force", touching.plane_force, *(0.0,) * 3),
    ]


def _of_tension(program: Program, law: PairLaw) -> list[str]:
    """Laws of the artificial stress."""
    six, offset = (LANES,) * 6, (LANES,) * 3
    return [
        f"#define ARTIFICIAL {law.artificial!r}",
        named(program, "artificial_stress", laws.artificial_stress, SIX, 0.0),
        named(program, "repelled", repelled, six, offset, LANES, law),
    ]


def _of_rings(program: Program) -> list[str]:
    """Laws of azimuthal images."""
    # Left out of scenes without rings.
    from quintet.components.sph_solid.kernels import azimuthal_images as images

    of_pair = (0, True, 0)
    return [
        "#define RINGS",
        f"#define WIDER {WIDER!r}",
        named(program, "turns_of_pair", images.turns_of_pair, *of_pair, returns="Turns"),
        named(program, "turned_square", images.turned_square, *(0.0,) * 4),
        named(program, "turned_vector", images.turned_vector, *(LANES,) * 4),
        named(program, "turned_six", images.turned_six, *(LANES,) * 6),
        named(program, "turned_nine", images.turned_nine, *(LANES,) * 7),
    ]
