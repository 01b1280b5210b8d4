"""Programs of a fluid: its laws, printed for the terms that a scene has, and loops over them."""

from pathlib import Path
from typing import TYPE_CHECKING

from quintet.components.shared.opencl import cells
from quintet.components.shared.opencl.kernels import kernels, named
from quintet.components.shared.opencl.prelude import Precision
from quintet.components.shared.opencl.program import Program
from quintet.components.shared.opencl.types import LANES
from quintet.components.shared.smoothing.smoothing import gradient, kernel
from quintet.components.sph_fluid.boundary.kernels import mirrored_density
from quintet.components.sph_fluid.integration.kernels import failed
from quintet.components.sph_fluid.laws import (
    PairLaw,
    add_pair_force,
    contact_factor,
    damped_pressure_term,
    diffusive_flux,
    inverses,
    pressure_term,
)

if TYPE_CHECKING:
    from quintet.components.sph_fluid.motion.laws import FrameForces

HERE = Path(__file__).parent
OF_ROWS = ("rows", "boundary", "films", "terms", "steps")
VECTOR = (0.0, 0.0, 0.0)
SIX, TEN = (0.0,) * 6, (0.0,) * 10


def rows_program(
    law: PairLaw,
    precision: Precision,
    lanes: int,
    forces: "FrameForces | None" = None,
    damps: bool = False,
    kernel_sources: str = "",
) -> str:
    """Sorting, searching, the boundary and steps: always in double precision.

    `precision` is that of the rates, of which steps are made; `forces` are those of a frame that
    moves; `damps` tells whether there are damping zones; `kernel_sources` has the
    kernels of further parts.
    """
    program, constants = Program("double", lanes), law.constants
    search = cells.source(program)
    fit = mirrored_density
    names = [
        f"#define LANES {lanes}",
        named(program, "pressure_term", pressure_term, 0.0, constants),
        named(program, "damped_pressure_term", damped_pressure_term, 0.0, 0.0, 0.0, constants),
        named(program, "kernel_of", kernel, 0.0, constants.smoothing),
        named(program, "failed", failed, 0.0, 0.0, 0.0),
        named(program, "kernel_in_lanes", kernel, LANES, constants.smoothing),
        named(program, "add_moment", fit.add_moments, TEN, 0.0, 0.0, 0.0, 0.0),
        named(program, "add_moments", fit.add_moments, (LANES,) * 10, *(LANES,) * 4),
        named(program, "mean_and_variance", fit.mean_and_variance, TEN),
        named(program, "solve", fit.solve, SIX, 0.0, 0.0, 0.0),
        named(program, "distance_to", fit.distance, VECTOR, 0.0, 0.0, 0.0),
        f"#define Moments {program.add(fit.mean_and_variance, TEN)[1].name}",
        f"#define NO_FLUID {fit.NO_FLUID!r}",
        f"#define BY_POTENTIAL ({fit.BY_POTENTIAL})",
        f"#define RATE4 {'double4' if precision == 'double' else 'float4'}",
    ]
    sources = [*OF_ROWS]
    if forces is not None:
        # Left out of scenes whose tank stands still.
        from quintet.components.sph_fluid.motion.laws import frame_acceleration

        of_frame = (VECTOR, VECTOR, VECTOR, forces)
        names += [
            named(program, "frame_acceleration", frame_acceleration, *of_frame),
            f"#define InFrame {program.add(frame_acceleration, *of_frame)[1].name}",
        ]
        sources.append("frame")
    if damps:
        # Left out of scenes without damping zones.
        from quintet.components.sph_fluid.waves.laws import damped_share, damping_strength

        place = (0.0, 0.0, 0.0, True)
        names += [
            named(program, "damping_strength", damping_strength, *place),
            named(program, "damped_share", damped_share, 0.0, 0.0, 0.0),
        ]
        sources.append("damping")
    shared, of_fluid = kernels("lanes", "gather"), kernels(*sources, folder=HERE)
    return "\n".join([program.text, *names, search, *shared, *of_fluid, kernel_sources])


def pairs_program(law: PairLaw, precision: Precision, lanes: int, apparent: bool = False) -> str:
    """Sums over pairs, of the terms of a pair law, in either precision.

    `apparent` tells whether the boundary has velocities of its own that viscosity sees.
    """
    program, constants = Program(precision, lanes), law.constants
    force = ((LANES,) * 3, (LANES,) * 3, (LANES,) * 3, (LANES,) * 3, *(LANES,) * 6)
    names = [
        f"#define LANES {lanes}",
        named(program, "inverses", inverses, LANES, LANES, constants),
        named(program, "gradient", gradient, LANES, LANES, constants.smoothing),
        named(program, "fluid_force", add_pair_force, *force, law.fluid),
        named(program, "boundary_force", add_pair_force, *force, law.boundary),
        f"#define FluidTerms {program.struct(law.fluid)}",
        f"#define BoundaryTerms {program.struct(law.boundary)}",
    ]
    if law.boundary.volume is not None:
        names.append("#define VOLUME")
    if law.boundary.contact.on is not None:
        factor = (LANES, LANES, law.boundary.contact, constants.smoothing)
        names += ["#define CONTACT", named(program, "contact_factor", contact_factor, *factor)]
    if law.boundary.contact.partial is not None:
        names.append("#define PARTIAL")
    if apparent:
        names.append("#define APPARENT")
    if law.damper is not None:
        names.append("#define DAMPER")
    if law.fluid.xsph is not None:
        weight = (LANES, constants.smoothing)
        names += ["#define XSPH", named(program, "kernel_of", kernel, *weight)]
    if law.fluid.diffusion.on is not None:
        flux = (*(LANES,) * 4, law.fluid.diffusion)
        names += ["#define DIFFUSION", named(program, "diffusive_flux", diffusive_flux, *flux)]
    return "\n".join([program.text, *names, *kernels("lanes"), *kernels("pairs", folder=HERE)])
