"""The parts of a fluid that its parameters ask for, made.

All imports are made where they are asked for: a scene imports, and compiles, nothing of what it
leaves out.
"""

from functools import partial
from typing import TYPE_CHECKING, Protocol

from quintet.components.shared.search.neighbours import Lists
from quintet.components.shared.threads import Team
from quintet.components.sph_fluid.boundary.method import (
    BoundaryMethod,
    Films,
    MakeFilmRows,
    NoFilms,
)
from quintet.components.sph_fluid.boundary.no_pistons import NoPistons, Pistons
from quintet.components.sph_fluid.boundary.samples import Samples
from quintet.components.sph_fluid.boundary.symmetry_planes import NoSymmetry, SymmetryPlanes
from quintet.components.sph_fluid.integration.method import Integration
from quintet.components.sph_fluid.motion.frame import Frame, StillFrame
from quintet.components.sph_fluid.open_boundaries.method import NoOpenBoundaries, OpenBoundaries
from quintet.components.sph_fluid.pairs.precision import DoublePrecision, Precision
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.ranks.method import Ranks
from quintet.components.sph_fluid.ranks.one import OneRank
from quintet.components.sph_fluid.state import Array, State
from quintet.components.sph_fluid.waves.no_damping import Damping, NoDamping
from quintet.interfaces.component import Resources

if TYPE_CHECKING:
    from quintet.components.sph_fluid.boundary.contact_potential import ContactStiffness
    from quintet.components.sph_fluid.boundary.lubrication import LubricationFilms
    from quintet.components.sph_fluid.gauges.gauges import Gauges
    from quintet.components.sph_fluid.pairs.shepard_filter import ShepardFilter
    from quintet.components.sph_fluid.waves.absorption import Absorber


class PressurePart(Protocol):
    """What writes pressures before a pass over pairs."""

    reads_images: bool  # whether it reads more than the rows that it writes

    def write_pressure(self, state: State, lists: Lists, team: Team) -> None:
        """Write p/ρ² of some rows of the state."""


def frame(params: SphFluidParams, ranks: Ranks) -> Frame:
    """The frame that the fluid is computed in."""
    if params.boundary.motion is None:
        return StillFrame(params)
    # Left out of scenes whose tank stands still.
    from quintet.components.sph_fluid.motion.moving_frame import MovingFrame

    return MovingFrame(params, params.boundary.motion, ranks)


def boundary_method(params: SphFluidParams, samples: Samples, frame: Frame) -> BoundaryMethod:
    """How walls and samples act."""
    if params.boundary.method == "mdbc":
        # Mirrored walls are left out of scenes with other boundaries.
        from quintet.components.sph_fluid.boundary.mirrored import MirroredBoundary

        return MirroredBoundary(params, samples, partial(contact_stiffness, params), frame)
    if params.boundary.method == "potential":
        # The contact potential is left out of scenes with other boundaries.
        from quintet.components.sph_fluid.boundary.potential import PotentialBoundary

        return PotentialBoundary(params, samples)
    # Dynamic walls are left out of scenes with other boundaries.
    from quintet.components.sph_fluid.boundary.dynamic import DynamicBoundary

    return DynamicBoundary(samples)


def pistons(
    params: SphFluidParams, samples: Samples, ranks: Ranks, symmetry: SymmetryPlanes
) -> Pistons:
    """Parts of the boundary that move by themselves."""
    if not params.boundary.pistons:
        return NoPistons()
    # Left out of scenes without pistons.
    from quintet.components.sph_fluid.boundary.pistons import MovingPistons
    from quintet.components.sph_fluid.build import wall_density

    density_at = partial(wall_density, params=params)
    return MovingPistons(params, samples, ranks, density_at, absorbers(params, symmetry, ranks))


def absorbers(
    params: SphFluidParams, symmetry: SymmetryPlanes, ranks: Ranks
) -> "dict[int, Absorber]":
    """What corrects the motion of pistons that take in waves, by their number."""
    numbers = [n for n, piston in enumerate(params.boundary.pistons) if piston.absorbs]
    if not numbers:
        return {}
    # Left out of scenes whose pistons send waves back.
    from quintet.components.sph_fluid.waves.absorption import Absorber

    return {number: Absorber(params, symmetry, ranks, number) for number in numbers}


def damping(params: SphFluidParams, ranks: Ranks) -> Damping:
    """Zones in which the fluid's motion is damped."""
    if not params.boundary.damping:
        return NoDamping()
    # Left out of scenes without damping zones.
    from quintet.components.sph_fluid.waves.damping import DampingZones

    return DampingZones(params, ranks)


def contact_stiffness(params: SphFluidParams) -> "ContactStiffness":
    """The contact potential, for samples of mirrored walls that links choose it for."""
    # Left out of scenes in which no link asks for it.
    from quintet.components.sph_fluid.boundary.contact_potential import ContactStiffness

    return ContactStiffness(params)


def ranks(params: SphFluidParams, resources: Resources) -> tuple[Ranks, SymmetryPlanes]:
    """The ranks that share the fluid, and its planes of symmetry, with copies of others' rows."""
    communicator = resources.communicator
    if communicator is None or communicator.size == 1:
        return OneRank(), symmetry_planes(params)
    # Only a fluid of several ranks loads mpi4py.
    from quintet.components.shared.symmetry import Plane
    from quintet.components.sph_fluid.ranks.halo import HaloAndImages
    from quintet.components.sph_fluid.ranks.refusal import refuse_what_needs_one_rank
    from quintet.components.sph_fluid.ranks.several import Keys, SeveralRanks

    refuse_what_needs_one_rank(params, communicator.size)
    keys, edge = Keys(), params.boundary
    planes = [Plane.of_face(face, edge.tank) for face in sorted(set(edge.symmetry)) if edge.tank]
    return (
        SeveralRanks(communicator, keys),
        HaloAndImages(communicator, keys, planes),
    )


