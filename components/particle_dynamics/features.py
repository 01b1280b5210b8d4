"""What holds, drives, damps and heats a lattice; each is absent unless the scene has it."""

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from quintet.components.particle_dynamics.build import Built, lattice_cells
from quintet.components.particle_dynamics.integrators import STAGES
from quintet.components.particle_dynamics.params import Bath, Drive, Lattice, ParticleLatticeParams
from quintet.components.particle_dynamics.potential import pair_damping
from quintet.components.particle_dynamics.ranks.one import OneRank
from quintet.components.particle_dynamics.ranks.terms import Terms
from quintet.components.particle_dynamics.state import NO_DRIVE, Bathed, Driven, Model, State, Whole
from quintet.components.shared.geometry.selections import in_box
from quintet.components.shared.search.nearest import nearest_rows
from quintet.interfaces.component import Array, Resources
from quintet.interfaces.errors import SceneError

if TYPE_CHECKING:
    from quintet.components.particle_dynamics.opencl.device_rows import DeviceRows
    from quintet.components.particle_dynamics.ranks.several import SeveralRanks


def model(params: ParticleLatticeParams, built: Built, bathed: Bathed) -> Model:
    """All constants of the equations of motion but the pair force."""
    damping, start, drive = params.damping, built.start, params.drive
    driven = NO_DRIVE if drive is None else _driven(start, params.lattice, drive)
    _require_free(params, start, driven, built.frozen)
    held = {*built.frozen.tolist(), *({driven.first, driven.second} - {-1})}
    if shared := held & set(bathed.point.tolist()):
        raise SceneError(
            f"baths: points in a bath must be neither frozen nor driven; found "
            f"{start[min(shared)].tolist()} m. Make the boxes smaller."
        )
    loose = ~np.isin(built.bonds, sorted(held)).any(axis=1)
    collision_rate = params.collision_rate if loose.any() else 0.0
    is_literal = damping is not None and damping.range == "all"
    return Model(
        mass=params.lattice.mass,
        frozen=built.frozen,
        driven=driven,
        bathed=bathed,
        bonds=built.bonds[loose] if collision_rate > 0.0 else built.bonds[:0].copy(),
        collision_rate=collision_rate,
        is_random=collision_rate > 0.0 or len(bathed.point) > 0,
        stages=np.array(STAGES[params.integrator]),
        literal_damping=damping.coefficient if damping is not None and is_literal else 0.0,
    )


def _require_free(
    params: ParticleLatticeParams, start: Array, driven: Driven, frozen: Whole
) -> None:
    """Refuse a drive that would move frozen points."""
    shares = ((driven.first, driven.share_first), (driven.second, driven.share_second))
    moved = [point for point, share in shares if share != 0.0]
    if len(wrong := np.intersect1d(moved, frozen)):
        assert params.drive is not None
        raise SceneError(
            f"drive: points that it moves must not be frozen; found "
            f"{start[int(wrong[0])].tolist()} m, which mode {params.drive.mode} moves. Take it out "
            "of frozen, or another mode."
        )


def _driven(start: Array, lattice: Lattice, drive: Drive) -> Driven:
    (first,), axis = nearest_rows(start, [drive.point]), "xyz".index(drive.partner[1])
    distance = -lattice.spacing if drive.partner[0] == "+" else lattice.spacing
    second = _partner(start, start[first] - distance * np.eye(3)[axis], lattice, drive)
    shares = {"relative": (0.5, 0.5), "symmetric": (0.5, 0.5), "point": (1.0, 0.0)}
    share_first, share_second = shares.get(drive.mode, (0.0, 1.0))
    return Driven(
        first=first,
        second=second,
        axis=axis,
        distance=distance,
        amplitude=math.copysign(drive.amplitude, distance),
        frequency=2.0 * math.pi * drive.frequency,
        share_first=share_first,
        share_second=share_second,
        is_free=drive.mode == "relative",
        rest_first=float(start[first, axis]),
        rest_second=float(start[second, axis]),
    )


def _partner(start: Array, place: Array, lattice: Lattice, drive: Drive) -> int:
    """Number of the point at a place (3,) m."""
    (second,) = nearest_rows(start, [place])
    if np.abs(start[second] - place).max() > 0.5 * lattice.spacing:
        raise SceneError(
            f"drive: partner must be a point of the lattice; towards {drive.partner}, at "
            f"{place.tolist()} m, there is none. Take another direction."
        )
    return int(second)


def bath_temperatures(bathed: Bathed, baths: tuple[Bath, ...]) -> Array:
    """Temperatures (b,) K of all bathed points as the scene has them."""
    return np.array([bath.temperature for bath in baths], float)[bathed.bath]


