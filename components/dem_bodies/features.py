"""Optional physics as objects: pairs of balls, and the limit of the step."""

from collections.abc import Sequence

from quintet.components.dem_bodies.contact.ball_pairs import no_ball_pairs
from quintet.components.dem_bodies.contact.expected import expected_frequency
from quintet.components.dem_bodies.contact.lists import ContactLists
from quintet.components.dem_bodies.contact.step_limit import FixedStep, StepLimit
from quintet.components.dem_bodies.params import DemBodiesParams
from quintet.components.dem_bodies.shapes.rigid_body import RigidBody
from quintet.components.dem_bodies.shapes.solid import Solid, contact_length
from quintet.components.dem_bodies.state import Model

SKIN = 0.4  # over the smallest length of contact: pairs nearer than that are listed


def contact_lists(
    params: DemBodiesParams, model: Model, bodies: Sequence[RigidBody], solids: Sequence[Solid]
) -> ContactLists:
    """Lists of pairs; those of balls are absent where there are no balls.

    The skin follows the smallest contact radius. The edge radius of a sharp box, or of a thin
    plate, is no measure of how far it moves before it touches: lists would be renewed at every
    step.
    """
    skin = SKIN * min(map(contact_length, bodies, solids))
    return ContactLists(model, no_ball_pairs(model), skin, params.contact_forces)


def step_limit(
    params: DemBodiesParams, model: Model, bodies: Sequence[RigidBody], solids: Sequence[Solid]
) -> FixedStep | StepLimit:
    """The step that a scene sets, or the limit of stability."""
    if params.fixed_step is not None:
        return FixedStep(params.fixed_step)
    return StepLimit(
        frequency=expected_frequency(params, bodies, solids),
        damping=float(model.material_pairs[:, :, 2].max()),
        steps_per_contact=params.steps_per_contact,
        longest=params.longest_step,
    )