def symmetry_planes(params: SphFluidParams) -> SymmetryPlanes:
    """Planes of symmetry, or axes along which the tank repeats, if there are any."""
    if params.boundary.periodic:
        # Left out of scenes whose tank does not repeat.
        from quintet.components.sph_fluid.open_boundaries.periodic import PeriodicImages

        return PeriodicImages(params)
    if not params.boundary.symmetry:
        return NoSymmetry()
    # Left out of scenes without planes of symmetry.
    from quintet.components.sph_fluid.boundary.symmetry import Symmetry

    return Symmetry(params)


def open_boundaries(params: SphFluidParams) -> OpenBoundaries:
    """Faces through which fluid comes and goes, if there are any."""
    if not (params.boundary.inflow or params.boundary.outflow):
        return NoOpenBoundaries()
    # Left out of scenes whose fluid neither comes nor goes.
    from quintet.components.sph_fluid.open_boundaries.flow import Flow

    return Flow(params)


def lubrication_films(
    params: SphFluidParams, samples: Samples, ranks: Ranks, make_rows: MakeFilmRows | None = None
) -> Films:
    """Films in narrow gaps: from the start, where they are needed, or never.

    `make_rows` makes the rows that they lie between, where those are not in the host's state.
    """
    if (
        params.boundary.pistons and not (samples.body >= 0.0).any()
    ):  # numbers of pistons are negative
        return NoFilms()
    make = partial(make_films, params, samples, ranks, make_rows)
    if params.boundary.lubrication_films == "auto":
        # Left out of scenes that say whether they want films.
        from quintet.components.sph_fluid.boundary.selective_films import SelectiveFilms

        return SelectiveFilms(params, samples, ranks, make)
    return make() if params.boundary.lubrication_films else NoFilms()


def refuse_misplaced(params: SphFluidParams, body: Array, position: Array) -> None:
    """Refuse bodies, by the places (n, 3) m of their samples, in the water or beyond the tank."""
    # Left out of scenes without bodies.
    from quintet.components.sph_fluid.setup.body_places import TOUCH, Room, refuse_misplaced

    edge = params.boundary
    room = Room(
        edge.tank,
        (*params.closed_faces, *edge.symmetry),
        () if params.remove_inside_bodies else params.boxes,
        edge.solids,
        (0, 2) if params.dimensions == 2 else (0, 1, 2),
    )
    refuse_misplaced(body, position, (TOUCH - edge.sample_depth) * params.spacing, room)


def remove_inside_bodies(
    state: State, samples: Samples, position: Array, params: SphFluidParams
) -> list[str]:
    """Remove fluid inside bodies with samples at places (n, 3) m; say how much."""
    # Left out of scenes whose fluid has room for the bodies.
    from quintet.components.sph_fluid.boundary.removal import remove

    return remove(state, samples, position, params)


def make_films(
    params: SphFluidParams, samples: Samples, ranks: Ranks, make_rows: MakeFilmRows | None
) -> "LubricationFilms":
    """Films in narrow gaps."""
    # Left out of scenes without films.
    from quintet.components.sph_fluid.boundary.lubrication import LubricationFilms

    return LubricationFilms(params, samples, ranks, make_rows)


def pressure_parts(params: SphFluidParams, boundary: BoundaryMethod) -> list[PressurePart]:
    """What writes pressures before a pass over pairs, in order: the boundary, and a damper."""
    if params.acoustic_damper == 0.0:
        return [boundary]
    # Left out of scenes without a damper.
    from quintet.components.sph_fluid.pairs.acoustic_damper import AcousticDamper, MirroredDamper

    walls = [MirroredDamper(params, boundary)] if params.mirrored else []
    return [boundary, AcousticDamper(params, boundary), *walls]


def courant_limit(params: SphFluidParams) -> float:
    """Greatest step over the time that sound takes through a smoothing length."""
    if params.acoustic_damper == 0.0:
        return params.courant
    # Left out of scenes without a damper.
    from quintet.components.sph_fluid.pairs.acoustic_damper import courant_limit as damped_limit

    return min(params.courant, damped_limit(params.acoustic_damper, params.kernel))


def shepard_filter(params: SphFluidParams) -> "ShepardFilter | None":
    """A filter of the density."""
    if not params.shepard_every:
        return None
    # Left out of scenes without a filter.
    from quintet.components.sph_fluid.pairs.shepard_filter import ShepardFilter

    return ShepardFilter(params)


def precision(params: SphFluidParams, ranks: Ranks) -> Precision:
    """In which precision pairs are computed."""
    if params.precision == "float64":
        return DoublePrecision()
    # Left out of scenes in double precision.
    from quintet.components.sph_fluid.pairs.single_precision import SinglePrecision

    return SinglePrecision(ranks)


def integration(params: SphFluidParams) -> Integration:
    """The scheme in time."""
    if params.integration == "symplectic":
        # Left out of scenes with the other scheme.
        from quintet.components.sph_fluid.integration.position_verlet import PositionVerlet

        return PositionVerlet(params)
    # Left out of scenes with the other scheme.
    from quintet.components.sph_fluid.integration.extrapolated import Extrapolated

    return Extrapolated(params)


def gauges(
    params: SphFluidParams, symmetry: SymmetryPlanes, ranks: Ranks, frame: Frame
) -> "Gauges | None":
    """What is measured."""
    if not params.gauges.any_on:
        return None
    # Left out of scenes without gauges.
    from quintet.components.sph_fluid.gauges.gauges import Gauges

    return Gauges(params, symmetry, ranks, frame)