def bathed(start: Array, baths: tuple[Bath, ...]) -> Bathed:
    """Points in baths; each box must hold points that no other bath has."""
    slack = 1e-9 * float(np.abs(start).max() + 1e-300)
    bath_of = np.full(len(start), -1)
    for number, bath in enumerate(baths):
        inside = in_box(start, bath, slack)
        if not inside.any() or (bath_of[inside] >= 0).any():
            mistake = "holds none" if not inside.any() else "shares one with another bath"
            raise SceneError(
                f"baths.{number}: its box must hold points of its own; it {mistake}. Correct the "
                "box."
            )
        bath_of[inside] = number
    point = np.flatnonzero(bath_of >= 0)
    number_of = bath_of[point]
    return Bathed(
        point=point,
        bath=number_of,
        rate=np.array([bath.rate for bath in baths], float)[number_of],
        tether=np.array([bath.tether for bath in baths], float)[number_of],
        rest=start[point].copy(),
        passed=np.zeros(len(point) + 1, np.int64),
    )


class Wall(NamedTuple):
    """The bathed points that are the wall of a link `heat`."""

    rows: Whole  # (w,) of all bathed points
    here: Whole  # (k,) rows of the bathed points of this rank
    of_wall: Whole  # (k,) which of the wall's points each of these is


def wall_of(bathed: Bathed, baths: tuple[Bath, ...], bathed_here: Whole) -> Wall:
    """Find the bathed points that are coupled; `bathed_here` (b,) are those of this rank."""
    rows = np.flatnonzero(np.array([bath.coupled for bath in baths], bool)[bathed.bath])
    here = np.flatnonzero(np.isin(bathed_here, rows))
    return Wall(rows, here, np.searchsorted(rows, bathed_here[here]))


def rows_of(
    resources: Resources, params: ParticleLatticeParams, built: Built, state: State, model: Model
) -> "OneRank | SeveralRanks | DeviceRows":
    """Points as they are stepped: all of them, here or on a device, or the share of this rank."""
    lattice, communicator = params.lattice, resources.communicator
    terms = Terms(
        law=built.law,
        damping=pair_damping(params.damping, lattice.spacing),
        period=built.period,
        lowest=np.array(lattice.lowest),
        bonds=built.bonds,
        spacing=lattice.spacing,
        boltzmann=params.boltzmann,
        averaged_from=params.averages.begin,
    )
    if resources.device != "cpu":
        refuse_on_device(params, resources)
    if communicator is None or communicator.size == 1:
        alone = OneRank(state, model, terms)
        return alone if resources.device == "cpu" else _on_device(resources, alone)
    # Only a lattice of several ranks loads mpi4py.
    from quintet.components.particle_dynamics.ranks.refusal import refuse_what_needs_one_rank
    from quintet.components.particle_dynamics.ranks.several import SeveralRanks

    refuse_what_needs_one_rank(params, communicator.size)
    shared = SeveralRanks(communicator, state, model, terms, lattice_cells(lattice))
    return shared if resources.device == "cpu" else _on_devices(resources, shared)


def refuse_on_device(params: ParticleLatticeParams, resources: Resources) -> None:
    """Refuse what the device, or the devices of several ranks, do not compute."""
    # Lattices on the processor do not load it.
    from quintet.components.particle_dynamics.opencl.refusal import (
        refuse_what_needs_one_rank,
        refuse_what_needs_the_processor,
    )

    ranks = resources.communicator.size if resources.communicator is not None else 1
    refuse_what_needs_the_processor(params, resources.device)
    if ranks > 1:
        refuse_what_needs_one_rank(params, ranks)


def _on_device(resources: Resources, alone: OneRank) -> "DeviceRows":
    """All points on a device."""
    # Only a lattice on a device loads pyopencl.
    from quintet.components.particle_dynamics.opencl.device_rows import DeviceRows
    from quintet.components.particle_dynamics.opencl.other_ranks import NoOtherRanks

    return DeviceRows(resources, alone, NoOtherRanks())


def _on_devices(resources: Resources, shared: "SeveralRanks") -> "DeviceRows":
    """Points of this rank on its device."""
    # Only a lattice on devices of several ranks loads pyopencl and mpi4py.
    from quintet.components.particle_dynamics.opencl.device_rows import DeviceRows
    from quintet.components.particle_dynamics.opencl.ranks import OtherDevices

    return DeviceRows(resources, shared, OtherDevices(resources.communicator, shared))
