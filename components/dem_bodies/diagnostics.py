"""What is wrong when a run must end, and what touches where."""

import numpy as np

from quintet.components.dem_bodies.contact import ball_search
from quintet.components.dem_bodies.state import (
    DEEPEST,
    DEEPEST_PAIR,
    TOUCHING,
    BallPairs,
    BodyPairs,
    Model,
    State,
)
from quintet.interfaces.component import Fields
from quintet.interfaces.errors import StepError

ALLOWED_DEPTH = 0.5  # overlap over contact radius; Hertz's law is for small ones


def failure(state: State, balls: BallPairs, others: BodyPairs, time: float) -> StepError:
    """Say which body is wrong at a time [s], and what to do."""
    after, bodies = f"dem_bodies, t = {time:.6g} s", len(state.body) - 1
    finite = np.isfinite(state.motion.sum(axis=1))[state.row]
    if not finite.all():
        k = int(np.argmin(finite))
        a = state.row[k]
        return StepError(
            f"{after}: the state must stay finite; body {k} is at {state.position[a].tolist()} m "
            f"with {state.velocity[a].tolist()} m/s under a load of {state.load[a].tolist()} N, "
            "N m. Look at the load it was given, or make steps_per_contact larger."
        )
    i, j = deepest_pair(state, balls, others)
    other, where = f"body {j}" if j < bodies else "a plane", state.position[state.row[i]]
    return StepError(
        f"{after}: a contact may be {ALLOWED_DEPTH} of its radius deep; body {i} is "
        f"{state.report[DEEPEST]:.3g} of it deep in {other}, near {where.round(4).tolist()} m. "
        "Make youngs_modulus or edge_radius larger, or impact_speed nearer to that of impacts."
    )


def deepest_pair(state: State, balls: BallPairs, others: BodyPairs) -> tuple[int, int]:
    """Bodies of the deepest contact; planes are beyond all bodies."""
    pair, count = int(state.report[DEEPEST_PAIR]), len(balls.partner)
    if pair < count:
        return ball_search.deepest_pair(state, balls)
    touching = others.touching
    i, j = state.body[touching[touching[:, 0] == pair - count][0, 1:3]]
    return int(i), int(j)


def contact_points(model: Model, state: State, balls: BallPairs, others: BodyPairs) -> Fields:
    """List what touched in the last step, where the forces of pairs are kept.

    Returns
    -------
    bodies : (k, 2) the first body and the other; planes are the ground, beyond all bodies
    point, normal : (k, 3) m and 1, the normal towards the first body
    force : (k, 3) N on the first body
    depth : (k,) m, overlap
    """
    count = int(state.report[TOUCHING])
    geometry, bodies = others.geometry[:count], state.body[others.touching[:count, 1:3]]
    found = ball_search.touching_balls(model, state, balls)
    return {
        "bodies": np.vstack([found.bodies, bodies]),
        "point": np.vstack([found.point, geometry[:, 3:6]]),
        "normal": np.vstack([found.normal, geometry[:, :3]]),
        "force": np.vstack([found.force, geometry[:, 8:]]),
        "depth": np.append(found.depth, geometry[:, 6]),
    }
