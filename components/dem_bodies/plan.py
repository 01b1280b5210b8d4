"""What a run of bodies will need: its rows, step and time, estimated without making the bodies."""

from pathlib import Path

import numpy as np

from quintet.components.dem_bodies.contact.expected import expected_frequency
from quintet.components.dem_bodies.contact.materials import DURATION, SPEED_UP
from quintet.components.dem_bodies.params import DemBodiesParams
from quintet.components.dem_bodies.shapes.flotation import (
    StillWater,
    flotation_notes,
    refuse_longer,
    still_water,
)
from quintet.components.dem_bodies.shapes.placement import cover
from quintet.components.dem_bodies.shapes.rigid_body import RigidBody
from quintet.components.dem_bodies.shapes.solid import is_ball, solids
from quintet.components.shared.geometry.shapes import Mesh
from quintet.interfaces.component import Fields
from quintet.interfaces.manifest import Plan


def plan(params: DemBodiesParams) -> Plan:
    """What a run will need."""
    bodies, count = params.placed, len(params.bodies)
    ω = expected_frequency(params, bodies.kinds, solids(bodies))
    dt = DURATION * SPEED_UP / ω / params.steps_per_contact
    if count == 1 and not params.planes:  # nothing to touch
        dt = params.longest_step
    dt = min(params.longest_step, dt) if params.fixed_step is None else params.fixed_step
    # Of a step, some time is for calling it, and some for each body: more where it is no ball.
    is_ball_of_kind = np.array([is_ball(kind) for kind in bodies.kinds])
    balls = int(bodies.counts[is_ball_of_kind[bodies.kind]].sum())
    step = 1.5e-5 + 1.3e-7 * balls + 1e-6 * (count - balls)  # s
    notes = tuple(_mesh_note(body) for body in bodies.kinds if body.file is not None)
    return Plan(count, dt, rate=count / step, bytes_per_item=1200.0, notes=notes)


def meets(params: DemBodiesParams, surroundings: Fields) -> None:
    """Refuse bodies far larger than the still water that a partner has."""
    if water := _water(params, surroundings):
        refuse_longer(params.placed, water)


def meeting_notes(params: DemBodiesParams, surroundings: Fields) -> tuple[str, ...]:
    """How bodies float in the still water that a partner has."""
    water = _water(params, surroundings)
    return flotation_notes(params.placed, water) if water else ()


def _water(params: DemBodiesParams, surroundings: Fields) -> StillWater | None:
    """A partner's still water, where bodies may float in it."""
    downwards = params.gravity[0] == params.gravity[1] == 0.0 > params.gravity[2]
    return still_water(surroundings) if params.dimensions == 3 and downwards else None


def _mesh_note(body: RigidBody) -> str:
    """Size and mass of a body from a file, by which a user sees whether its scale is right."""
    shape = cover(body)
    assert shape is not None and body.file is not None
    mass = body.mass
    if mass is None:
        assert body.density is not None
        mass = body.density * shape.volume
    is_turned = isinstance(body.geometry, Mesh) and body.geometry.solid.turned
    turned = "; all its triangles look inwards, and were turned" if is_turned else ""
    size, place = " x ".join(f"{x:.4g}" for x in shape.size), body.position
    return (
        f"{Path(body.file).name} is {size} m, encloses {shape.volume:.4g} m3 and has {mass:.4g} "
        f"kg; its centre of mass is at ({', '.join(f'{x:.4g}' for x in place)}) m{turned}"
    )
