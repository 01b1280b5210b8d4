"""Optional physics as objects: pairs of balls, and the limit of the step."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from quintet.components.dem_bodies.contact.ball_pairs import no_ball_pairs
from quintet.components.dem_bodies.contact.expected import expected_frequency
from quintet.components.dem_bodies.contact.lists import ContactLists
from quintet.components.dem_bodies.contact.step_limit import FixedStep, StepLimit
from quintet.components.dem_bodies.params import DemBodiesParams
from quintet.components.dem_bodies.ranks.one import OneRank
from quintet.components.dem_bodies.shapes.copies import Bodies
from quintet.components.dem_bodies.shapes.rigid_body import RigidBody
from quintet.components.dem_bodies.shapes.solid import Solid, contact_length, half_thickness
from quintet.components.dem_bodies.state import Model, State
from quintet.components.dem_bodies.timetable import Timetable, has_changes
from quintet.components.shared.contact.one_rank import require_one_rank
from quintet.interfaces.component import Array, Fields, Keys, Resources

if TYPE_CHECKING:
    from quintet.components.dem_bodies.partner_faces import PartnerFaces
    from quintet.components.dem_bodies.ranks.rows import RowsOfRank

SKIN = 0.4  # over the smallest length of contact: pairs nearer than that are listed


def stepping(
    params: DemBodiesParams,
    model: Model,
    state: State,
    bodies: Bodies,
    solids: Sequence[Solid],
    resources: Resources,
) -> OneRank:
    """What steps the rows, here, on a device or of this rank, with the lists of their pairs.

    The skin follows the smallest contact radius. The edge radius of a sharp box, or of a thin
    plate, is no measure of how far it moves before it touches: lists would be renewed at every
    step. Lists of pairs of balls are absent where there are no balls.
    """
    skin = SKIN * min(map(contact_length, bodies.kinds, solids))
    balls, communicator = no_ball_pairs(model), resources.communicator
    if resources.device != "cpu":
        return _on_devices(params, model, state, bodies, skin, resources)
    if communicator is None or communicator.size == 1:
        lists = ContactLists(model, balls, skin, params.contact_forces)
        return OneRank(state, lists, resources.threads)
    # Only bodies on several ranks load mpi4py.
    from quintet.components.dem_bodies.ranks.lists import SharedLists
    from quintet.components.dem_bodies.ranks.refusal import refuse_what_needs_one_rank
    from quintet.components.dem_bodies.ranks.several import SeveralRanks

    refuse_what_needs_one_rank(params, communicator.size)
    assert balls is not None
    rows = _rows_of_rank(model, state, bodies, communicator)
    shared_lists = SharedLists(rows, balls, skin, params.contact_forces)
    return SeveralRanks(rows, shared_lists, resources.threads)


def _on_devices(
    params: DemBodiesParams,
    model: Model,
    state: State,
    bodies: Bodies,
    skin: float,
    resources: Resources,
) -> OneRank:
    """What steps the rows on a device, or those of this rank on its device."""
    # Only bodies on a device load pyopencl.
    from quintet.components.dem_bodies.opencl.device_lists import DeviceLists
    from quintet.components.dem_bodies.opencl.one_device import OneDevice
    from quintet.components.dem_bodies.opencl.refusal import (
        refuse_what_needs_one_rank,
        refuse_what_needs_the_processor,
    )

    refuse_what_needs_the_processor(params, resources.device)
    balls, communicator = no_ball_pairs(model), resources.communicator
    assert balls is not None
    if communicator is None or communicator.size == 1:
        lists = DeviceLists(model, balls, skin, params.contact_forces)
        return OneDevice(state, lists, resources)
    refuse_what_needs_one_rank(params, communicator.size)
    # Only bodies on several ranks load mpi4py.
    from quintet.components.dem_bodies.opencl.several_devices import SeveralDevices
    from quintet.components.dem_bodies.opencl.shared_lists import SharedDeviceLists

    rows = _rows_of_rank(model, state, bodies, communicator)
    shared_lists = SharedDeviceLists(rows, balls, skin, params.contact_forces)
    return SeveralDevices(rows, shared_lists, resources)


def _rows_of_rank(model: Model, state: State, bodies: Bodies, communicator: Any) -> "RowsOfRank":
    """Rows of this rank of several."""
    # Only bodies on several ranks load mpi4py.
    from quintet.components.dem_bodies.ranks.rows import RowsOfRank
    from quintet.components.dem_bodies.ranks.shares import Shares

    shares = Shares(communicator, len(model.kind), int(np.count_nonzero(model.ball)))
    return RowsOfRank(model, state, bodies.kind_of_each(np.int32), shares)


def timetable(params: DemBodiesParams, bodies: Bodies, model: Model) -> Timetable | None:
    """Planes that vanish and bodies that are released; None where all stays."""
    return Timetable(params, bodies, model) if has_changes(params, bodies) else None


def step_limit(
    params: DemBodiesParams, model: Model, bodies: Bodies, solids: Sequence[Solid]
) -> FixedStep | StepLimit:
    """The step that a scene sets, or the limit of stability."""
    if params.fixed_step is not None:
        return FixedStep(params.fixed_step)
    return StepLimit(
        frequency=expected_frequency(params, bodies.kinds, solids),
        damping=float(model.material_pairs[:, :, 2].max()),
        steps_per_contact=params.steps_per_contact,
        longest=params.longest_step,
        # Planes hold all that is below them, however deep.
        room=min(map(room, bodies.kinds, solids)) if len(bodies) > 1 else math.inf,
    )


def room(body: RigidBody, solid: Solid) -> float:
    """Contact radius [m] of a body, or half its thickness if that is less."""
    has_faces = body.size is not None or body.corners is not None
    radius = contact_length(body, solid)
    return min(radius, half_thickness(body)) if has_faces else radius


def partner_faces(
    static: Fields, joined: Keys, params: DemBodiesParams, model: Model, state: State, mass: Array,
    resources: Resources,
) -> "PartnerFaces | None":  # fmt: skip
    """Faces of a partner's mesh that spheres touch; None where no link joins them."""
    if "contact_faces" not in joined:
        return None
    # Scenes without contact of two components do not import it.
    from quintet.components.dem_bodies.partner_faces import PartnerFaces

    require_one_rank("bodies", resources)
    return PartnerFaces(static, params, model, state, mass)
